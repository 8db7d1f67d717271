#pragma once

#include "runtime/raster/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// The lines that wireframes show.
namespace scc::runtime::raster {

namespace detail {

/// One side of a triangle. Edges of neighbours are told by their ends' places, since a mesh's triangles share
/// no numbers.
template <class R>
struct Edge {
    std::array<std::array<R, 3>, 2> ends; ///< the smaller first
    Vec3<R> normal;

    friend bool operator<(const Edge& a, const Edge& b) { return a.ends < b.ends; }
};

template <class R>
Edge<R> edge_between(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& normal) {
    const std::array<R, 3> from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
    return {from < to ? std::array{from, to} : std::array{to, from}, normal};
}

/// What a surface's edges are drawn in: its diffuse colour.
template <class S>
Rgb<typename S::Real> edge_color(const S& scene, const Sides& sides, const Vec3<typename S::Real>& at,
                                 const Vec3<typename S::Real>& normal) {
    using R = typename S::Real;
    const Phong<R>& material = scene.materials[sides.front];
    if constexpr (S::traits.functions) {
        if (material.diffuse.function != no_function) {
            return scene.color_function(material.diffuse.function, SurfacePoint<R>{at, at, normal, {}});
        }
    }
    return material.diffuse.value;
}

} // namespace detail

/// Appends the edges of a surface's polygons, each once: those between triangles in one plane, which divide a
/// polygon, are left out. Planes have none.
template <class S>
void add_edges(const S& scene, const RasterSurface<typename S::Real>& surface,
               RasterModel<typename S::Real>& model) {
    using R = typename S::Real;
    if (surface.at_infinity) {
        return;
    }
    std::vector<detail::Edge<R>> edges;
    edges.reserve(std::size_t{3} * surface.count);
    for (std::uint32_t i = 0; i < surface.count; ++i) {
        const auto corners = world_triangle(model, scene.meshes, surface, i).corners;
        const Vec3<R> normal = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
        for (std::size_t c = 0; c < 3; ++c) {
            edges.push_back(detail::edge_between(corners[c], corners[(c + 1) % 3], normal));
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        bool is_inner = false;
        for (end = begin + 1; end < edges.size() && edges[end].ends == edges[begin].ends; ++end) {
            is_inner = is_inner || dot(edges[end].normal, edges[begin].normal) > R(1) - R(1e-6);
        }
        if (!is_inner) {
            const auto& [a, b] = edges[begin].ends;
            const Vec3<R> from{a[0], a[1], a[2]};
            model.segments.push_back({from,
                                      {b[0], b[1], b[2]},
                                      detail::edge_color(scene, surface.sides, from, edges[begin].normal),
                                      R(1)});
        }
    }
}

} // namespace scc::runtime::raster
