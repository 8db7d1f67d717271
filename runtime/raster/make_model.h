#pragma once

#include "runtime/primitive.h"
#include "runtime/raster/edges.h"
#include "runtime/raster/mesh_vertices.h"
#include "runtime/raster/model.h"
#include "runtime/render_settings.h"
#include "runtime/tessellate/shapes.h"
#include "runtime/tessellate/solid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace scc::runtime {

namespace detail {

/// Its normals are for shading alone: the geometric one is the triangle's.
template <class Shape>
inline constexpr bool is_triangle = requires(const Shape& s) {
    s.smooth;
};
template <class Shape>
inline constexpr bool is_plane = requires(const Shape& s) {
    s.offset;
};
template <class Shape>
inline constexpr bool has_formula = Tessellable<Shape, double> || Tessellable<Shape, float>;

template <SceneModel S>
class RasterModelMaker {
    using R = typename S::Real;

public:
    RasterModelMaker(const S& scene, const RenderSettings& settings)
        : scene_(scene), settings_(settings), camera_(scene.camera) {}

    RasterModel<R> run() {
        any_of_kinds_where([]<std::uint32_t kind>() { return uses_kind(S::traits, kind); },
                           [&]<std::uint32_t kind>() {
                               std::uint32_t index = 0;
                               for (const auto& primitive :
                                    scene_.primitives(Of<PrimitiveOfKind<R, kind>>{})) {
                                   add(primitive, kind, index++);
                               }
                               return false;
                           });
        std::stable_sort(model_.surfaces.begin(), model_.surfaces.end(),
                         [](const auto& a, const auto& b) { return a.id < b.id; });
        std::sort(model_.left_out.begin(), model_.left_out.end());
        std::uint64_t count = 0;
        for (RasterSurface<R>& surface : model_.surfaces) {
            surface.first = static_cast<std::uint32_t>(count);
            count += surface.count;
            if (count > raster_most_triangles) {
                throw std::length_error("too many triangles for one picture");
            }
        }
        model_.triangle_count = static_cast<std::uint32_t>(count);
        if constexpr (S::traits.lines) {
            add_lines();
        }
        return std::move(model_);
    }

private:
    /// As far from the surface as the settings allow where it is nearest to the eye.
    Tolerance<R> tolerance_for(const Bounds<R>& box) const {
        const R part = static_cast<R>(settings_.raster.tessellation) * 2 * camera_.half_height;
        if (camera_.projection == Projection::orthographic) {
            return {part};
        }
        const Vec3<R> outside =
            maximum(maximum(box.min - camera_.eye, camera_.eye - box.max), Vec3<R>{0, 0, 0});
        R ahead = infinity<R>();
        for (int i = 0; i < 8; ++i) {
            const Vec3<R> corner{(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                                 (i & 4) != 0 ? box.max.z : box.min.z};
            ahead = std::min(ahead, -dot(corner - camera_.eye, camera_.n));
        }
        // What is seen lies within the angle from the axis to the picture's corner.
        const R aspect = static_cast<R>(settings_.width) / static_cast<R>(settings_.height);
        const R across = camera_.half_height * (aspect + 2 * absolute(camera_.shift_x)),
                down = camera_.half_height * (1 + 2 * absolute(camera_.shift_y));
        const R least_cosine = 1 / std::sqrt(1 + across * across + down * down);
        return {part * std::max({ahead, length(outside) * least_cosine, camera_.near})};
    }

    template <class Shape>
    static const Affine<R>* place_of_primitive(const Bare<Shape>&) {
        return nullptr;
    }
    template <class Shape>
    static const Affine<R>* place_of_primitive(const Placed<Shape, R>& primitive) {
        return &primitive.world_from_object;
    }

    template <class Primitive>
    void add(const Primitive& primitive, std::uint32_t kind, std::uint32_t index) {
        using Shape = decltype(primitive.shape);
        RasterSurface<R> surface;
        surface.kind = kind;
        surface.index = index;
        surface.id = primitive.tag.id;
        surface.sides = primitive.tag.sides;
        if constexpr (is_mesh<Shape>) {
            add_mesh(primitive, surface);
        } else if constexpr (is_csg<Shape>) {
            add_solid(primitive, surface);
        } else if constexpr (is_plane<Shape>) {
            add_plane(primitive, surface);
        } else if constexpr (has_formula<Shape>) {
            surface.is_faceted = is_triangle<Shape>;
            const Tolerance<R> tolerance = tolerance_for(bounds_of(scene_, primitive));
            const Affine<R>* place = place_of_primitive(primitive);
            append(place == nullptr ? tessellate(primitive.shape, tolerance)
                                    : tessellate_in_world(primitive.shape, *place, tolerance),
                   surface);
        } else {
            const Bounds<R> box = member_bounds(scene_, primitive);
            if (!is_finite(box)) {
                model_.left_out.push_back(surface.id);
                return;
            }
            const SolidMesh<R> solid = tessellate_implicit(scene_, primitive, tolerance_for(box));
            Triangles<R> mesh = solid.mesh;
            for (Triangle3& t : mesh.triangles) {
                t.part = solid.faces[t.part].part;
            }
            append(std::move(mesh), surface);
        }
    }
    static bool is_finite(const Bounds<R>& box) {
        return largest_component(box.max - box.min) < infinity<R>();
    }

    void append(Triangles<R> mesh, RasterSurface<R>& surface) {
        const auto positions = static_cast<std::uint32_t>(model_.positions.size()),
                   normals = static_cast<std::uint32_t>(model_.normals.size());
        surface.own = static_cast<std::uint32_t>(model_.triangles.size());
        surface.count = static_cast<std::uint32_t>(mesh.triangles.size());
        model_.positions.insert(model_.positions.end(), mesh.positions.begin(), mesh.positions.end());
        model_.normals.insert(model_.normals.end(), mesh.normals.begin(), mesh.normals.end());
        for (Triangle3& t : mesh.triangles) {
            for (std::size_t c = 0; c < 3; ++c) {
                t.positions[c] += positions;
                t.normals[c] += normals;
            }
            model_.triangles.push_back(t);
        }
        model_.surfaces.push_back(surface);
    }

    template <class Primitive>
    void add_mesh(const Primitive& primitive, RasterSurface<R>& surface) {
        surface.is_mesh = surface.is_faceted = true;
        surface.mesh = primitive.shape.mesh;
        if constexpr (requires { primitive.object_from_world; }) {
            surface.is_placed = true;
            surface.world_from_object = primitive.world_from_object;
            surface.object_from_world = primitive.object_from_world;
            surface.is_mirrored = determinant(primitive.world_from_object) < 0;
        }
        model_.mesh_parts.resize(scene_.meshes.size());
        std::vector<std::uint32_t>& parts = model_.mesh_parts[surface.mesh];
        const MeshData& mesh = scene_.meshes[surface.mesh];
        if (parts.empty()) { // in the order in which they lie in memory
            parts.resize(mesh.triangle_count);
            for (std::uint32_t n = 0; n < mesh.node_count; ++n) {
                for (const std::uint32_t child : mesh.nodes[n].child) {
                    if (is_leaf(child)) {
                        const BvhLeaf leaf = leaf_of(child);
                        for (std::uint32_t i = 0; i < leaf.count; ++i) {
                            parts[leaf.first + i] = part_of({leaf.first, leaf.count, i});
                        }
                    }
                }
            }
            if (settings_.raster.shading == RasterShading::gouraud) {
                model_.mesh_vertices.resize(scene_.meshes.size());
                model_.mesh_vertices[surface.mesh] = raster::shared_vertices(mesh, parts);
            }
        }
        surface.count = static_cast<std::uint32_t>(parts.size());
        model_.surfaces.push_back(surface);
    }

    template <class Primitive>
    void add_plane(const Primitive& primitive, RasterSurface<R>& surface) {
        Vec3<R> normal = primitive.shape.normal, point = normal * primitive.shape.offset;
        if constexpr (requires { primitive.object_from_world; }) {
            normal = normalize(transform_normal(primitive.object_from_world, normal));
            point = transform_point(primitive.world_from_object, point);
        }
        const auto [u, v] = frame_around(normal);
        Triangles<R> mesh;
        // From the foot of the eye, near which most of what is seen lies.
        mesh.add_position(camera_.eye - normal * dot(normal, camera_.eye - point));
        for (const Vec3<R>& direction : {u, v, -u, -v}) {
            mesh.add_position(direction);
        }
        mesh.add_normal(normal);
        for (std::uint32_t i = 0; i < 4; ++i) {
            mesh.add_flat(0, 1 + i, 1 + (i + 1) % 4, 0);
        }
        surface.at_infinity = true;
        append(std::move(mesh), surface);
    }

    /// Each member's share of the surface by itself.
    template <class Primitive>
    void add_solid(const Primitive& primitive, const RasterSurface<R>& surface) {
        const std::uint32_t root = primitive.shape.root;
        const Bounds<R> box = solid_bounds(scene_, root);
        if (!is_finite(box) || has_mesh(root)) {
            model_.left_out.push_back(surface.id);
            return;
        }
        SolidMesh<R> solid = tessellate_solid(scene_, root, tolerance_for(box));
        const auto member_of = [&](const Triangle3& t) {
            const PrimitiveRef& member = solid.faces[t.part].member;
            return std::pair{member.kind, member.index};
        };
        auto& triangles = solid.mesh.triangles;
        std::stable_sort(triangles.begin(), triangles.end(),
                         [&](const auto& a, const auto& b) { return member_of(a) < member_of(b); });
        for (std::size_t begin = 0; begin < triangles.size();) {
            const auto [kind, index] = member_of(triangles[begin]);
            Triangles<R> share;
            share.positions = begin == 0 ? solid.mesh.positions : std::vector<Vec3<R>>{};
            share.normals = begin == 0 ? solid.mesh.normals : std::vector<Vec3<R>>{};
            std::size_t end = begin;
            for (; end < triangles.size() && member_of(triangles[end]) == std::pair{kind, index}; ++end) {
                Triangle3 t = triangles[end];
                t.part = solid.faces[t.part].part;
                share.triangles.push_back(t);
            }
            RasterSurface<R> of_member = surface;
            of_member.kind = member_kinds + kind;
            of_member.index = index;
            visit_member(scene_, PrimitiveRef{kind, index},
                         [&](const auto& member) { of_member.sides = member.primitive.tag.sides; });
            append_share(std::move(share), of_member, begin == 0);
            begin = end;
        }
    }
    /// All shares have the positions and normals that came with the first.
    void append_share(Triangles<R> share, RasterSurface<R>& surface, bool is_first) {
        if (is_first) {
            shared_positions_ = static_cast<std::uint32_t>(model_.positions.size());
            shared_normals_ = static_cast<std::uint32_t>(model_.normals.size());
            append(std::move(share), surface);
            return;
        }
        for (Triangle3& t : share.triangles) {
            for (std::size_t c = 0; c < 3; ++c) { // append() counts from the end
                t.positions[c] += shared_positions_ - static_cast<std::uint32_t>(model_.positions.size());
                t.normals[c] += shared_normals_ - static_cast<std::uint32_t>(model_.normals.size());
            }
        }
        append(std::move(share), surface);
    }
    bool has_mesh(std::uint32_t root) const {
        const std::size_t end = root + scene_.csg_nodes[root].size;
        bool found = false;
        for (std::size_t i = root; i < end; ++i) {
            if (scene_.csg_nodes[i].op == CsgOp::member) {
                visit_member(scene_, scene_.csg_nodes[i].member, [&](const auto& member) {
                    found = found || is_mesh<decltype(member.primitive.shape)>;
                });
            }
        }
        return found;
    }

    void add_lines() {
        if (shows_edges(settings_.raster.shading)) {
            for (const RasterSurface<R>& surface : model_.surfaces) {
                raster::add_edges(scene_, surface, model_);
            }
        }
        model_.segments.insert(model_.segments.end(), scene_.line_segments.begin(),
                               scene_.line_segments.end());
    }

    const S& scene_;
    const RenderSettings& settings_;
    Camera<R> camera_;
    RasterModel<R> model_;
    std::uint32_t shared_positions_ = 0, shared_normals_ = 0;
};

} // namespace detail

/// Surfaces to within RasterSettings::tessellation; planes without end; meshes as they are, which must
/// outlive the model; edges where the shading shows them. For this camera and this size of the picture.
template <SceneModel S>
RasterModel<typename S::Real> raster_model(const S& scene, const RenderSettings& settings) {
    return detail::RasterModelMaker<S>(scene, settings).run();
}

} // namespace scc::runtime
