#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"
#include "runtime/camera.h"
#include "runtime/function.h"
#include "runtime/light.h"
#include "runtime/material.h"
#include "runtime/math/affine.h"
#include "runtime/mesh_data.h"
#include "runtime/render_settings.h"
#include "runtime/shapes/list.h"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace scc::runtime {

/// What a scene needs. A kernel compiled for a scene contains nothing else; the generic renderer uses
/// `everything`.
struct SceneTraits {
    std::uint32_t bare_shapes = 0;    ///< bit per row of Shapes: present without a transform
    std::uint32_t placed_shapes = 0;  ///< bit per row of Shapes: present with a transform
    std::uint32_t bare_members = 0;   ///< the same for members of solids
    std::uint32_t placed_members = 0; ///< the same for members of solids
    bool point_lights = false;
    bool directional_lights = false;
    bool spot_lights = false;
    bool rectangle_lights = false;
    bool attenuation = false;       ///< some light has kl or kq other than 0, or kc other than 1
    bool separate_specular = false; ///< some light has Is other than Id
    bool specular = false;          ///< some material has a highlight
    bool emission = false;
    bool reflection = false;
    bool transmission = false;   ///< some material lets light through
    bool refraction = false;     ///< some such material has an index of refraction other than 1
    bool two_sided = false;      ///< some shape has a back material of its own
    bool functions = false;      ///< some material field is a per-point function
    bool uv = false;             ///< some of them reads the coordinates on the surface
    bool bump = false;           ///< some material has one
    bool smooth_normals = false; ///< some triangle or mesh has vertex normals
    bool shadows = false;
    bool accelerator = false; ///< enough bounded shapes that a hierarchy over them pays
    bool perspective = false;
    bool orthographic = false;
    bool spherical = false;
    bool lens = false; ///< the camera has one, and is no pinhole
    bool pixel_sampling =
        false;            ///< samples in other places than a grid's, other weights than a box's, or adaptive
    bool spectra = false; ///< drawn three wavelengths at a time (bands.h), which the kernels do not notice
    bool raster = false;  ///< drawn by triangles and lines (raster/draw.h)
    bool lines = false;   ///< where raster: it shows polylines, or edges (wireframe, hidden line)

    friend constexpr bool operator==(const SceneTraits&, const SceneTraits&) = default;
};

inline constexpr SceneTraits everything{~0U,  ~0U,  ~0U,  ~0U,  true, true, true, true, true, true,
                                        true, true, true, true, true, true, true, true, true, true,
                                        true, true, true, true, true, true, true, true, true, true};

/// What every shape in a scene carries.
struct Tag {
    std::uint32_t id = 0; ///< order in the source; of two hits at equal distance the smaller id counts
    Sides sides{};
};

/// A shape given in world coordinates.
template <class Shape>
struct Bare {
    Shape shape{};
    Tag tag{};
};

/// A shape given in its own coordinates, with the map to the world (L13).
template <class Shape, class R>
struct Placed {
    Shape shape{};
    Affine<R> world_from_object{};
    Affine<R> object_from_world{};
    Tag tag{};
};

/// A primitive that is seen as a part of a solid only.
template <class Primitive>
struct Member {
    Primitive primitive{};
    bool inverted = false; ///< an odd number of subtractions takes it away: its outside is the solid's inside
    std::uint32_t solid = 0; ///< Tag::id of the whole
};

/// Two kinds of primitives per row of Shapes: even bare, odd placed.
template <class List>
struct PrimitiveKinds;
template <class... Shape>
struct PrimitiveKinds<TypeList<Shape...>> {
    static constexpr std::uint32_t count = 2 * sizeof...(Shape);
    template <std::uint32_t kind>
    using ShapeOf = std::tuple_element_t<kind / 2, std::tuple<Shape...>>;
};
inline constexpr std::uint32_t primitive_kinds = PrimitiveKinds<Shapes<double>>::count;

template <class R, std::uint32_t kind>
using ShapeOfKind = typename PrimitiveKinds<Shapes<R>>::template ShapeOf<kind>;
template <class R, std::uint32_t kind>
using PrimitiveOfKind =
    std::conditional_t<kind % 2 == 0, Bare<ShapeOfKind<R, kind>>, Placed<ShapeOfKind<R, kind>, R>>;

constexpr bool uses_kind(const SceneTraits& traits, std::uint32_t kind) {
    return ((kind % 2 == 0 ? traits.bare_shapes : traits.placed_shapes) >> (kind / 2) & 1U) != 0;
}

constexpr bool uses_member_kind(const SceneTraits& traits, std::uint32_t kind) {
    return ((kind % 2 == 0 ? traits.bare_members : traits.placed_members) >> (kind / 2) & 1U) != 0;
}
constexpr bool uses_csg(const SceneTraits& traits) {
    return (traits.bare_members | traits.placed_members) != 0;
}
/// A member's kind in a Hit is its primitive's plus this.
inline constexpr std::uint32_t member_kinds = primitive_kinds;

/// Up to this many bounded shapes, looking at each costs less than a hierarchy.
inline constexpr std::size_t accelerator_threshold = 12;

struct PrimitiveRef {
    std::uint32_t kind = 0;
    std::uint32_t index = 0;
};

/// How a node of a solid's tree is made from its operands.
enum class CsgOp : std::uint32_t {
    member, ///< a primitive; no operands
    unite,
    intersect,
    subtract ///< the first without the rest
};

/// A node of a solid's tree. The nodes of its operands follow it.
struct CsgNode {
    CsgOp op = CsgOp::member;
    std::uint32_t size = 1; ///< nodes in this subtree, this one among them
    PrimitiveRef member;    ///< its kind and its index among the members of that kind
};

/// A hierarchy over the bounded shapes; without nodes where they are too few (see prepare in accel/build.h).
struct Accelerator {
    std::vector<BvhNode> nodes;
    std::vector<PrimitiveRef> primitives; ///< in the order of the leaves
    Bounds<float> box;
    float most_spread = 0; ///< of the slopes of rays that go through it as one beam
};

/// Names one of a scene's tables of primitives.
template <class Primitive>
struct Of {};

/// A straight piece of a line that a raster picture shows, in the world; rays do not meet it. Not lit.
template <class R>
struct LineSegment {
    Vec3<R> from{}, to{};
    Rgb<R> color{1, 1, 1};
    R width = 1; ///< in pixels
};

/// The parts of a scene that most scenes lack, for a scene type to inherit and to hide.
template <class R>
struct SceneBase {
    using Real = R;

    template <class Primitive>
    static constexpr std::array<Primitive, 0> primitives(Of<Primitive>) {
        return {};
    }
    template <class Primitive>
    static constexpr std::array<Member<Primitive>, 0> members(Of<Primitive>) {
        return {};
    }
    static constexpr std::array<CsgNode, 0> csg_nodes{};
    static constexpr std::array<PointLight<R>, 0> point_lights{};
    static constexpr std::array<DirectionalLight<R>, 0> directional_lights{};
    static constexpr std::array<SpotLight<R>, 0> spot_lights{};
    static constexpr std::array<RectangleLight<R>, 0> rectangle_lights{};
    static constexpr std::array<MeshData, 0> meshes{};
    static constexpr std::array<LineSegment<R>, 0> line_segments{};
    static constexpr bool reads_uv = true; ///< where traits.uv: some function does
    static constexpr Camera<R> camera{};
    static constexpr Rgb<R> ambient{};
    static constexpr Rgb<R> background{};

    template <class L>
    static Rgb<L> color_function(std::int32_t, const SurfacePoint<L>&) {
        return {};
    }
    template <class L>
    static L number_function(std::int32_t, const SurfacePoint<L>&) {
        return L(0);
    }
    /// Of an implicit surface. T is a lane type, or an interval or dual number over one.
    template <class T>
    static T field_function(std::int32_t, const Vec3<T>&) {
        return T(0);
    }
};

/// What the kernels are compiled for. Its traits say what it contains; what they deny is not looked at.
///
/// A compiled scene is a type with tables of constant size and nothing of its own but the per-point
/// functions. Their content is constant, or what the program read at its start (`static inline`, without an
/// initialiser):
///
///     struct Scene : SceneBase<double> {
///         using R = double;
///         static constexpr SceneTraits traits{.bare_shapes = 1U << 2, .point_lights = true, ...};
///         using SceneBase<R>::primitives;
///         static constexpr std::array<Bare<Plane<R>>, 1> bare_plane{{{{.normal = {0, 1, 0}}, {.id = 0}}}};
///         const auto& primitives(Of<Bare<Plane<R>>>) const { return bare_plane; }
///         using SceneBase<R>::members; // the same for members of solids
///         static constexpr std::array<Member<Bare<Sphere<R>>>, 2> member_bare_sphere{{...}};
///         const auto& members(Of<Bare<Sphere<R>>>) const { return member_bare_sphere; }
///         static constexpr std::array<CsgNode, 3> csg_nodes{{...}};
///         static constexpr std::array<Phong<R>, 1> materials{{...}};
///         static constexpr std::array<PointLight<R>, 1> point_lights{{...}};
///         static constexpr Camera<R> camera{...};
///         static constexpr Rgb<R> ambient{...}, background{...};
///         template <class L>
///         Rgb<L> color_function(std::int32_t index, const SurfacePoint<L>& s) const {
///             switch (index) {
///             case 0: {
///                 const L v0 = s.p.x;
///                 const L v1 = round_down(v0);  // one statement per node, in the order of
///                 ir::Function::nodes return {v1, v1, v1};
///             }
///             default: return {};
///             }
///         }
///         static inline std::vector<MeshData> meshes; // only with meshes: read before rendering
///         static constexpr std::array<LineSegment<R>, ...> line_segments{...}; // only with traits.lines
///         static inline std::vector<ImageData> images; // only with images: for the functions
///         Accelerator accelerator;         // only with traits.accelerator: filled by prepare(scene)
///     };
///
/// Tables that are absent are left out; tables too large to unroll are std::span members. Every
/// table is in source order (Tag::id ascending), as the generic scene has it; both then draw the same bits.
template <class S>
concept SceneModel = requires(const S& s, const SurfacePoint<typename S::Real>& point) {
    { S::traits } -> std::convertible_to<SceneTraits>;
    { s.materials[0] } -> std::convertible_to<Phong<typename S::Real>>;
    s.point_lights.size();
    s.directional_lights.size();
    s.spot_lights.size();
    s.rectangle_lights.size();
    s.meshes.size();
    s.line_segments.size();
    { s.camera } -> std::convertible_to<Camera<typename S::Real>>;
    { s.ambient } -> std::convertible_to<Rgb<typename S::Real>>;
    { s.background } -> std::convertible_to<Rgb<typename S::Real>>;
    s.primitives(Of<PrimitiveOfKind<typename S::Real, 0>>{}).size();
    s.members(Of<PrimitiveOfKind<typename S::Real, 0>>{}).size();
    s.csg_nodes.size();
    { s.color_function(0, point) } -> std::convertible_to<Rgb<typename S::Real>>;
    { s.number_function(0, point) } -> std::convertible_to<typename S::Real>;
};

template <class R, class Kinds = std::make_integer_sequence<std::uint32_t, primitive_kinds>>
struct PrimitiveTables;
template <class R, std::uint32_t... kind>
struct PrimitiveTables<R, std::integer_sequence<std::uint32_t, kind...>> {
    std::tuple<std::vector<PrimitiveOfKind<R, kind>>...> tables;
    std::tuple<std::vector<Member<PrimitiveOfKind<R, kind>>>...> members;
};

/// The scene whose content is known at run time only. Fill the tables, then call prepare (accel/build.h).
template <class R>
struct DynamicScene {
    using Real = R;
    static constexpr SceneTraits traits = everything;

    PrimitiveTables<R> shapes;
    std::vector<CsgNode> csg_nodes;
    std::vector<Phong<R>> materials;
    std::vector<PointLight<R>> point_lights;
    std::vector<DirectionalLight<R>> directional_lights;
    std::vector<SpotLight<R>> spot_lights;
    std::vector<RectangleLight<R>> rectangle_lights;
    std::vector<MeshData> meshes;
    std::vector<LineSegment<R>> line_segments;
    std::vector<FunctionProgram<R>> functions; ///< Varying::function indexes it
    bool reads_uv = false;                     ///< some function does
    Camera<R> camera;
    Rgb<R> ambient{};
    Rgb<R> background{};
    Accelerator accelerator;

    template <class Primitive>
    const std::vector<Primitive>& primitives(Of<Primitive>) const {
        return std::get<std::vector<Primitive>>(shapes.tables);
    }
    /// Appends to the primitive's table; call in the order of Tag::id.
    template <class Primitive>
    void add(const Primitive& primitive) {
        std::get<std::vector<Primitive>>(shapes.tables).push_back(primitive);
    }
    template <class Primitive>
    const std::vector<Member<Primitive>>& members(Of<Primitive>) const {
        return std::get<std::vector<Member<Primitive>>>(shapes.members);
    }
    template <class Primitive>
    void add(const Member<Primitive>& member) {
        std::get<std::vector<Member<Primitive>>>(shapes.members).push_back(member);
    }

    template <class L>
    Rgb<L> color_function(std::int32_t index, const SurfacePoint<L>& point) const {
        const FunctionProgram<R>& program = functions[static_cast<std::size_t>(index)];
        const L* registers = run(program, point);
        return {registers[program.results[0]], registers[program.results[1]], registers[program.results[2]]};
    }
    template <class L>
    L number_function(std::int32_t index, const SurfacePoint<L>& point) const {
        const FunctionProgram<R>& program = functions[static_cast<std::size_t>(index)];
        return run(program, point)[program.results[0]];
    }
    template <class T>
    T field_function(std::int32_t index, const Vec3<T>& p) const {
        const FunctionProgram<R>& program = functions[static_cast<std::size_t>(index)];
        return run(program, SurfacePoint<T>{p, {}, {}})[program.results[0]];
    }
};

} // namespace scc::runtime
