#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"
#include "runtime/math/pack.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace scc::runtime {

/// A primitive as the builder sees it; each half is loaded as four lanes.
struct alignas(32) BoxRef {
    float min[3];
    std::uint32_t id_code; ///< the id on top of the bits of 1.0: as a float it is not a (slow) subnormal
    float max[3];
    float one = 1;

    std::uint32_t id() const { return id_code - one_bits; }
    static constexpr std::uint32_t one_bits = 0x3f800000;
};

struct Bvh {
    std::vector<BvhNode> nodes;       ///< empty for no primitives
    std::vector<std::uint32_t> order; ///< the primitives' ids as the leaves have them
};

enum class BuildQuality {
    high, ///< binned surface area heuristic over all axes
    quick ///< over the longest axis alone: about four fifths of the time, slower rays
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

inline BoxRef box_ref(const Bounds<float>& b, std::uint32_t id) {
    return {{b.min.x, b.min.y, b.min.z}, BoxRef::one_bits + id, {b.max.x, b.max.y, b.max.z}};
}

namespace detail {

/// Calls work(i) for i in [0, count), on several threads; each i once, in no fixed order.
template <class Work>
void share_work(std::size_t count, int threads, Work&& work) {
    std::atomic<std::size_t> next{0};
    const auto run = [&] {
        for (std::size_t i; (i = next++) < count;) {
            work(i);
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads && static_cast<std::size_t>(i) < count; ++i) {
        others.emplace_back(run);
    }
    run();
}

using Float4 = Pack<float, 4>;

inline Float4 load4(const float* numbers) {
    Float4 result;
    std::memcpy(&result.v, numbers, sizeof result.v);
    return result;
}

/// The fourth lane is not looked at.
struct Box4 {
    Float4 min{std::numeric_limits<float>::infinity()};
    Float4 max{-std::numeric_limits<float>::infinity()};

    void add(const Float4& low, const Float4& high) {
        min = minimum(min, low);
        max = maximum(max, high);
    }
    void add(const Box4& b) { add(b.min, b.max); }
    float half_area() const {
        const Float4 d = max - min;
        return d.v[0] * d.v[1] + d.v[1] * d.v[2] + d.v[2] * d.v[0];
    }
};

/// Binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
/// 2007); a node's children come from splitting the child with the largest surface until there are eight. The
/// result depends on the boxes and their order alone, not on the number of threads.
class BvhBuilder {
public:
    BvhBuilder(std::vector<BoxRef> refs, int threads, BuildQuality quality, std::size_t most_in_leaf)
        : refs_{std::move(refs), std::vector<BoxRef>(refs_[0].size())}, order_(refs_[0].size()),
          threads_(threads), quality_(quality), most_in_leaf_(most_in_leaf) {}

    Bvh build() {
        Bvh bvh;
        if (refs_[0].empty()) {
            return bvh;
        }
        Range all;
        all.end = refs_[0].size();
        for (const BoxRef& ref : refs_[0]) {
            const Float4 low = load4(ref.min), high = load4(ref.max);
            all.box.add(low, high);
            all.centers.add(low + high, low + high);
        }
        build_node(bvh.nodes, all, 0, &tasks_);
        std::vector<std::vector<BvhNode>> parts(tasks_.size());
        share_work(tasks_.size(), threads_,
                   [&](std::size_t i) { build_node(parts[i], tasks_[i].range, tasks_[i].depth, nullptr); });
        append(bvh.nodes, parts);
        bvh.order = std::move(order_);
        return bvh;
    }

private:
    static constexpr int most_bins = 16;
    /// From here on halves: 2^29 primitives end within another 32 levels.
    static constexpr int halving_depth = bvh_max_depth - 32;
    /// Subtrees up to this size are built by one thread each.
    static constexpr std::size_t task_size = 8192;
    static constexpr std::size_t parallel_size = 65536;
    static constexpr std::size_t chunks = 16; ///< of a range whose binning is shared

    struct Range {
        std::size_t begin = 0, end = 0;
        Box4 box;
        Box4 centers; ///< twice the boxes' centres
        int side = 0; ///< which of the two arrays holds it

        std::size_t size() const { return end - begin; }
    };
    struct Task {
        Range range;
        std::uint32_t node; ///< where the subtree belongs
        int slot;
        int depth;
    };
    struct Bin {
        Box4 box;
        std::size_t count = 0;
    };
    using Bins = std::array<std::array<Bin, most_bins>, 3>;
    using Int4 = VectorType<int, 4>;

    /// Which bin a primitive is in, for all axes at once.
    struct Binning {
        Float4 low, scale;
        int count;

        Binning(const Range& range)
            : low(range.centers.min),
              count(static_cast<int>(std::min<std::size_t>(most_bins, 4 + range.size() / 8))) {
            const Float4 extent = range.centers.max - range.centers.min;
            const Float4 usable(std::numeric_limits<float>::max());
            scale = choose((extent > 0) & (extent <= usable), Float4(static_cast<float>(count)) / extent,
                           Float4(0));
            scale = choose(scale <= usable, scale, Float4(0));
        }
        Int4 of(const BoxRef& ref) const {
            const Float4 position = (load4(ref.min) + load4(ref.max) - low) * scale;
            const Float4 last(static_cast<float>(count - 1));
            return __builtin_convertvector(maximum(Float4(0), minimum(last, position)).v, Int4); // NaN: 0
        }
    };
    struct Split {
        int axis = -1;
        int bin = 0; ///< the first on the right
        float cost = std::numeric_limits<float>::infinity();
        Box4 left, right;
        std::size_t left_count = 0;
    };

    BoxRef* array(const Range& range) { return refs_[static_cast<std::size_t>(range.side)].data(); }

    /// Fills a new node at the end of `nodes` and all below it; large subtrees are left to `tasks`, if given.
    void build_node(std::vector<BvhNode>& nodes, const Range& range, int depth, std::vector<Task>* tasks) {
        std::array<Range, bvh_width> children;
        std::array<int, bvh_width> depths{};
        std::size_t count = 1;
        children[0] = range;
        depths[0] = depth;
        while (count < bvh_width) {
            std::size_t widest = bvh_width;
            float area = -1;
            for (std::size_t i = 0; i < count; ++i) {
                if (children[i].size() > most_in_leaf_ && !(children[i].box.half_area() <= area)) {
                    area = children[i].box.half_area();
                    widest = i;
                }
            }
            if (widest == bvh_width) {
                break;
            }
            children[count] = divide(children[widest], depths[widest]);
            depths[count] = ++depths[widest];
            ++count;
        }
        const auto node = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        for (std::size_t i = 0; i < bvh_width; ++i) {
            set_box(nodes[node], i, i < count ? children[i].box : Box4{});
            nodes[node].child[i] = 0;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const Range& child = children[i];
            if (child.size() <= most_in_leaf_) {
                nodes[node].child[i] = make_leaf(child);
            } else if (tasks != nullptr && child.size() <= task_size) {
                tasks->push_back({child, node, static_cast<int>(i), depths[i]});
            } else {
                nodes[node].child[i] = static_cast<std::uint32_t>(nodes.size());
                build_node(nodes, child, depths[i], tasks);
            }
        }
    }

    std::uint32_t make_leaf(const Range& range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            order_[i] = array(range)[i].id();
        }
        return child_of({static_cast<std::uint32_t>(range.begin), static_cast<std::uint32_t>(range.size())});
    }

    static void set_box(BvhNode& node, std::size_t slot, const Box4& box) {
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis][slot] = box.min.v[axis];
            node.max[axis][slot] = box.max.v[axis];
        }
    }

    void append(std::vector<BvhNode>& nodes, const std::vector<std::vector<BvhNode>>& parts) {
        std::vector<std::size_t> base(parts.size() + 1, nodes.size());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            base[i + 1] = base[i] + parts[i].size();
            nodes[tasks_[i].node].child[tasks_[i].slot] = static_cast<std::uint32_t>(base[i]);
        }
        nodes.resize(base.back());
        share_work(parts.size(), threads_, [&](std::size_t i) {
            for (std::size_t k = 0; k < parts[i].size(); ++k) {
                BvhNode node = parts[i][k];
                for (std::size_t slot = 0; slot < bvh_width; ++slot) {
                    if (!is_leaf(node.child[slot]) && node.child[slot] != 0) {
                        node.child[slot] += static_cast<std::uint32_t>(base[i]);
                    }
                }
                nodes[base[i] + k] = node;
            }
        });
    }

    /// Cuts the range, which keeps the left part, and returns the right part.
    Range divide(Range& range, int depth) {
        if (depth < halving_depth) {
            const Binning binning(range);
            const Split split = find_split(range, binning);
            if (split.axis >= 0) {
                return partition(range, binning, split);
            }
        }
        return halve(range); // no plane between bins separates them
    }

    Split find_split(const Range& range, const Binning& binning) {
        Split best;
        if (range.size() < parallel_size) {
            Bins bins;
            fill(bins, range.begin, range.end, range, binning);
            evaluate(bins, range, binning, best);
            return best;
        }
        std::vector<Bins> partial(chunks);
        share_work(chunks, threads_, [&](std::size_t i) {
            fill(partial[i], chunk(range, i), chunk(range, i + 1), range, binning);
        });
        for (std::size_t i = 1; i < chunks; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t bin = 0; bin < most_bins; ++bin) {
                    partial[0][axis][bin].box.add(partial[i][axis][bin].box);
                    partial[0][axis][bin].count += partial[i][axis][bin].count;
                }
            }
        }
        evaluate(partial[0], range, binning, best);
        return best;
    }
    static std::size_t chunk(const Range& range, std::size_t i) {
        return range.begin + range.size() * i / chunks;
    }

    int longest_axis(const Range& range) const {
        const Float4 d = range.centers.max - range.centers.min;
        return d.v[0] >= d.v[1] && d.v[0] >= d.v[2] ? 0 : d.v[1] >= d.v[2] ? 1 : 2;
    }

    void fill(Bins& bins, std::size_t begin, std::size_t end, const Range& range, const Binning& binning) {
        const BoxRef* refs = array(range);
        const auto put = [&](std::size_t axis, int bin, const Float4& low, const Float4& high) {
            Bin& here = bins[axis][static_cast<std::size_t>(bin)];
            here.box.add(low, high);
            ++here.count;
        };
        if (quality_ == BuildQuality::quick) {
            const int axis = longest_axis(range);
            for (std::size_t i = begin; i < end; ++i) {
                put(static_cast<std::size_t>(axis), binning.of(refs[i])[axis], load4(refs[i].min),
                    load4(refs[i].max));
            }
            return;
        }
        for (std::size_t i = begin; i < end; ++i) {
            const Int4 bin = binning.of(refs[i]);
            const Float4 low = load4(refs[i].min), high = load4(refs[i].max);
            put(0, bin[0], low, high);
            put(1, bin[1], low, high);
            put(2, bin[2], low, high);
        }
    }

    void evaluate(const Bins& bins, const Range& range, const Binning& binning, Split& best) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (binning.scale.v[axis] > 0 &&
                (quality_ == BuildQuality::high || axis == longest_axis(range))) {
                evaluate_axis(bins[static_cast<std::size_t>(axis)], axis, range.size(), binning.count, best);
            }
        }
    }

    void evaluate_axis(const std::array<Bin, most_bins>& bins, int axis, std::size_t size, int count,
                       Split& best) const {
        std::array<float, most_bins> right_cost;
        Box4 right;
        std::size_t right_count = 0;
        for (auto i = static_cast<std::size_t>(count - 1); i > 0; --i) {
            right.add(bins[i].box);
            right_count += bins[i].count;
            right_cost[i] = right_count == 0 ? 0.0F : cost(right.half_area(), right_count);
        }
        Box4 left;
        std::size_t left_count = 0;
        int found = 0;
        for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
            left.add(bins[i - 1].box);
            left_count += bins[i - 1].count;
            if (left_count == 0 || left_count == size) {
                continue;
            }
            const float total = cost(left.half_area(), left_count) + right_cost[i];
            if (total < best.cost) {
                best.axis = axis;
                best.cost = total;
                found = best.bin = static_cast<int>(i);
                best.left = left;
                best.left_count = left_count;
            }
        }
        if (found > 0) {
            best.right = Box4{};
            for (auto i = static_cast<std::size_t>(found); i < static_cast<std::size_t>(count); ++i) {
                best.right.add(bins[i].box);
            }
        }
    }
    float cost(float half_area, std::size_t count) const {
        return half_area * static_cast<float>((count + most_in_leaf_ - 1) / most_in_leaf_);
    }

    /// From one array into the other: the left part from the front, the right part from the back.
    Range partition(Range& range, const Binning& binning, const Split& split) {
        Range left, right;
        left.side = right.side = 1 - range.side;
        left.begin = range.begin;
        left.end = right.begin = range.begin + split.left_count;
        right.end = range.end;
        left.box = split.left;
        right.box = split.right;
        if (range.size() < parallel_size) {
            move(range, range.begin, range.end, left.begin, right.end, binning, split, left.centers,
                 right.centers);
        } else {
            move_in_chunks(range, binning, split, left, right);
        }
        range = left;
        return right;
    }

    void move(const Range& range, std::size_t begin, std::size_t end, std::size_t to_left,
              std::size_t to_right, const Binning& binning, const Split& split, Box4& left_centers,
              Box4& right_centers) {
        const BoxRef* from = array(range);
        BoxRef* to = refs_[static_cast<std::size_t>(1 - range.side)].data();
        Box4 centers[2];
        for (std::size_t i = begin; i < end; ++i) {
            const bool is_left = binning.of(from[i])[split.axis] < split.bin;
            to_right -= is_left ? 0 : 1;
            to[is_left ? to_left : to_right] = from[i];
            to_left += is_left ? 1 : 0;
            const Float4 center = load4(from[i].min) + load4(from[i].max);
            centers[is_left ? 0 : 1].add(center, center);
        }
        left_centers = centers[0];
        right_centers = centers[1];
    }

    void move_in_chunks(const Range& range, const Binning& binning, const Split& split, Range& left,
                        Range& right) {
        struct Part {
            std::size_t left = 0;
            Box4 left_centers, right_centers;
        };
        std::array<Part, chunks> parts;
        share_work(chunks, threads_, [&](std::size_t c) {
            const BoxRef* from = array(range);
            for (std::size_t i = chunk(range, c); i < chunk(range, c + 1); ++i) {
                parts[c].left += binning.of(from[i])[split.axis] < split.bin ? 1 : 0;
            }
        });
        std::array<std::size_t, chunks> to_left, to_right;
        std::size_t before = 0;
        for (std::size_t c = 0; c < chunks; ++c) {
            to_left[c] = left.begin + before;
            to_right[c] = right.end - (chunk(range, c) - range.begin - before);
            before += parts[c].left;
        }
        share_work(chunks, threads_, [&](std::size_t c) {
            move(range, chunk(range, c), chunk(range, c + 1), to_left[c], to_right[c], binning, split,
                 parts[c].left_centers, parts[c].right_centers);
        });
        for (const Part& part : parts) {
            left.centers.add(part.left_centers);
            right.centers.add(part.right_centers);
        }
    }

    Range halve(Range& range) {
        const int axis = longest_axis(range);
        BoxRef* refs = array(range);
        const std::size_t middle = range.begin + range.size() / 2;
        std::nth_element(refs + range.begin, refs + middle, refs + range.end,
                         [&](const BoxRef& a, const BoxRef& b) {
                             const float x = ordered_center(a, axis), y = ordered_center(b, axis);
                             return x < y || (x == y && a.id_code < b.id_code);
                         });
        Range right = part_of_range(range, middle, range.end);
        range = part_of_range(range, range.begin, middle);
        return right;
    }
    static float ordered_center(const BoxRef& ref, int axis) {
        const float twice = ref.min[axis] + ref.max[axis];
        return twice == twice ? twice : 0; // of an endless box
    }
    Range part_of_range(const Range& range, std::size_t begin, std::size_t end) {
        Range part;
        part.begin = begin;
        part.end = end;
        part.side = range.side;
        for (std::size_t i = begin; i < end; ++i) {
            const Float4 low = load4(array(range)[i].min), high = load4(array(range)[i].max);
            part.box.add(low, high);
            part.centers.add(low + high, low + high);
        }
        return part;
    }

    std::vector<BoxRef> refs_[2];
    std::vector<std::uint32_t> order_;
    std::vector<Task> tasks_;
    int threads_;
    BuildQuality quality_;
    std::size_t most_in_leaf_;
};

} // namespace detail

/// At most bvh_most_primitives boxes, most_in_leaf <= bvh_max_leaf of them in a leaf.
inline Bvh build_bvh(std::vector<BoxRef> refs, int threads = 1, BuildQuality quality = BuildQuality::high,
                     std::size_t most_in_leaf = bvh_max_leaf) {
    return detail::BvhBuilder(std::move(refs), threads, quality, most_in_leaf).build();
}

} // namespace scc::runtime
