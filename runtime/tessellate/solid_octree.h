#pragma once

#include "runtime/tessellate/solid_field.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

/// Cubes around the surface of a solid, small where it is curved.
namespace scc::runtime {

/// A place on the grid of the finest cells.
using GridPoint = std::array<std::uint32_t, 3>;

struct OctreeCell {
    GridPoint at{}; ///< its smallest corner
    std::uint8_t level = 0;
    std::uint8_t inside_corners = 0; ///< bit k: corner k, x in its lowest bit
    Side side = Side::open;          ///< outside or inside: there is no surface in it
    bool is_split = false;           ///< into eight, from `children` on
    std::uint32_t children = 0;
    std::size_t program = 0; ///< where it begins among all cells'; what matters of the function in it
};

template <class S>
class SolidOctree {
public:
    using R = typename S::Real;
    static constexpr int most_levels = 16; ///< so that a grid point fits into 51 bits

    SolidOctree(const SolidField<S>& field, const Tolerance<R>& tolerance, std::size_t most_cells)
        : field_(field), tolerance_(tolerance), most_cells_(most_cells) {
        const Bounds<R>& box = field.bounds();
        const R extent = largest_component(box.max - box.min);
        // Larger, and by an odd amount: corners should not lie on the surfaces that authors give round
        // numbers.
        size_ = extent * R(1.06180339887);
        const R margin = (size_ - extent) * R(0.41421356237);
        const Vec3<R> middle = box.center();
        const Vec3<R> half = (box.max - box.min) * R(0.5);
        origin_ = middle - half - Vec3<R>{margin, margin * R(1.0321), margin * R(0.9713)};
        finest_ = 4;
        while (finest_ < most_levels && size_ / R(1 << finest_) > tolerance.distance / 4) {
            ++finest_;
        }
        programs_ = field.program();
        cells_.push_back({});
        look_at(0);
        refine({0});
    }

    const std::vector<OctreeCell>& cells() const { return cells_; }
    const SolidNode* program_of(const OctreeCell& cell) const { return &programs_[cell.program]; }
    const SolidNode* whole_program() const { return programs_.data(); }

    std::uint32_t units(const OctreeCell& cell) const { return 1U << (finest_ - cell.level); }
    R edge_length(const OctreeCell& cell) const { return size_ / R(1U << cell.level); }
    Vec3<R> position(const GridPoint& p) const {
        const R unit = size_ / R(1U << finest_);
        return origin_ + Vec3<R>{R(p[0]), R(p[1]), R(p[2])} * unit;
    }
    Bounds<R> box(const OctreeCell& cell) const {
        const std::uint32_t n = units(cell);
        return {position(cell.at), position({cell.at[0] + n, cell.at[1] + n, cell.at[2] + n})};
    }

    /// The undivided cell with this finest one in it.
    std::uint32_t find(const GridPoint& finest_cell) const {
        std::uint32_t index = 0;
        while (cells_[index].is_split) {
            const OctreeCell& cell = cells_[index];
            const int shift = finest_ - cell.level - 1;
            std::uint32_t child = 0;
            for (int axis = 0; axis < 3; ++axis) {
                child |= (finest_cell[static_cast<std::size_t>(axis)] >> shift & 1U) << axis;
            }
            index = cell.children + child;
        }
        return index;
    }
    std::uint32_t find(const Vec3<R>& p) const {
        const R most = R((1U << finest_) - 1);
        const auto unit = [&](R coordinate, R origin) {
            const R at = (coordinate - origin) / size_ * R(1U << finest_);
            return static_cast<std::uint32_t>(std::min(std::max(at, R(0)), most));
        };
        return find(GridPoint{unit(p.x, origin_.x), unit(p.y, origin_.y), unit(p.z, origin_.z)});
    }

    /// The face whose function is the solid's at a point.
    std::uint32_t face_at(const Vec3<R>& p) const {
        const OctreeCell& cell = cells_[find(p)];
        const SolidNode* program = cell.side == Side::open ? program_of(cell) : whole_program();
        return program->size == 1 ? program->face : field_.value(program, p).face;
    }

    /// Whether one may be divided further.
    bool is_divisible(const OctreeCell& cell) const {
        return !cell.is_split && cell.level < finest_ && cells_.size() + 8 <= most_cells_;
    }
    /// Divides these so many times, and what comes of them as far as the surface asks.
    void divide(std::vector<std::uint32_t> cells, int times) {
        for (int i = 0; i < times; ++i) {
            std::vector<std::uint32_t> made;
            for (const std::uint32_t index : cells) {
                if (is_divisible(cells_[index]) && (i == 0 || cells_[index].side == Side::open)) {
                    split(index, made);
                }
            }
            cells = std::move(made);
        }
        refine(std::move(cells));
    }

    /// Cells in which there may be more of the surface than their corners show.
    std::size_t uncertain() const {
        return static_cast<std::size_t>(
            std::count_if(cells_.begin(), cells_.end(), [&](const OctreeCell& cell) {
                return !cell.is_split && cell.side == Side::open && !is_one_sheet(cell);
            }));
    }

private:
    static constexpr int least_level = 3;

    static std::uint64_t key(const GridPoint& p) {
        return (std::uint64_t{p[0]} << 34 | std::uint64_t{p[1]} << 17) | p[2];
    }

    /// Level by level, so that where cells run out none is left behind far larger than the others.
    void refine(std::vector<std::uint32_t> cells) {
        while (!cells.empty()) {
            std::vector<std::uint32_t> made;
            for (const std::uint32_t index : cells) {
                if (is_divisible(cells_[index]) && is_too_large(cells_[index])) {
                    split(index, made);
                }
            }
            cells = std::move(made);
        }
    }

    void split(std::uint32_t index, std::vector<std::uint32_t>& made) {
        const auto first = static_cast<std::uint32_t>(cells_.size());
        const OctreeCell parent = cells_[index];
        cells_[index].is_split = true;
        cells_[index].children = first;
        const std::uint32_t half = units(parent) / 2;
        for (std::uint32_t k = 0; k < 8; ++k) {
            OctreeCell child;
            child.level = static_cast<std::uint8_t>(parent.level + 1);
            child.side = parent.side;
            child.program = parent.program;
            for (std::uint32_t axis = 0; axis < 3; ++axis) {
                child.at[axis] = parent.at[axis] + (k >> axis & 1U) * half;
            }
            cells_.push_back(child);
            look_at(first + k);
            made.push_back(first + k);
        }
    }

    /// Finds out on which side a cell is, what matters in it, and the sides of its corners.
    void look_at(std::uint32_t index) {
        OctreeCell& cell = cells_[index];
        if (cell.side == Side::open) {
            const std::size_t begin = programs_.size();
            const std::uint32_t before = programs_[cell.program].size;
            // The copy: the program would move as the vector grows.
            scratch_.assign(programs_.begin() + static_cast<std::ptrdiff_t>(cell.program),
                            programs_.begin() + static_cast<std::ptrdiff_t>(cell.program + before));
            cell.side = field_.reduce(scratch_.data(), box(cell), programs_);
            if (cell.side == Side::open && programs_.size() - begin < before) {
                cell.program = begin;
            } else {
                programs_.resize(begin);
            }
        }
        cell.inside_corners = 0;
        const std::uint32_t n = units(cell);
        for (std::uint32_t k = 0; k < 8; ++k) {
            const GridPoint corner{cell.at[0] + (k & 1U) * n, cell.at[1] + (k >> 1 & 1U) * n,
                                   cell.at[2] + (k >> 2 & 1U) * n};
            cell.inside_corners |= static_cast<std::uint8_t>((is_inside(corner, cell) ? 1U : 0U) << k);
        }
    }
    /// The same for all cells that have the corner.
    bool is_inside(const GridPoint& corner, const OctreeCell& cell) {
        const auto [found, is_new] = corners_.try_emplace(key(corner), false);
        if (is_new) {
            found->second = cell.side == Side::open
                                ? field_.value(program_of(cell), position(corner)).value < 0
                                : cell.side == Side::inside;
        }
        return found->second;
    }

    bool is_too_large(const OctreeCell& cell) const {
        if (cell.side != Side::open) {
            return false;
        }
        return cell.level < least_level || is_curved(cell) ||
               (edge_length(cell) > tolerance_.distance / 2 && !is_one_sheet(cell));
    }

    /// Whether there is a direction in which the function grows everywhere in the cell, so that the surface
    /// in it is a graph over a plane, and each of its faces bends by less than a right angle.
    bool is_one_sheet(const OctreeCell& cell) const {
        const Bounds<R> around = box(cell);
        std::vector<Slopes>& slopes = slopes_;
        slopes.clear();
        bool bounded = true;
        field_.for_each_surface(program_of(cell), [&](const SolidFace<R>& face) {
            bounded = bounded && add_slopes(face, around);
        });
        if (!bounded) {
            return false;
        }
        Vec3<R> direction{};
        for (const Slopes& s : slopes) {
            direction = direction + s.middle;
        }
        constexpr int attempts = 12;
        for (int i = 0; i < attempts; ++i) {
            const Slopes* worst = nullptr;
            R least = R(0.01) * length(direction);
            for (const Slopes& s : slopes) {
                const R growth = s.least_along(direction);
                if (growth < least) {
                    least = growth;
                    worst = &s;
                }
            }
            if (worst == nullptr && length(direction) > 0) {
                return true;
            }
            direction = direction + (worst != nullptr ? worst->middle : Vec3<R>{R(0.1), R(0.2), R(0.3)});
        }
        return false;
    }

    /// Bounds of a face's gradient, in units of its length in the middle.
    struct Slopes {
        Vec3<R> middle; ///< unit
        Vec3<R> around;

        R least_along(const Vec3<R>& direction) const {
            return dot(middle, direction) - dot(around, absolute(direction));
        }
    };
    bool add_slopes(const SolidFace<R>& face, const Bounds<R>& around) const {
        const auto bounds = field_.slopes(face.surface, around);
        Vec3<R> low{bounds[0].min, bounds[1].min, bounds[2].min},
            high{bounds[0].max, bounds[1].max, bounds[2].max};
        const Vec3<R> middle = (low + high) * R(0.5), half = (high - low) * R(0.5);
        const R size = length(middle);
        if (!(size > 0 && size < infinity<R>())) {
            return false;
        }
        const Slopes slopes{middle * (face.sign / size), half * (1 / size)};
        slopes_.push_back(slopes);
        return slopes.least_along(slopes.middle) > R(0.4);
    }

    /// Whether the surface's triangles in a cell would leave the tolerance, by how its normal turns on the
    /// way from the middle to the corners: on a sphere of curvature k by about 0.87 k h, and the middle of a
    /// square of h by h is k h^2 / 4 inside.
    bool is_curved(const OctreeCell& cell) const {
        const Bounds<R> around = box(cell);
        const R size = edge_length(cell);
        bool result = false;
        field_.for_each_surface(program_of(cell), [&](const SolidFace<R>& face) {
            if (result || field_.surfaces()[face.surface].kind == SmoothSurface<R>::Kind::plane) {
                return;
            }
            const R turn = most_turn(face.surface, around);
            const R depth = R(0.29) * size * turn;
            result = !(depth <= tolerance_.distance) ||
                     (R(1.6) * turn > tolerance_.angle && depth > tolerance_.distance * least_bulge);
        });
        return result;
    }
    R most_turn(std::uint32_t surface, const Bounds<R>& around) const {
        const LocalPlane<R> middle = field_.plane_at(surface, around.center());
        R cosine = middle.usable ? R(1) : R(-1);
        for (int k = 0; k < 8 && middle.usable; ++k) {
            const LocalPlane<R> corner =
                field_.plane_at(surface, {(k & 1) != 0 ? around.max.x : around.min.x,
                                          (k & 2) != 0 ? around.max.y : around.min.y,
                                          (k & 4) != 0 ? around.max.z : around.min.z});
            cosine = std::min(cosine, corner.usable ? dot(corner.normal, middle.normal) : R(-1));
        }
        return std::acos(std::max(R(-1), std::min(R(1), cosine)));
    }

public:
    /// Of the tolerance: a surface that bulges less is not divided any further because its normal turns, as
    /// it does at every tip.
    static constexpr R least_bulge = R(1) / 8;

private:
    const SolidField<S>& field_;
    Tolerance<R> tolerance_;
    std::size_t most_cells_;
    Vec3<R> origin_{};
    R size_ = 1;
    int finest_ = 0;
    std::vector<OctreeCell> cells_;
    std::vector<SolidNode> programs_, scratch_;
    std::unordered_map<std::uint64_t, bool> corners_;
    mutable std::vector<Slopes> slopes_;
};

} // namespace scc::runtime
