#pragma once

#include "runtime/tessellate/least_squares.h"
#include "runtime/tessellate/solid_octree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

/// The surface of a solid from the sides of the corners of an octree's cells, by dual contouring (Ju,
/// Losasso, Schaefer, Warren, "Dual Contouring of Hermite Data", 2002): a polygon for each edge of the
/// smallest cells that crosses the surface, between points in the cells around it.
///
/// It is closed and a manifold whatever the signs are: in each rectangle that two cells share, the edges that
/// cross the surface are paired; a cell has a point of its own for each ring that these pairs make on its
/// boundary; and what two polygons would share with others is divided by points in between. As each edge's
/// polygon belongs to the one face that the edge crosses, sharp edges run between polygons, through points
/// that lie on both faces.
namespace scc::runtime {

/// Where an edge of the grid crosses the surface.
template <class R>
struct EdgeCrossing {
    Vec3<R> point{};
    Vec3<R> normal{}; ///< unit, out of the solid
    std::uint32_t face = 0;
    bool is_jump = false; ///< the field has no zero there, or no gradient
};

/// A point together with what is asked of it.
template <class R>
struct AskedPoint {
    Vec3<R> point{};
    std::uint32_t what = 0;

    friend bool operator==(const AskedPoint&, const AskedPoint&) = default;
};
template <class R>
struct AskedPointHash {
    std::size_t operator()(const AskedPoint<R>& asked) const {
        std::size_t hash = asked.what;
        for (const R x : {asked.point.x, asked.point.y, asked.point.z}) {
            hash = (hash ^ std::hash<R>()(x)) * 0x9e3779b97f4a7c15U;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

/// What the octree's refinement leaves as it is, so that it is not calculated again.
template <class R>
struct SolidMemory {
    template <class T>
    using ByPoint = std::unordered_map<AskedPoint<R>, T, AskedPointHash<R>>;

    std::unordered_map<std::uint64_t, EdgeCrossing<R>> crossings; ///< by edge
    ByPoint<Vec3<R>> placed; ///< by cell and the place that the search began at
    ByPoint<R> from_surface; ///< by surface
    ByPoint<R> from_solid;
};

template <class S>
class SolidContour {
public:
    using R = typename S::Real;
    using Crossing = EdgeCrossing<R>;

    SolidContour(const SolidField<S>& field, const SolidOctree<S>& octree, SolidMemory<R>& memory)
        : field_(field), octree_(octree), memory_(memory) {
        find_edges();
        join();
        place_points();
        make_polygons();
    }

    const Triangles<R>& mesh() const { return mesh_; }
    Triangles<R> take_mesh() { return std::move(mesh_); }
    /// The cells around the edge that a triangle was made for.
    const std::array<std::uint32_t, 4>& cells_of(std::size_t triangle) const {
        return edges_[origin_[triangle]].cells;
    }

    /// Whether it shows its back outside, by where its edge crosses the surface.
    bool is_turned_over(std::size_t triangle) const {
        const auto& [a, b, c] = mesh_.triangles[triangle].positions;
        const Vec3<R>& p = mesh_.positions[a];
        return dot(cross(mesh_.positions[b] - p, mesh_.positions[c] - p),
                   edges_[origin_[triangle]].crossing.normal) < 0;
    }
    /// Whether a triangle is where a field jumps, so that there is nothing to measure it by.
    bool is_at_jump(std::size_t triangle) const { return edges_[origin_[triangle]].crossing.is_jump; }

private:
    static constexpr std::uint32_t none = ~0U;

    /// An edge of the smallest cells with ends on different sides.
    struct Edge {
        GridPoint low{};
        std::uint32_t length = 0;
        std::uint32_t axis = 0;
        bool inside_low = false;
        std::array<std::uint32_t, 4> cells{}; ///< counter-clockwise seen from its high end; some may be one
        Crossing crossing;
    };
    /// Where the surface passes from one cell to another, in a rectangle that they share.
    struct Passage {
        std::uint64_t rectangle; ///< its two cells
        std::uint32_t edge;
        std::uint32_t slot; ///< from cells[slot] to cells[slot + 1]
    };

    // ---- edges

    void find_edges() {
        const auto& cells = octree_.cells();
        for (std::uint32_t index = 0; index < cells.size(); ++index) {
            const OctreeCell& cell = cells[index];
            if (!cell.is_split && cell.inside_corners != 0 && cell.inside_corners != 0xff) {
                for (std::uint32_t edge = 0; edge < 12; ++edge) {
                    find_edge(index, cell, edge / 4, edge % 4);
                }
            }
        }
    }
    /// The cell's edge along an axis; `which`: on the low or high side along the next axis and the one after.
    void find_edge(std::uint32_t index, const OctreeCell& cell, std::uint32_t axis, std::uint32_t which) {
        const std::uint32_t b = (axis + 1) % 3, c = (axis + 2) % 3;
        const std::uint32_t corner = (which & 1U) << b | (which >> 1 & 1U) << c;
        const bool low = (cell.inside_corners >> corner & 1U) != 0;
        const bool high = (cell.inside_corners >> (corner | 1U << axis) & 1U) != 0;
        if (low == high) {
            return;
        }
        Edge edge;
        edge.length = octree_.units(cell);
        edge.axis = axis;
        edge.inside_low = low;
        edge.low = cell.at;
        edge.low[b] += (which & 1U) * edge.length;
        edge.low[c] += (which >> 1 & 1U) * edge.length;
        constexpr std::array<std::array<std::uint32_t, 2>, 4> around{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
        bool is_first = true;
        for (std::size_t slot = 0; slot < 4; ++slot) {
            GridPoint at = edge.low;
            at[axis] += edge.length / 2;
            at[b] -= around[slot][0];
            at[c] -= around[slot][1];
            edge.cells[slot] = octree_.find(at);
            const std::uint32_t size = octree_.units(octree_.cells()[edge.cells[slot]]);
            if (size < edge.length) {
                return; // it is divided
            }
            if (size == edge.length && is_first) {
                if (edge.cells[slot] != index) {
                    return; // found from there
                }
                is_first = false;
            }
        }
        edge.crossing = crossing_of(edge, cell);
        edges_.push_back(edge);
    }

    const Crossing& crossing_of(const Edge& edge, const OctreeCell& cell) {
        const std::uint64_t key =
            ((std::uint64_t{edge.low[0]} << 34 | std::uint64_t{edge.low[1]} << 17) | edge.low[2]) |
            std::uint64_t{edge.axis} << 51 | std::uint64_t{cell.level} << 53;
        const auto [found, is_new] = memory_.crossings.try_emplace(key);
        if (is_new) {
            found->second = find_crossing(edge, cell);
        }
        return found->second;
    }
    Crossing find_crossing(const Edge& edge, const OctreeCell& cell) const {
        GridPoint high = edge.low;
        high[edge.axis] += edge.length;
        Vec3<R> inside = octree_.position(edge.low), outside = octree_.position(high);
        if (!edge.inside_low) {
            std::swap(inside, outside);
        }
        const SolidNode* program =
            cell.side == Side::open ? octree_.program_of(cell) : octree_.whole_program();
        return crossing_between(program, inside, outside);
    }

    /// By the Illinois variant of the false position, with halving where that does not get on.
    Crossing crossing_between(const SolidNode* program, const Vec3<R>& inside, const Vec3<R>& outside) const {
        constexpr int most_steps = 100;
        const auto at = [&](R t) { return inside + (outside - inside) * t; };
        R low = 0, high = 1;
        FieldValue<R> at_low = field_.value(program, inside), at_high = field_.value(program, outside);
        R weight_low = at_low.value, weight_high = at_high.value;
        const R finest = 4 * std::numeric_limits<R>::epsilon();
        int last = 0;
        for (int i = 0; i < most_steps && high - low > finest && at_low.value < 0 && at_high.value > 0; ++i) {
            R t = low - weight_low * (high - low) / (weight_high - weight_low);
            if (i % 8 == 7 || !(t > low && t < high)) {
                t = (low + high) / 2;
            }
            const FieldValue<R> middle = field_.value(program, at(t));
            if (middle.value < 0) {
                low = t;
                at_low = middle;
                weight_low = middle.value;
                weight_high = last == -1 ? weight_high / 2 : at_high.value;
                last = -1;
            } else {
                high = t;
                at_high = middle;
                weight_high = middle.value;
                weight_low = last == 1 ? weight_low / 2 : at_low.value;
                last = 1;
            }
        }
        const bool nearer_low = std::abs(at_low.value) < std::abs(at_high.value);
        Crossing result;
        result.point = at(nearer_low ? low : high);
        result.face = nearer_low ? at_low.face : at_high.face;
        const SolidFace<R>& face = field_.faces()[result.face];
        const LocalPlane<R> plane = field_.plane_at(face.surface, result.point);
        const R length_of_edge = length(outside - inside);
        result.is_jump = !plane.usable || !(std::abs(plane.distance) < length_of_edge * R(1e-3));
        result.normal = result.is_jump ? (outside - inside) * (1 / length_of_edge) : plane.normal * face.sign;
        return result;
    }

    // ---- points of cells

    std::uint32_t corner_of(std::uint32_t edge, std::uint32_t slot) const { return edge * 4 + slot % 4; }

    /// Finds which of the cells' corners of polygons are one point, by union of sets.
    void join() {
        parents_.resize(edges_.size() * 4);
        std::iota(parents_.begin(), parents_.end(), 0U);
        std::vector<Passage> passages;
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            for (std::uint32_t slot = 0; slot < 4; ++slot) {
                const std::uint32_t a = edges_[e].cells[slot], b = edges_[e].cells[(slot + 1) % 4];
                if (a == b) {
                    unite(corner_of(e, slot), corner_of(e, slot + 1));
                } else {
                    const auto [low, high] = std::minmax(a, b);
                    passages.push_back({std::uint64_t{low} << 32 | high, e, slot});
                }
            }
        }
        std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
            return std::tie(a.rectangle, a.edge, a.slot) < std::tie(b.rectangle, b.edge, b.slot);
        });
        arcs_.assign(edges_.size() * 4, none);
        for (std::size_t i = 0; i < passages.size();) {
            std::size_t end = i;
            while (end < passages.size() && passages[end].rectangle == passages[i].rectangle) {
                ++end;
            }
            pair_up(&passages[i], end - i);
            i = end;
        }
    }

    /// In one rectangle: two crossings are a pair; of more, those that have the inside between them are.
    void pair_up(Passage* passages, std::size_t count) {
        if (count > 2) {
            sort_around(passages, count);
        }
        for (std::size_t i = 0; i + 1 < count; i += 2) {
            pair(passages[i], passages[i + 1]);
        }
    }
    void pair(const Passage& a, const Passage& b) {
        const auto arc = static_cast<std::uint32_t>(arc_ends_.size());
        arc_ends_.push_back({a.edge, b.edge});
        arcs_[corner_of(a.edge, a.slot)] = arcs_[corner_of(b.edge, b.slot)] = arc;
        for (const std::uint32_t side : {0U, 1U}) {
            const std::uint32_t cell = edges_[a.edge].cells[(a.slot + side) % 4];
            const bool same_way = edges_[b.edge].cells[b.slot] == edges_[a.edge].cells[a.slot];
            const std::uint32_t other = same_way ? side : 1 - side;
            assert(edges_[b.edge].cells[(b.slot + other) % 4] == cell);
            static_cast<void>(cell);
            unite(corner_of(a.edge, a.slot + side), corner_of(b.edge, b.slot + other));
        }
    }

    /// Into the order on the way around the rectangle's boundary, beginning with one where that leaves the
    /// outside.
    void sort_around(Passage* passages, std::size_t count) {
        const auto& one = octree_.cells()[static_cast<std::size_t>(passages->rectangle >> 32)];
        const auto& other = octree_.cells()[static_cast<std::size_t>(passages->rectangle & none)];
        const OctreeCell& smaller = octree_.units(one) < octree_.units(other) ? one : other;
        const std::size_t across = axis_between(one, other), b = (across + 1) % 3, c = (across + 2) % 3;
        const std::uint32_t low_b = smaller.at[b], low_c = smaller.at[c];
        const std::uint64_t size = std::uint64_t{octree_.units(smaller)} * 2;
        const auto turn = [&](const Passage& passage) {
            const Edge& edge = edges_[passage.edge];
            const std::uint64_t x = (edge.low[b] - low_b) * 2 + (edge.axis == b ? edge.length : 0U);
            const std::uint64_t y = (edge.low[c] - low_c) * 2 + (edge.axis == c ? edge.length : 0U);
            return edge.axis == b ? (y == 0 ? x : 3 * size - x) : (x == 0 ? 4 * size - y : size + y);
        };
        std::sort(passages, passages + count,
                  [&](const Passage& p, const Passage& q) { return turn(p) < turn(q); });
        // On the lower sides the way runs along the axes, on the upper ones against b, on the left against c.
        const Edge& first = edges_[passages[0].edge];
        const bool along = first.axis == b ? first.low[c] == low_c : first.low[b] != low_b;
        const bool enters = along != first.inside_low;
        if (!enters) {
            std::rotate(passages, passages + 1, passages + count);
        }
    }
    /// Across which two neighbours have a rectangle in common.
    std::size_t axis_between(const OctreeCell& one, const OctreeCell& other) const {
        const auto touch = [&](std::size_t axis) {
            return one.at[axis] + octree_.units(one) == other.at[axis] ||
                   other.at[axis] + octree_.units(other) == one.at[axis];
        };
        return touch(0) ? 0 : touch(1) ? 1 : 2;
    }

    std::uint32_t root_of(std::uint32_t corner) {
        while (parents_[corner] != corner) {
            corner = parents_[corner] = parents_[parents_[corner]];
        }
        return corner;
    }
    void unite(std::uint32_t a, std::uint32_t b) { parents_[root_of(a)] = root_of(b); }

    void place_points() {
        std::vector<std::uint32_t> order(parents_.size());
        std::iota(order.begin(), order.end(), 0U);
        for (std::uint32_t corner = 0; corner < parents_.size(); ++corner) {
            parents_[corner] = root_of(corner);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return parents_[a] < parents_[b]; });
        points_.resize(parents_.size());
        Patch patch;
        for (std::size_t i = 0; i < order.size();) {
            const std::uint32_t set = parents_[order[i]];
            patch = {&octree_.cells()[edges_[set / 4].cells[set % 4]], {}, {}};
            const auto point = static_cast<std::uint32_t>(mesh_.positions.size());
            std::uint32_t last = none;
            for (; i < order.size() && parents_[order[i]] == set; ++i) {
                const std::uint32_t edge = order[i] / 4, slot = order[i] % 4;
                points_[order[i]] = point;
                if (edge != last) {
                    last = edge;
                    patch.crossings.push_back(&edges_[edge].crossing);
                }
                add_turn(patch, edge, slot, slot + 1);
                add_turn(patch, edge, slot + 3, slot);
            }
            mesh_.add_position(place(patch));
        }
    }

    /// What of the surface is in one cell and hangs together there.
    struct Patch {
        const OctreeCell* cell;
        std::vector<const Crossing*> crossings;
        std::vector<Vec3<R>> turns; ///< middles of the arcs from one face to another
    };
    void add_turn(Patch& patch, std::uint32_t edge, std::uint32_t slot, std::uint32_t next) const {
        const auto& cells = edges_[edge].cells;
        if (cells[slot % 4] != cells[next % 4]) {
            const auto& ends = arc_ends_[arcs_[corner_of(edge, slot)]];
            const Crossing &a = edges_[ends[0]].crossing, &b = edges_[ends[1]].crossing;
            if (surface_of(a) != surface_of(b)) {
                patch.turns.push_back((a.point + b.point) * R(0.5));
            }
        }
    }
    std::uint32_t surface_of(const Crossing& crossing) const { return field_.faces()[crossing.face].surface; }

    /// A point on all the faces that the surface in a cell has.
    Vec3<R> place(const Patch& patch) const {
        const auto& crossings = patch.crossings;
        std::vector<std::uint32_t> surfaces;
        Vec3<R> mean{};
        bool has_jump = false;
        R turn = 1;
        for (const Crossing* crossing : crossings) {
            mean = mean + crossing->point * (1 / R(crossings.size()));
            has_jump |= crossing->is_jump;
            turn = std::min(turn, dot(crossing->normal, crossings[0]->normal));
            const std::uint32_t surface = surface_of(*crossing);
            if (std::find(surfaces.begin(), surfaces.end(), surface) == surfaces.end()) {
                surfaces.push_back(surface);
            }
        }
        if (has_jump) {
            return mean;
        }
        Vec3<R> start = patch.turns.empty() ? mean : Vec3<R>{};
        for (const Vec3<R>& p : patch.turns) {
            start = start + p * (1 / R(patch.turns.size()));
        }
        const auto cell = static_cast<std::uint32_t>(patch.cell - octree_.cells().data());
        const auto [found, is_new] = memory_.placed.try_emplace({start, cell}, start);
        if (is_new) {
            const bool is_bent = turn < R(0.5);
            const auto on_all =
                surfaces.size() > 1 || !is_bent ? on_solid(surfaces, start, *patch.cell) : std::nullopt;
            found->second = on_all                           ? *on_all
                            : surfaces.size() > 1 || is_bent ? on_planes(crossings, start, *patch.cell)
                                                             : mean;
        }
        return found->second;
    }

    /// On these surfaces, and where they leave the solid there, on the one that cuts them off, too.
    std::optional<Vec3<R>> on_solid(std::vector<std::uint32_t> surfaces, const Vec3<R>& start,
                                    const OctreeCell& cell) const {
        constexpr std::size_t most_surfaces = 6;
        const R enough = octree_.edge_length(cell) * R(1e-3);
        std::optional<Vec3<R>> found = on_surfaces(surfaces, start, cell);
        while (found && surfaces.size() < most_surfaces) {
            const std::uint32_t other = field_.faces()[octree_.face_at(*found)].surface;
            const LocalPlane<R> plane = field_.plane_at(other, *found);
            if (!plane.usable || std::abs(plane.distance) <= enough ||
                std::find(surfaces.begin(), surfaces.end(), other) != surfaces.end()) {
                break;
            }
            surfaces.push_back(other);
            const auto further = on_surfaces(surfaces, *found, cell);
            if (!further) {
                break;
            }
            found = further;
        }
        return found;
    }

    /// Near to `start`, by Newton's steps of least length on all of them at once.
    std::optional<Vec3<R>> on_surfaces(const std::vector<std::uint32_t>& surfaces, const Vec3<R>& start,
                                       const OctreeCell& cell) const {
        constexpr int most_steps = 16;
        const R size = octree_.edge_length(cell);
        const R enough = std::max(size * R(1e-7), largest_component(absolute(start)) * 16 *
                                                      std::numeric_limits<R>::epsilon());
        Vec3<R> p = start;
        for (int i = 0; i < most_steps; ++i) {
            PlaneFit<R> fit;
            for (const std::uint32_t surface : surfaces) {
                const LocalPlane<R> plane = field_.plane_at(surface, p);
                if (!plane.usable) {
                    return std::nullopt;
                }
                fit.add(plane.normal, -plane.distance);
            }
            const Vec3<R> step = fit.solve(R(1e-4));
            p = p + step;
            if (!is_near(p, cell, size * 2)) {
                return std::nullopt;
            }
            if (length(step) <= enough) {
                return p;
            }
        }
        return std::nullopt;
    }
    /// Where the tangential planes of the crossings meet: at a tip, or at the edge of a crease in a field.
    Vec3<R> on_planes(const std::vector<const Crossing*>& crossings, const Vec3<R>& start,
                      const OctreeCell& cell) const {
        PlaneFit<R> fit;
        for (const Crossing* crossing : crossings) {
            fit.add(crossing->normal, dot(crossing->normal, crossing->point - start));
        }
        const Vec3<R> p = start + fit.solve(R(0.02));
        const Bounds<R> box = octree_.box(cell);
        return minimum(maximum(p, box.min), box.max);
    }
    bool is_near(const Vec3<R>& p, const OctreeCell& cell, R slack) const {
        const Bounds<R> box = octree_.box(cell);
        const Vec3<R> low = p - box.min, high = box.max - p;
        return std::min({low.x, low.y, low.z, high.x, high.y, high.z}) >= -slack;
    }

    // ---- polygons

    static std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax(a, b);
        return std::uint64_t{low} << 32 | high;
    }

    void make_polygons() {
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            for_each_side(e,
                          [&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++uses_[pair_key(a, b)]; });
        }
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            make_polygon(e);
        }
    }
    /// f(point, next point, arc)
    template <class F>
    void for_each_side(std::uint32_t e, F&& f) const {
        for (std::uint32_t slot = 0; slot < 4; ++slot) {
            if (edges_[e].cells[slot] != edges_[e].cells[(slot + 1) % 4]) {
                f(points_[corner_of(e, slot)], points_[corner_of(e, slot + 1)], arcs_[corner_of(e, slot)]);
            }
        }
    }

    void make_polygon(std::uint32_t e) {
        std::vector<std::uint32_t>& corners = corners_;
        corners.clear();
        for_each_side(e, [&](std::uint32_t a, std::uint32_t b, std::uint32_t arc) {
            corners.push_back(a);
            if (uses_.at(pair_key(a, b)) > 2) {
                corners.push_back(point_on(arc, a, b));
            }
        });
        if (!edges_[e].inside_low) {
            std::reverse(corners.begin(), corners.end());
        }
        if (corners.size() == 3) {
            add_triangle(e, corners[0], corners[1], corners[2]);
        } else if (corners.size() == 4) {
            make_quad(e);
        } else {
            make_fan(e);
        }
    }
    /// Two pairs of cells' points may be joined by several arcs of the surface: each has a point of its own.
    std::uint32_t point_on(std::uint32_t arc, std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] = on_arcs_.try_emplace(arc, 0);
        if (is_new) {
            found->second = mesh_.add_position((mesh_.positions[a] + mesh_.positions[b]) * R(0.5));
        }
        return found->second;
    }

    void make_quad(std::uint32_t e) {
        const std::array<std::uint32_t, 4> q{corners_[0], corners_[1], corners_[2], corners_[3]};
        const Crossing& crossing = edges_[e].crossing;
        const Diagonal one = diagonal(q[0], q[1], q[2], q[3], crossing),
                       other = diagonal(q[1], q[2], q[3], q[0], crossing);
        const bool takes_one = one.is_better(other);
        const Diagonal& best = takes_one ? one : other;
        const R in_fan = std::min({facing(q[0], q[1], crossing), facing(q[1], q[2], crossing),
                                   facing(q[2], q[3], crossing), facing(q[3], q[0], crossing)});
        const std::size_t first = takes_one ? 0 : 1;
        if ((best.facing < R(0.1) && in_fan > best.facing) || !is_first_use(q[first], q[first + 2])) {
            make_fan(e);
            return;
        }
        add_triangle(e, q[first], q[first + 1], q[(first + 2) % 4]);
        add_triangle(e, q[first], q[(first + 2) % 4], q[(first + 3) % 4]);
    }
    bool is_first_use(std::uint32_t a, std::uint32_t b) { return uses_[pair_key(a, b)]++ == 0; }

    /// What cutting a quadrangle from a to c makes.
    struct Diagonal {
        R facing;   ///< the smaller cosine between its triangles and the surface
        R distance; ///< of its middle from the surface

        bool is_better(const Diagonal& other) const {
            const bool fine = facing > R(0.1), other_fine = other.facing > R(0.1);
            return fine != other_fine ? fine : fine ? distance <= other.distance : facing >= other.facing;
        }
    };
    Diagonal diagonal(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                      const Crossing& crossing) {
        const auto cosine = [&](std::uint32_t i, std::uint32_t k, std::uint32_t l) {
            return cosine_to(mesh_.positions[i], mesh_.positions[k], mesh_.positions[l], crossing.normal);
        };
        const Vec3<R> middle = (mesh_.positions[a] + mesh_.positions[c]) * R(0.5);
        const std::uint32_t surface = surface_of(crossing);
        const auto [found, is_new] = memory_.from_surface.try_emplace({middle, surface}, R(0));
        if (is_new) {
            found->second = std::abs(field_.plane_at(surface, middle).distance);
        }
        return {std::min(cosine(a, b, c), cosine(a, c, d)), found->second};
    }
    R facing(std::uint32_t a, std::uint32_t b, const Crossing& crossing) const {
        return cosine_to(crossing.point, mesh_.positions[a], mesh_.positions[b], crossing.normal);
    }
    static R cosine_to(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c, const Vec3<R>& normal) {
        const Vec3<R> n = cross(b - a, c - a);
        const R size = length(n);
        return size > 0 ? dot(n, normal) / size : R(-1);
    }

    /// Around the place where the edge crosses the surface.
    void make_fan(std::uint32_t e) {
        const std::vector<std::uint32_t> ring = corners_;
        const std::uint32_t center = mesh_.add_position(edges_[e].crossing.point);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            add_triangle(e, center, ring[i], ring[(i + 1) % ring.size()]);
        }
    }

    void add_triangle(std::uint32_t e, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        Triangle3 triangle{{a, b, c}, {}, edges_[e].crossing.face};
        const Vec3<R>&pa = mesh_.positions[a], &pb = mesh_.positions[b], &pc = mesh_.positions[c];
        const Vec3<R> flat = cross(pb - pa, pc - pa), middle = (pa + pb + pc) * (R(1) / 3);
        const R size = length(flat);
        const Vec3<R> facing = size > 0 ? flat * (1 / size) : edges_[e].crossing.normal;
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.normals[i] = normal_at(triangle.positions[i], edges_[e].crossing, facing, middle);
        }
        mesh_.triangles.push_back(triangle);
        origin_.push_back(e);
    }
    /// Of the face, exact; where that has none, or where it belongs to the other side of a crease in a field,
    /// that in the triangle's middle, or else the triangle's own.
    std::uint32_t normal_at(std::uint32_t point, const Crossing& crossing, const Vec3<R>& facing,
                            const Vec3<R>& middle) {
        constexpr R most_apart = R(0.5); // cosine
        const SolidFace<R>& face = field_.faces()[crossing.face];
        const auto [found, is_new] = normals_.try_emplace(std::uint64_t{point} << 32 | crossing.face, none);
        if (is_new && !crossing.is_jump) {
            const LocalPlane<R> plane = field_.plane_at(face.surface, mesh_.positions[point]);
            if (plane.usable) {
                found->second = mesh_.add_normal(plane.normal * face.sign);
            }
        }
        if (found->second != none && dot(mesh_.normals[found->second], facing) > most_apart) {
            return found->second;
        }
        const LocalPlane<R> plane =
            crossing.is_jump ? LocalPlane<R>{} : field_.plane_at(face.surface, middle);
        const Vec3<R> normal = plane.normal * face.sign;
        return mesh_.add_normal(plane.usable && dot(normal, facing) > most_apart ? normal : facing);
    }

    const SolidField<S>& field_;
    const SolidOctree<S>& octree_;
    SolidMemory<R>& memory_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> parents_;                 ///< of each edge's corner in each of its four cells
    std::vector<std::uint32_t> arcs_;                    ///< of each edge, towards the next of its cells
    std::vector<std::array<std::uint32_t, 2>> arc_ends_; ///< the edges that an arc joins
    std::vector<std::uint32_t> points_;                  ///< of each edge in each of its four cells
    std::unordered_map<std::uint64_t, std::uint32_t> uses_; ///< how many polygons' sides join two points
    std::unordered_map<std::uint32_t, std::uint32_t> on_arcs_;
    std::unordered_map<std::uint64_t, std::uint32_t> normals_; ///< of a point and a face
    std::vector<std::uint32_t> corners_;                       ///< of the polygon that is being made
    Triangles<R> mesh_;
    std::vector<std::uint32_t> origin_; ///< of each triangle: its edge
};

} // namespace scc::runtime
