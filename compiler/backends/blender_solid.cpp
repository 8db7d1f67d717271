#include "compiler/backends/blender_solid.h"

#include "compiler/backends/function_program.h"
#include "compiler/backends/tables.h"
#include "compiler/bounds.h"
#include "compiler/derivative.h"
#include "compiler/ir/objects.h"
#include "runtime/tessellate/solid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Bounds;
using runtime::SmoothSurface;
using runtime::SolidFace;
using runtime::Vec3;
using Scene = runtime::DynamicScene<double>;
using Mesh = runtime::SolidMesh<double>;
using Formula = BlenderFace::Formula;

/// Each formula is a material of its own.
constexpr std::size_t most_formulas = 256;

/// Cycles keeps what nodes calculate in few registers.
constexpr std::size_t most_nodes = 300;

/// What the tessellator reads of a scene.
Scene solids_of(const ir::Scene& scene) {
    Scene result;
    for_each_primitive<double>(scene, [&](const auto& primitive) { result.add(primitive); });
    result.csg_nodes = csg_nodes_of(scene);
    for (const ir::Function& function : scene.functions) {
        result.functions.push_back(program_of<double>(function));
    }
    return result;
}

/// To a fifth of a pixel of the scene's own picture, a tenth in one of 240 rows or fewer, where outlines are
/// a larger part of it, and where it is nearest to the camera: that is what outlines and shadows are off by,
/// since the materials find the true surface.
runtime::Tolerance<double> tolerance_for(const ir::Scene& scene, const Bounds<double>& box) {
    const double share_of_pixel = scene.settings.height > 240 ? 0.2 : 0.1;
    constexpr double finest = 4e-4,
                     coarsest = 1e-2; // of the solid's size: hundreds of thousands of triangles, and few
    const double size = length(box.max - box.min);
    double pixel = 2 * scene.camera.half_height / scene.settings.height;
    if (scene.camera.projection != runtime::Projection::orthographic) {
        const Vec3<double> nearest = minimum(maximum(scene.camera.eye, box.min), box.max);
        pixel *= std::max(length(nearest - scene.camera.eye), size / 20);
    }
    return {std::clamp(pixel * share_of_pixel, size * finest, size * coarsest), 0.5};
}

void append(std::vector<float>& numbers, const std::vector<Vec3<double>>& vectors) {
    for (const Vec3<double>& v : vectors) {
        numbers.insert(numbers.end(),
                       {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }
}

/// The tags and maps of members, or of the implicit surface itself.
struct Owner {
    runtime::Sides sides;
    Affine<double> own_from_world;
};

class SolidMaker {
public:
    SolidMaker(const ir::Scene& scene, const ir::Object& object, const Mesh& mesh)
        : scene_(scene), object_(object), mesh_(mesh) {}

    /// owner(face) gives the Owner.
    template <class OwnerOf>
    BlenderSolid make(const OwnerOf& owner_of) {
        ir::MeshArrays arrays;
        append(arrays.positions, mesh_.mesh.positions);
        append(arrays.normals, mesh_.mesh.normals);
        std::vector<std::uint32_t> slot_of_face(mesh_.faces.size(), none);
        for (const runtime::Triangle3& t : mesh_.mesh.triangles) {
            arrays.indices.insert(arrays.indices.end(), t.positions.begin(), t.positions.end());
            arrays.normal_indices.insert(arrays.normal_indices.end(), t.normals.begin(), t.normals.end());
            std::uint32_t& slot = slot_of_face[t.part];
            if (slot == none) {
                slot = slot_for(face_of(mesh_.faces[t.part], owner_of(mesh_.faces[t.part])));
            }
            result_.slots.push_back(slot);
        }
        result_.mesh = ir::make_mesh(object_.path, std::move(arrays));
        result_.deviation = mesh_.deviation;
        result_.uncertain = mesh_.uncertain;
        return std::move(result_);
    }

private:
    static constexpr std::uint32_t none = ~0U;

    static BlenderFace no_formula(const Owner& owner) {
        BlenderFace face;
        face.sides = owner.sides;
        face.member_from_world = owner.own_from_world;
        return face;
    }

    BlenderFace face_of(const SolidFace<double>& from, const Owner& owner) {
        using Kind = SmoothSurface<double>::Kind;
        const SmoothSurface<double>& surface = mesh_.surfaces[from.surface];
        BlenderFace face = no_formula(owner);
        face.formula = formula_of(surface);
        if (face.formula == Formula::none || formulas_ == most_formulas) {
            face.formula = Formula::none;
            return face;
        }
        ++formulas_;
        face.inverted = from.sign < 0;
        if (surface.kind == Kind::field) {
            face.field = surface.field;
            face.q_from_world = owner.own_from_world;
            return face;
        }
        face.radius = surface.radius;
        face.slope = surface.slope;
        face.q_from_world = compose(frame(surface), owner.own_from_world);
        return face;
    }
    Formula formula_of(const SmoothSurface<double>& surface) const {
        using Kind = SmoothSurface<double>::Kind;
        switch (surface.kind) {
        case Kind::plane:
        case Kind::torus:
        case Kind::quadric:
            return Formula::none;
        case Kind::ball:
            return Formula::ball;
        case Kind::tube:
        case Kind::cone:
            return Formula::round;
        case Kind::field:
            break;
        }
        return field_for_nodes(scene_.functions[static_cast<std::size_t>(surface.field)]) ? Formula::field
                                                                                          : Formula::none;
    }
    static Affine<double> frame(const SmoothSurface<double>& s) {
        Affine<double> map;
        const std::array<Vec3<double>, 3> axes =
            s.kind == SmoothSurface<double>::Kind::ball
                ? std::array<Vec3<double>, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}
                : std::array<Vec3<double>, 3>{s.u, s.v, s.w};
        for (std::size_t row = 0; row < 3; ++row) {
            const Vec3<double>& axis = axes[row];
            const std::array<double, 4> numbers{axis.x, axis.y, axis.z, -dot(axis, s.origin)};
            std::copy(numbers.begin(), numbers.end(), map.m[row]);
        }
        return map;
    }

    /// Faces without a formula share a slot with others of the same material and coordinates.
    std::uint32_t slot_for(const BlenderFace& face) {
        for (std::size_t i = 0; i < result_.faces.size(); ++i) {
            const BlenderFace& other = result_.faces[i];
            if (face.formula == Formula::none && other.formula == Formula::none &&
                face.sides.front == other.sides.front && face.sides.back == other.sides.back &&
                face.member_from_world == other.member_from_world) {
                return static_cast<std::uint32_t>(i);
            }
        }
        result_.faces.push_back(face);
        return static_cast<std::uint32_t>(result_.faces.size() - 1);
    }

    const ir::Scene& scene_;
    const ir::Object& object_;
    const Mesh& mesh_;
    BlenderSolid result_;
    std::size_t formulas_ = 0;
};

BlenderSolid make_solid(const ir::Scene& scene, const Scene& tables, const ir::Object& object,
                        const runtime::Csg<double>& csg) {
    const Mesh mesh = tessellate_solid(tables, csg.root, tolerance_for(scene, solid_bounds(scene, csg.root)));
    return SolidMaker(scene, object, mesh).make([&](const SolidFace<double>& face) {
        Owner owner;
        visit_member(tables, face.member, [&](const auto& member) {
            owner.sides = member.primitive.tag.sides;
            if constexpr (requires { member.primitive.object_from_world; }) {
                owner.own_from_world = member.primitive.object_from_world;
            }
        });
        return owner;
    });
}

BlenderSolid make_solid(const ir::Scene& scene, const Scene& tables, const ir::Object& object,
                        const runtime::Implicit<double>& implicit) {
    const Affine<double>& place = object.world_from_object;
    const auto tolerance = tolerance_for(scene, transform_bounds(place, implicit.bounds()));
    const runtime::Bare<runtime::Implicit<double>> bare{implicit, {0, object.sides}};
    Mesh mesh = tessellate_implicit(tables, bare, tolerance_in_object(tolerance, place));
    mesh.deviation *= runtime::stretch_bounds(place).most;
    const Owner owner{object.sides, inverse(place)};
    return SolidMaker(scene, object, mesh).make([&](const SolidFace<double>&) { return owner; });
}

} // namespace

std::optional<ir::Function> field_for_nodes(const ir::Function& field) {
    const bool is_random = std::any_of(field.nodes.begin(), field.nodes.end(), [](const ir::Node& node) {
        return node.kind == ir::Node::Kind::apply && node.op == ir::Op::random;
    });
    std::optional<ir::Function> result = is_random ? std::nullopt : with_gradient(field);
    return result && result->nodes.size() <= most_nodes ? result : std::nullopt;
}

BlenderSolids blender_solids(const ir::Scene& scene) {
    BlenderSolids solids;
    Scene tables; // made for the first that needs them
    ir::for_each_object(scene, [&](const ir::Object& object) {
        const auto add = [&](const auto& shape) {
            if (solids.empty()) {
                tables = solids_of(scene);
            }
            solids.emplace(object.path, make_solid(scene, tables, object, shape));
        };
        if (const auto* csg = std::get_if<runtime::Csg<double>>(&object.shape)) {
            if (!ir::has_mesh(scene, *csg)) {
                add(*csg);
            }
        } else if (const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape)) {
            add(*implicit);
        }
    });
    return solids;
}

} // namespace scc::compiler
