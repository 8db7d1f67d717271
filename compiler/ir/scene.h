#pragma once

#include "compiler/ir/function.h"
#include "compiler/ir/mesh.h"
#include "lang/rows.h"
#include "lang/source.h"
#include "runtime/bands.h"
#include "runtime/camera.h"
#include "runtime/light.h"
#include "runtime/material.h"
#include "runtime/math/affine.h"
#include "runtime/scene.h"
#include "runtime/shapes/list.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

/// The scene as every backend sees it: resolved, typed, free of syntax. Numbers are doubles; lengths are
/// world units.
namespace scc::compiler::ir {

template <class List>
struct VariantOf;
template <class... Ts>
struct VariantOf<runtime::TypeList<Ts...>> {
    using type = std::variant<Ts...>;
};
/// One alternative per row of runtime::Shapes, with double members in object space.
using Shape = VariantOf<runtime::Shapes<double>>::type;
template <class List>
struct VectorsOf;
template <class... Ts>
struct VectorsOf<runtime::TypeList<Ts...>> {
    using type = std::variant<std::vector<Ts>...>;
};
/// Many shapes of one kind.
using Shapes = VectorsOf<runtime::Shapes<double>>::type;

struct Material {
    std::string name;                            ///< the author's `let`, else made from the object; unique
    runtime::Phong<double> phong;                ///< Varying::function indexes Scene::functions
    std::vector<runtime::Phong<double>> bands{}; ///< the same for each of Scene::bands
    lang::Span span;
};

struct Object {
    Shape shape;
    runtime::Affine<double> world_from_object; ///< identity where the shape stands in world coordinates
    runtime::Sides sides;                      ///< indices into Scene::materials
    std::string path;                          ///< stable: `table/leg[2]`; unique
    lang::Span span;
};

/// What one shape in the body of a loop, or a table of text, became: one object per round.
struct ObjectColumn {
    Shapes shapes;
    runtime::Affine<double> world_from_object;  ///< of all of them
    std::vector<runtime::Sides> sides;          ///< one per round, or one for all
    std::string path;                           ///< without the number: `table/leg`
    std::size_t first_number = 0;               ///< of the first round's path, `table/leg[2]`
    std::size_t number_step = 1;                ///< from one round's to the next one's
    lang::Span span;                            ///< of all of them, if `places` is null
    std::shared_ptr<const lang::Places> places; ///< per round, from `first_place` on
    std::size_t first_place = 0;

    const runtime::Sides& sides_of(std::size_t round) const { return sides[sides.size() == 1 ? 0 : round]; }
    lang::Span span_of(std::size_t round) const;
    std::string path_of(std::size_t round) const;
};

/// Objects that differ in numbers only. In source order round by round, and column by column in a round.
struct ObjectArray {
    std::size_t before = 0; ///< how many of Scene::objects come before
    std::size_t rounds = 0;
    std::vector<ObjectColumn> columns;
};

/// A node of a solid's tree, as runtime::CsgNode.
struct CsgNode {
    runtime::CsgOp op = runtime::CsgOp::member;
    std::uint32_t size = 1;   ///< nodes in this subtree, this one among them
    std::uint32_t member = 0; ///< index into Scene::members
    bool inverted = false;    ///< of a member: an odd number of subtractions takes it away
};

struct Polyline {
    std::vector<runtime::Vec3<double>> points; ///< in the world
    runtime::Rgb<double> color{1, 1, 1};
    double width = 1; ///< in pixels
    lang::Span span;
    std::vector<runtime::Rgb<double>> bands{}; ///< instead of the colour, for each of Scene::bands
};

struct LightColors {
    runtime::Rgb<double> diffuse{};
    runtime::Rgb<double> specular{};
};

struct Light {
    std::variant<runtime::PointLight<double>, runtime::DirectionalLight<double>, runtime::SpotLight<double>,
                 runtime::RectangleLight<double>>
        light;
    std::string name; ///< unique
    lang::Span span;
    std::vector<LightColors> bands{}; ///< instead of the light's own, for each of Scene::bands
};

struct Scene {
    std::string name; ///< of the file, without folder and extension
    std::vector<Material> materials;
    std::vector<Object> objects; ///< in source order, groups flattened; see objects.h for going through all
    std::vector<ObjectArray> arrays; ///< in source order
    std::vector<Object> members;     ///< of solids: seen as parts of them only; in source order
    std::vector<CsgNode> csg_nodes;  ///< the trees of the objects that are runtime::Csg, in their order
    std::vector<Light> lights;       ///< enabled ones
    std::vector<Polyline> polylines; ///< that only raster pictures show: those without a radius
    std::vector<Mesh> meshes;
    std::vector<Function> functions;
    runtime::Camera<double> camera;
    lang::Span camera_span;
    runtime::Rgb<double> ambient{0.1, 0.1, 0.1}; ///< Ia
    runtime::Rgb<double> background{0, 0, 0};
    /// Of a scene with spectra: it is drawn in these; what stands in Rec.709 above and in materials and
    /// lights is how others, who know no spectra, come near to it. Else empty.
    std::vector<runtime::BandGroup<double>> bands;
    std::string file; ///< that the scene names for its picture, or empty
    runtime::RenderSettings settings;
    lang::Span method_span;      ///< of `ray { }` or `raster { }`, where the render has one
    runtime::SceneTraits traits; ///< by the pass derive_traits
};

} // namespace scc::compiler::ir
