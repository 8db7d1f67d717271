#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace scc::runtime {

struct Bvh {
    std::vector<BvhNode> nodes;       ///< empty for no primitives
    std::vector<std::uint32_t> order; ///< the primitives as the leaves have them
};

inline float round_to_float_down(long double x) {
    const float f = static_cast<float>(x);
    return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

/// A box of floats around the given one.
template <class R>
Bounds<float> round_outwards(const Bounds<R>& b) {
    const auto up = [](R x) { return -round_to_float_down(-x); };
    return {{round_to_float_down(b.min.x), round_to_float_down(b.min.y), round_to_float_down(b.min.z)},
            {up(b.max.x), up(b.max.y), up(b.max.z)}};
}

namespace detail {

/// Binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
/// 2007). The result depends on the boxes and their order alone.
class BvhBuilder {
public:
    explicit BvhBuilder(const std::vector<Bounds<float>>& boxes) : boxes_(boxes) {
        bvh_.order.resize(boxes.size());
        std::iota(bvh_.order.begin(), bvh_.order.end(), 0U);
        centers_.reserve(boxes.size());
        for (const Bounds<float>& box : boxes) {
            centers_.push_back(box.center());
        }
    }

    Bvh build() {
        if (!boxes_.empty()) {
            bvh_.nodes.reserve(boxes_.size());
            bvh_.nodes.emplace_back();
            build_node(0, 0, boxes_.size(), 0);
        }
        return std::move(bvh_);
    }

private:
    static constexpr std::size_t bins = 16;
    static constexpr std::size_t max_leaf = 4;
    static constexpr float step_cost = 1.2F; ///< of a node, in primitives
    /// From here on halves: 2^32 primitives end within another 32 levels.
    static constexpr int halving_depth = bvh_max_depth - 33;

    struct Bin {
        Bounds<float> box;
        std::size_t count = 0;
    };
    struct Split {
        int axis = -1;
        std::size_t bin = 0; ///< the first on the right
        float cost = std::numeric_limits<float>::infinity();
    };

    static float at(const Vec3<float>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
    static float half_area(const Bounds<float>& b) {
        const Vec3<float> d = b.max - b.min;
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }

    void build_node(std::size_t node, std::size_t begin, std::size_t end, int depth) {
        Bounds<float> box, center_box;
        for (std::size_t i = begin; i < end; ++i) {
            box.add(boxes_[bvh_.order[i]]);
            center_box.add(centers_[bvh_.order[i]]);
        }
        const std::size_t count = end - begin;
        std::size_t middle = begin;
        if (count > 1) {
            middle = depth < halving_depth ? split(begin, end, box, center_box) : begin + count / 2;
            if (depth >= halving_depth || (middle == begin && count > max_leaf)) {
                middle = halve(begin, end, center_box);
            }
        }
        BvhNode& built = bvh_.nodes[node];
        set_box(built, box);
        if (middle == begin) {
            built.first = static_cast<std::uint32_t>(begin);
            built.count = static_cast<std::uint32_t>(count);
            return;
        }
        const std::size_t child = bvh_.nodes.size();
        built.first = static_cast<std::uint32_t>(child);
        built.count = 0;
        bvh_.nodes.resize(child + 2);
        build_node(child, begin, middle, depth + 1);
        build_node(child + 1, middle, end, depth + 1);
    }

    static void set_box(BvhNode& node, const Bounds<float>& box) {
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis] = at(box.min, axis);
            node.max[axis] = at(box.max, axis);
        }
    }

    /// Sorts the range around the cheapest split and returns where it is; `begin` where a leaf is cheaper or
    /// no split exists.
    std::size_t split(std::size_t begin, std::size_t end, const Bounds<float>& box,
                      const Bounds<float>& center_box) {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            find_split(begin, end, axis, center_box, best);
        }
        const std::size_t count = end - begin;
        const bool leaf_is_cheaper =
            best.cost + step_cost * half_area(box) >= static_cast<float>(count) * half_area(box);
        if (best.axis < 0 || (count <= max_leaf && leaf_is_cheaper)) {
            return begin;
        }
        const auto first = bvh_.order.begin();
        const auto middle = std::stable_partition(
            first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end),
            [&](std::uint32_t i) { return bin_of(centers_[i], best.axis, center_box) < best.bin; });
        return static_cast<std::size_t>(middle - first);
    }

    static std::size_t bin_of(const Vec3<float>& center, int axis, const Bounds<float>& center_box) {
        const float low = at(center_box.min, axis), extent = at(center_box.max, axis) - low;
        const float position = (at(center, axis) - low) / extent * static_cast<float>(bins);
        return position < static_cast<float>(bins) ? static_cast<std::size_t>(position)
                                                   : bins - 1; // also for NaN
    }

    void find_split(std::size_t begin, std::size_t end, int axis, const Bounds<float>& center_box,
                    Split& best) const {
        const float extent = at(center_box.max, axis) - at(center_box.min, axis);
        if (!(extent > 0) || !(extent < std::numeric_limits<float>::infinity())) {
            return;
        }
        std::array<Bin, bins> bin;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t primitive = bvh_.order[i];
            Bin& here = bin[bin_of(centers_[primitive], axis, center_box)];
            here.box.add(boxes_[primitive]);
            ++here.count;
        }
        std::array<float, bins> right_cost{};
        Bin right;
        for (std::size_t i = bins - 1; i > 0; --i) {
            right.box.add(bin[i].box);
            right.count += bin[i].count;
            right_cost[i] = cost_of(right);
        }
        Bin left;
        for (std::size_t i = 1; i < bins; ++i) {
            left.box.add(bin[i - 1].box);
            left.count += bin[i - 1].count;
            const float cost = cost_of(left) + right_cost[i];
            if (left.count > 0 && left.count < end - begin && cost < best.cost) {
                best = {axis, i, cost};
            }
        }
    }

    static float cost_of(const Bin& bin) {
        return bin.count == 0 ? 0.0F : half_area(bin.box) * static_cast<float>(bin.count);
    }

    /// For boxes that no plane between bins separates.
    std::size_t halve(std::size_t begin, std::size_t end, const Bounds<float>& center_box) {
        const Vec3<float> extent = center_box.max - center_box.min;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto first = bvh_.order.begin();
        std::nth_element(first + static_cast<std::ptrdiff_t>(begin),
                         first + static_cast<std::ptrdiff_t>(middle),
                         first + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t i, std::uint32_t j) {
                             const float x = at(centers_[i], axis), y = at(centers_[j], axis);
                             return x < y || (x == y && i < j);
                         });
        return middle;
    }

    const std::vector<Bounds<float>>& boxes_;
    std::vector<Vec3<float>> centers_;
    Bvh bvh_;
};

} // namespace detail

inline Bvh build_bvh(const std::vector<Bounds<float>>& boxes) {
    return detail::BvhBuilder(boxes).build();
}

} // namespace scc::runtime
