#pragma once

#include "runtime/tessellate/solid_contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// Meshes of solids made of others and of implicit surfaces: closed, each edge of two triangles that run
/// along it in opposite ways, sharp where members' faces meet.
namespace scc::runtime {

/// When to stop dividing.
struct SolidLimits {
    std::size_t most_cells = 6'000'000;
};

template <class R>
struct SolidMesh {
    Triangles<R> mesh; ///< in the world; Triangle3::part indexes `faces`
    std::vector<SolidFace<R>> faces;
    std::vector<SmoothSurface<R>> surfaces; ///< SolidFace::surface indexes them
    R deviation = 0;                        ///< of the mesh from the surface, as measured on all triangles
    std::size_t uncertain = 0; ///< smallest cells that may have more of the surface than their corners show:
                               ///< at tips, in walls thinner than the tolerance
};

namespace detail {

template <class S>
class SolidTessellator {
public:
    using R = typename S::Real;

    SolidTessellator(const SolidField<S>& field, const Tolerance<R>& tolerance, const SolidLimits& limits)
        : field_(field), tolerance_(tolerance), octree_(field, tolerance, limits.most_cells) {}

    SolidMesh<R> run() {
        constexpr int most_rounds = 12;
        SolidMesh<R> result;
        for (int round = 0; round < most_rounds; ++round) {
            SolidContour<S> contour(field_, octree_, memory_);
            std::vector<std::uint32_t> coarse;
            result.deviation = measure(contour, coarse);
            result.mesh = contour.take_mesh();
            if (coarse.empty() || round + 1 == most_rounds) {
                break;
            }
            octree_.divide(coarse, round < 2 ? 1 : 2); // what is left are few sharp places
        }
        result.faces = field_.faces();
        result.surfaces = field_.surfaces();
        result.uncertain = octree_.uncertain();
        return result;
    }

private:
    /// The largest distance of a sample from the surface; collects the cells of triangles that are too far
    /// away, or too large for the way the normal turns, and can be divided.
    R measure(const SolidContour<S>& contour, std::vector<std::uint32_t>& coarse) {
        const Triangles<R>& mesh = contour.mesh();
        std::vector<R> of_points;
        for (const Vec3<R>& p : mesh.positions) {
            of_points.push_back(distance(p));
        }
        R deviation = 0;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle3& triangle = mesh.triangles[i];
            const R away =
                contour.is_at_jump(i) ? size_of(contour.cells_of(i)) : distance(mesh, triangle, of_points);
            deviation = std::max(deviation, away);
            if (away > tolerance_.distance || is_folded(contour, i) ||
                (away > tolerance_.distance * SolidOctree<S>::least_bulge && turns(mesh, triangle))) {
                for (const std::uint32_t cell : contour.cells_of(i)) {
                    if (octree_.is_divisible(octree_.cells()[cell])) {
                        coarse.push_back(cell);
                    }
                }
            }
        }
        std::sort(coarse.begin(), coarse.end());
        coarse.erase(std::unique(coarse.begin(), coarse.end()), coarse.end());
        return deviation;
    }

    /// Within these cells there is a jump.
    R size_of(const std::array<std::uint32_t, 4>& cells) const {
        R size = 0;
        for (const std::uint32_t cell : cells) {
            size = std::max(size, octree_.edge_length(octree_.cells()[cell]));
        }
        return size;
    }

    /// Of the corners, the middle, and the middles of those edges that its neighbours do not look at.
    R distance(const Triangles<R>& mesh, const Triangle3& t, const std::vector<R>& of_points) {
        R most = 0;
        Vec3<R> sum{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t.positions[i], b = t.positions[(i + 1) % 3];
            most = std::max(most, of_points[a]);
            sum = sum + mesh.positions[a];
            if (a < b) {
                most = std::max(most, distance((mesh.positions[a] + mesh.positions[b]) * R(0.5)));
            }
        }
        return std::max(most, distance(sum * (R(1) / 3)));
    }
    /// From a point of the surface nearby: found by steps to first order, since beyond a sharp edge one alone
    /// is less than the distance. 0 where a field has no gradient.
    R distance(const Vec3<R>& p) {
        const auto [found, is_new] = memory_.from_solid.try_emplace({p, 0}, R(0));
        if (is_new) {
            found->second = find_distance(p);
        }
        return found->second;
    }
    R find_distance(const Vec3<R>& p) const {
        constexpr int most_steps = 8;
        Vec3<R> q = p;
        R away = 0;
        for (int i = 0; i < most_steps; ++i) {
            const LocalPlane<R> plane = field_.plane_at(field_.faces()[octree_.face_at(q)].surface, q);
            if (!plane.usable) {
                break;
            }
            q = q - plane.normal * plane.distance;
            away = length(q - p);
            if (std::abs(plane.distance) < (i == 0 ? R(0.125) : R(0.01)) * tolerance_.distance) {
                break;
            }
        }
        return away;
    }

    /// Turned over, and no sliver.
    bool is_folded(const SolidContour<S>& contour, std::size_t i) const {
        if (!contour.is_turned_over(i)) {
            return false;
        }
        const Triangles<R>& mesh = contour.mesh();
        const auto& corners = mesh.triangles[i].positions;
        const Vec3<R>&a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]],
              &c = mesh.positions[corners[2]];
        const R longest = std::max({length(b - a), length(c - b), length(a - c)});
        return length(cross(b - a, c - a)) > tolerance_.distance * longest;
    }

    bool turns(const Triangles<R>& mesh, const Triangle3& t) const {
        const R least = std::cos(tolerance_.angle);
        const Vec3<R>&a = mesh.normals[t.normals[0]], &b = mesh.normals[t.normals[1]],
              &c = mesh.normals[t.normals[2]];
        return dot(a, b) < least || dot(b, c) < least || dot(c, a) < least;
    }

    const SolidField<S>& field_;
    Tolerance<R> tolerance_;
    SolidOctree<S> octree_;
    SolidMemory<R> memory_;
};

template <class S>
SolidMesh<typename S::Real> tessellate_field(const SolidField<S>& field,
                                             const Tolerance<typename S::Real>& tolerance,
                                             const SolidLimits& limits) {
    const auto size = field.bounds().max - field.bounds().min;
    const bool is_bounded =
        size.x > 0 && size.y > 0 && size.z > 0 && largest_component(size) < infinity<typename S::Real>();
    return is_bounded ? SolidTessellator<S>(field, tolerance, limits).run() : SolidMesh<typename S::Real>{};
}

} // namespace detail

/// The solid whose tree begins at csg_nodes[root]. Empty where there is nothing in it, or its members do not
/// bound it.
template <class S>
SolidMesh<typename S::Real> tessellate_solid(const S& scene, std::uint32_t root,
                                             const Tolerance<typename S::Real>& tolerance,
                                             const SolidLimits& limits = {}) {
    return detail::tessellate_field(SolidField<S>::of_solid(scene, root), tolerance, limits);
}

/// A Bare or Placed implicit surface or quadric. Empty where it has no bounds.
template <class S, class Primitive>
SolidMesh<typename S::Real> tessellate_implicit(const S& scene, const Primitive& primitive,
                                                const Tolerance<typename S::Real>& tolerance,
                                                const SolidLimits& limits = {}) {
    return detail::tessellate_field(SolidField<S>::of_implicit(scene, primitive), tolerance, limits);
}

} // namespace scc::runtime
