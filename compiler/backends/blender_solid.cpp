#include "compiler/backends/blender_solid.h"

#include "compiler/backends/function_program.h"
#include "compiler/backends/lattices.h"
#include "compiler/backends/tables.h"
#include "compiler/bounds.h"
#include "compiler/derivative.h"
#include "compiler/ir/objects.h"
#include "runtime/tessellate/solid.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

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
    SolidMaker(const ir::Scene& scene, const std::string& name, const Mesh& mesh)
        : scene_(scene), name_(name), mesh_(mesh) {}

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
        result_.mesh = ir::make_mesh(name_, std::move(arrays));
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
        if (surface.kind == Kind::quadric) {
            face.quadric = {surface.u, surface.v, surface.w, surface.radius};
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
            return Formula::none;
        case Kind::torus:
            return Formula::ring;
        case Kind::ball:
            return Formula::ball;
        case Kind::tube:
        case Kind::cone:
            return Formula::round;
        case Kind::quadric:
            return Formula::quadric;
        case Kind::field:
            break;
        }
        return field_for_nodes(scene_, surface.field) ? Formula::field : Formula::none;
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
    const std::string& name_;
    const Mesh& mesh_;
    BlenderSolid result_;
    std::size_t formulas_ = 0;
};

/// Without meshes in it.
BlenderSolid make_tree(const ir::Scene& scene, const Scene& tables, const std::string& name,
                       std::uint32_t root, const runtime::Tolerance<double>& tolerance) {
    const Mesh mesh = tessellate_solid(tables, root, tolerance);
    return SolidMaker(scene, name, mesh).make([&](const SolidFace<double>& face) {
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

/// Of a solid with meshes in it: subtrees without any are tessellated as they are; Blender does the rest.
class CutMaker {
public:
    /// `box`: around the solid.
    CutMaker(const ir::Scene& scene, Scene& tables, const ir::Object& object, const Bounds<double>& box)
        : scene_(scene), tables_(tables), object_(object), box_(box), tolerance_(tolerance_for(scene, box)) {}

    BlenderSolid make(std::uint32_t node) {
        const ir::CsgNode& from = scene_.csg_nodes[node];
        if (!ir::has_mesh(scene_, {node}) || from.op == runtime::CsgOp::member) {
            return make_part(node);
        }
        const std::uint32_t first = node + 1;
        BlenderSolid solid = make(first);
        for (std::uint32_t child = first + size(first); child < node + from.size; child += size(child)) {
            BlenderSolid other = make(child);
            if (from.op == runtime::CsgOp::subtract) {
                turn_over(other);
            }
            solid.cuts.push_back({from.op, std::move(other)});
        }
        return solid;
    }

private:
    std::uint32_t size(std::uint32_t node) const { return scene_.csg_nodes[node].size; }

    BlenderSolid make_part(std::uint32_t node) {
        const std::string name =
            parts_ == 0 ? object_.path : fmt::format("{} part {}", object_.path, parts_ + 1);
        ++parts_;
        const ir::CsgNode& from = scene_.csg_nodes[node];
        const ir::Object* const member =
            from.op == runtime::CsgOp::member ? &scene_.members[from.member] : nullptr;
        const auto* mesh = member != nullptr ? std::get_if<runtime::Mesh<double>>(&member->shape) : nullptr;
        BlenderSolid part = mesh != nullptr ? make_part(name, *member, scene_.meshes[mesh->mesh])
                                            : make_tree(scene_, tables_, name, with_end(node), tolerance_);
        part.is_part = true;
        return part;
    }
    /// A mesh as it is, in the world.
    static BlenderSolid make_part(const std::string& name, const ir::Object& member, const ir::Mesh& mesh) {
        const Affine<double>& place = member.world_from_object;
        const Affine<double> own_from_world = inverse(place);
        const bool is_mirrored = determinant(place) < 0;
        const auto vector = [](std::span<const float> from, std::uint32_t i) {
            return Vec3<double>{from[3 * i], from[3 * i + 1], from[3 * i + 2]};
        };
        std::vector<Vec3<double>> positions, normals;
        for (std::uint32_t i = 0; 3 * i < mesh.positions.size(); ++i) {
            positions.push_back(transform_point(place, vector(mesh.positions, i)));
        }
        ir::MeshArrays arrays;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const std::array<std::size_t, 3> corners =
                is_mirrored ? std::array{t, t + 2, t + 1} : std::array{t, t + 1, t + 2};
            std::array<Vec3<double>, 3> p;
            for (std::size_t k = 0; k < 3; ++k) {
                arrays.indices.push_back(mesh.indices[corners[k]]);
                p[k] = positions[mesh.indices[corners[k]]];
            }
            const Vec3<double> flat = normalize(cross(p[1] - p[0], p[2] - p[0]));
            for (const std::size_t corner : corners) {
                const Vec3<double> own =
                    mesh.normals.empty()
                        ? Vec3<double>{}
                        : transform_normal(own_from_world, vector(mesh.normals, mesh.normal_indices[corner]));
                arrays.normal_indices.push_back(static_cast<std::uint32_t>(normals.size()));
                // Of any length, so that between them they are what they are in the mesh's own space.
                normals.push_back(dot(own, own) > 0 ? own : flat);
            }
        }
        append(arrays.positions, positions);
        append(arrays.normals, normals);
        BlenderSolid part;
        part.slots.assign(mesh.indices.size() / 3, 0);
        part.mesh = ir::make_mesh(name, std::move(arrays));
        BlenderFace& face = part.faces.emplace_back();
        face.sides = member.sides;
        face.member_from_world = own_from_world;
        return part;
    }
    /// The same subtree, or one that ends somewhere outside of the solid, among the tables' nodes.
    std::uint32_t with_end(std::uint32_t node) {
        if (is_finite(solid_bounds(scene_, node))) {
            return node;
        }
        using Box = runtime::Bare<runtime::Box<double>>;
        const Vec3<double> margin = (box_.max - box_.min) * 0.05;
        const auto kind = static_cast<std::uint32_t>(2 * ir::Shape(runtime::Box<double>{}).index());
        const auto index = static_cast<std::uint32_t>(tables_.members(runtime::Of<Box>{}).size());
        tables_.add(runtime::Member<Box>{{{box_.min - margin, box_.max + margin}, {}}, false, 0});
        const auto root = static_cast<std::uint32_t>(tables_.csg_nodes.size());
        tables_.csg_nodes.push_back({runtime::CsgOp::intersect, size(node) + 2, {}});
        for (std::uint32_t i = node; i < node + size(node); ++i) {
            tables_.csg_nodes.push_back(runtime::CsgNode{tables_.csg_nodes[i]});
        }
        tables_.csg_nodes.push_back({runtime::CsgOp::member, 1, {kind, index}});
        return root;
    }
    static void turn_over(BlenderSolid& solid) {
        for (BlenderFace& face : solid.faces) {
            face.inverted = !face.inverted;
        }
        for (BlenderCut& cut : solid.cuts) {
            turn_over(cut.solid);
        }
    }

    const ir::Scene& scene_;
    Scene& tables_;
    const ir::Object& object_;
    Bounds<double> box_;
    runtime::Tolerance<double> tolerance_;
    int parts_ = 0;
};

/// Of one surface without other members.
template <class Shape>
BlenderSolid make_surface(const ir::Scene& scene, const Scene& tables, const ir::Object& object,
                          const Shape& shape, const Bounds<double>& box) {
    const Affine<double>& place = object.world_from_object;
    const auto tolerance = tolerance_for(scene, transform_bounds(place, box));
    const runtime::Bare<Shape> bare{shape, {0, object.sides}};
    Mesh mesh = tessellate_implicit(tables, bare, tolerance_in_object(tolerance, place));
    mesh.deviation *= runtime::stretch_bounds(place).most;
    const Owner owner{object.sides, inverse(place)};
    return SolidMaker(scene, object.path, mesh).make([&](const SolidFace<double>&) { return owner; });
}

} // namespace

std::optional<ir::Function> field_for_nodes(const ir::Scene& scene, std::int32_t field) {
    const ir::Function function = field_with_lattices(scene, field);
    std::optional<ir::Function> result = has_lattice(function) ? std::nullopt : with_gradient(function);
    return result && result->nodes.size() <= most_nodes ? result : std::nullopt;
}

BlenderSolids blender_solids(const ir::Scene& scene) {
    BlenderSolids solids;
    std::optional<Scene> made; // for the first that needs them
    const auto tables = [&]() -> Scene& {
        if (!made) {
            made = solids_of(scene);
        }
        return *made;
    };
    const auto make = [&]<class Shape>(const ir::Object& object,
                                       const Shape& shape) -> std::optional<BlenderSolid> {
        if constexpr (std::is_same_v<Shape, runtime::Csg<double>>) {
            const Bounds<double> box = solid_bounds(scene, shape.root);
            if (!ir::has_mesh(scene, shape)) {
                return make_tree(scene, tables(), object.path, shape.root, tolerance_for(scene, box));
            }
            return CutMaker(scene, tables(), object, box).make(shape.root);
        } else if constexpr (std::is_same_v<Shape, runtime::Implicit<double>>) {
            return make_surface(scene, tables(), object, shape, shape.bounds());
        } else if constexpr (std::is_same_v<Shape, runtime::Quadric<double>>) {
            if (const Bounds<double> box = shape.inside_bounds(); is_finite(box)) {
                return make_surface(scene, tables(), object, shape, box);
            }
        }
        return std::nullopt;
    };
    ir::for_each_object(scene, [&](const ir::Object& object) {
        if (auto solid = std::visit([&](const auto& shape) { return make(object, shape); }, object.shape)) {
            solids.emplace(object.path, std::move(*solid));
        }
    });
    return solids;
}

} // namespace scc::compiler
