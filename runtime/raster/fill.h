#pragma once

#include "runtime/raster/bins.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

/// Which sample of a tile shows which triangle.
namespace scc::runtime::raster {

inline constexpr std::uint32_t no_entry = ~0U;

/// A tile's samples: z* of what is nearest and which of the tile's entries it is. Samples of a block, which
/// are one pack, stand together.
template <class L>
class TileBuffer {
public:
    using R = RealOf<L>;
    static constexpr int N = lane_count<L>;
    static constexpr int block_width = N >= 8 ? 4 : N >= 2 ? 2 : 1;
    static constexpr int block_height = N / block_width;
    static constexpr int size = most_tile_samples;
    static constexpr int blocks_across = size / block_width, blocks_down = size / block_height;
    static_assert(block_width * block_height == N && (N & (N - 1)) == 0 && size % block_height == 0);
    static constexpr std::size_t samples = std::size_t{size} * size;

    TileBuffer() : z_(samples / N), entry_(samples / N) {
        for (int k = 0; k < N; ++k) {
            column_[k] = k % block_width;
            row_[k] = k / block_width;
        }
        columns_ = L(__builtin_convertvector(column_, typename L::Vector));
        rows_ = L(__builtin_convertvector(row_, typename L::Vector));
    }

    /// `left` and `top`: of the tile in the picture. `farthest`: what is not nearer is not shown.
    void clear(int left, int top, R farthest) {
        left_ = left;
        top_ = top;
        std::fill(z_.begin(), z_.end(), L(farthest));
        std::fill(entry_.begin(), entry_.end(), Entries{} + no_entry);
    }

    static std::size_t block_of(int column, int row) {
        return static_cast<std::size_t>(row) / block_height * blocks_across +
               static_cast<std::size_t>(column) / block_width;
    }
    static std::size_t sample_of(int column, int row) {
        return block_of(column, row) * N + static_cast<std::size_t>(row) % block_height * block_width +
               static_cast<std::size_t>(column) % block_width;
    }
    static int column_of(std::uint32_t sample) {
        const auto block = static_cast<int>(sample / N), k = static_cast<int>(sample % N);
        return block % blocks_across * block_width + k % block_width;
    }
    static int row_of(std::uint32_t sample) {
        const auto block = static_cast<int>(sample / N), k = static_cast<int>(sample % N);
        return block / blocks_across * block_height + k / block_width;
    }
    const L& depths(std::size_t block) const { return z_[block]; }
    R depth(int column, int row) const {
        const std::size_t i = sample_of(column, row);
        return lane(z_[i / N], static_cast<int>(i % N));
    }
    std::uint32_t entry(std::size_t sample) const { return entry_[sample / N][sample % N]; }
    using Entries = runtime::detail::VectorType<std::uint32_t, N>;
    const Entries& entries(std::size_t block) const { return entry_[block]; }
    /// The lanes of a block that show an entry, and those that show any.
    MaskOf<L> shows(std::size_t block, std::uint32_t entry) const {
        return from_grid(__builtin_convertvector(entry_[block] == (Entries{} + entry), Grid));
    }
    MaskOf<L> shown(std::size_t block) const { return !shows(block, no_entry); }
    /// Of a block's lanes, from its first.
    const L& columns() const { return columns_; }
    const L& rows() const { return rows_; }

    /// Shows the triangle where nothing nearer is, or something equally near for which `earlier(entry, other
    /// entry)` holds.
    template <class Triangle, class Earlier>
    void fill(const Triangle& t, std::uint32_t entry, Earlier&& earlier) {
        L* const depths = z_.data();
        Entries* const entries = entry_.data();
        cover(t, [&, depths, entries](std::size_t block, const Mask& covered, const L& z) {
            const Mask wins = nearer(block, covered, z, entry, earlier);
            depths[block] = choose(wins, z, depths[block]);
            entries[block] = to_grid(wins) != 0 ? Entries{} + entry : entries[block];
        });
    }
    template <class Earlier>
    void fill(const SmallTriangle<R>& t, std::uint32_t entry, Earlier&& earlier) {
        visit(t, entry, earlier, [this, entry](std::uint32_t sample, const R& z) {
            reinterpret_cast<R*>(z_.data())[sample] = z;
            reinterpret_cast<std::uint32_t*>(entry_.data())[sample] = entry;
        });
    }
    /// The same without showing it: f(sample, z) for each sample.
    template <class Triangle, class Earlier, class F>
    void visit(const Triangle& t, std::uint32_t entry, Earlier&& earlier, F&& f) const {
        cover(t, [&](std::size_t block, const Mask& covered, const L& z) {
            for (unsigned left = bits(nearer(block, covered, z, entry, earlier)); left != 0;
                 left &= left - 1) {
                const int k = __builtin_ctz(left);
                f(static_cast<std::uint32_t>(block * N) + static_cast<std::uint32_t>(k), lane(z, k));
            }
        });
    }
    template <class Earlier, class F>
    void visit(const SmallTriangle<R>& t, std::uint32_t entry, Earlier&& earlier, F&& f) const {
        const R* const depths = reinterpret_cast<const R*>(z_.data());
        const auto* const entries = reinterpret_cast<const std::uint32_t*>(entry_.data());
        for (unsigned left = t.covered; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            const int column = k % SmallTriangle<R>::width, row = k / SmallTriangle<R>::width;
            const R z = (t.z + t.z_y * static_cast<R>(row)) + t.z_x * static_cast<R>(column);
            const std::size_t i = sample_of(t.column + column, t.row + row);
            if (z < depths[i] || (z == depths[i] && entries[i] != no_entry && earlier(entry, entries[i]))) {
                f(static_cast<std::uint32_t>(i), z);
            }
        }
    }
    /// A single sample, in the picture; nothing outside of the tile.
    void put(std::int32_t column, std::int32_t row, R z, std::uint32_t entry) {
        const std::int32_t x = column - left_, y = row - top_;
        if (x >= 0 && y >= 0 && x < size && y < size) {
            const std::size_t i = sample_of(x, y);
            if (z < lane(z_[i / N], static_cast<int>(i % N))) {
                set_lane(z_[i / N], static_cast<int>(i % N), z);
                entry_[i / N][i % N] = entry;
            }
        }
    }
    int left() const { return left_; }
    int top() const { return top_; }

private:
    using Mask = MaskOf<L>;
    using Grid = GridPack<L>;
    template <class Int>
    using Ints = runtime::detail::VectorType<Int, N>;

    static Mask from_grid(const Grid& mask) {
        return Mask(__builtin_convertvector(mask, typename Mask::Vector));
    }
    static Grid to_grid(const Mask& mask) { return __builtin_convertvector(mask.v, Grid); }

    template <class Earlier>
    Mask nearer(std::size_t block, const Mask& covered, const L& z, std::uint32_t entry,
                Earlier&& earlier) const {
        Mask wins = covered & (z < z_[block]);
        const Mask ties = covered & (z == z_[block]);
        if (any(ties)) [[unlikely]] {
            for (unsigned left = bits(ties); left != 0; left &= left - 1) {
                const int k = __builtin_ctz(left);
                const std::uint32_t other = entry_[block][k];
                set_lane(wins, k, other != no_entry && earlier(entry, other));
            }
        }
        return wins;
    }

    /// An edge function over the tile's samples: at + x column + y row is not negative inside.
    struct Edge {
        std::int64_t at;
        std::int32_t x, y;
    };
    static std::int64_t least_over(const Edge& e, const SampleBox& box) {
        return e.at + std::int64_t{e.x} * (e.x < 0 ? box.x1 - 1 : box.x0) +
               std::int64_t{e.y} * (e.y < 0 ? box.y1 - 1 : box.y0);
    }
    static std::int64_t most_over(const Edge& e, const SampleBox& box) {
        return e.at + std::int64_t{e.x} * (e.x < 0 ? box.x0 : box.x1 - 1) +
               std::int64_t{e.y} * (e.y < 0 ? box.y0 : box.y1 - 1);
    }
    /// Exactly: samples are whole steps of the grid apart, so that the function's last bits never change.
    Edge edge(const ScreenTriangle<R>& t, std::size_t i) const {
        const std::size_t k = i == 2 ? 0 : i + 1;
        const std::int32_t x = t.y[i] - t.y[k], y = t.x[k] - t.x[i];
        const std::int64_t at = std::int64_t{y} * (std::int64_t{top_} * grid - t.y[i]) +
                                std::int64_t{x} * (std::int64_t{left_} * grid - t.x[i]);
        const bool is_top_left = x > 0 || (x == 0 && y > 0); // rows run downwards
        return {(at - (is_top_left ? 0 : 1)) >> grid_bits, x, y};
    }

    /// f(block, mask, z) for each block that the triangle covers a part of.
    template <class F>
    void cover(const ScreenTriangle<R>& t, F&& f) const {
        SampleBox box = box_of(t);
        box =
            intersection({box.x0 - left_, box.y0 - top_, box.x1 - left_, box.y1 - top_}, {0, 0, size, size});
        if (box.empty()) {
            return;
        }
        std::array<Edge, 3> edges;
        bool is_wide = false;
        int count = 0;
        const SampleBox blocks = whole_blocks(box);
        for (std::size_t i = 0; i < 3; ++i) {
            const Edge e = edge(t, i);
            if (most_over(e, box) < 0) {
                return;
            }
            if (least_over(e, blocks) < 0) {
                edges[static_cast<std::size_t>(count++)] = e;
                is_wide = is_wide || std::abs(std::int64_t{e.x}) + std::abs(std::int64_t{e.y}) > most_slope;
            }
        }
        // Edges that have the whole box inside need no test.
        for (int i = count; i < 3; ++i) {
            edges[static_cast<std::size_t>(i)] = {0, 0, 0};
        }
        if (is_wide) {
            cover_blocks<std::int64_t>(t, edges, blocks, f);
        } else {
            cover_blocks<std::int32_t>(t, edges, blocks, f);
        }
    }
    template <class F>
    void cover(const NarrowTriangle<R>& t, F&& f) const {
        const SampleBox blocks = whole_blocks(
            intersection({t.column, t.row, t.column + t.columns, t.row + t.rows}, {0, 0, size, size}));
        const std::int32_t from_column = blocks.x0 - t.column, from_row = blocks.y0 - t.row;
        Grid start[3];
        std::int32_t step_x[3], step_y[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::int32_t x = t.edge_x[i], y = t.edge_y[i];
            start[i] = (t.edge[i] + x * from_column + y * from_row) + x * column_ + y * row_;
            step_x[i] = x * block_width;
            step_y[i] = y * block_height;
        }
        const L first_column = columns_ + L(static_cast<R>(from_column));
        L row = rows_ + L(static_cast<R>(from_row));
        for (std::int32_t y = blocks.y0; y < blocks.y1; y += block_height) {
            Grid e0 = start[0], e1 = start[1], e2 = start[2];
            const L z_row = L(t.z) + L(t.z_y) * row;
            L column = first_column;
            std::size_t block = block_of(blocks.x0, y);
            for (std::int32_t x = blocks.x0; x < blocks.x1; x += block_width, ++block) {
                // Blocks in the box of so small a triangle that it leaves out are few, but hard to foresee.
                f(block, from_grid((e0 | e1 | e2) >= 0), z_row + L(t.z_x) * column);
                column = column + L(R(block_width));
                e0 += step_x[0];
                e1 += step_x[1];
                e2 += step_x[2];
            }
            row = row + L(R(block_height));
            start[0] += step_y[0];
            start[1] += step_y[1];
            start[2] += step_y[2];
        }
    }

    /// With slopes up to this, edge functions that are 0 somewhere in the tile have 32 bits all over it.
    static constexpr std::int64_t most_slope = 1 << 24;

    static SampleBox whole_blocks(const SampleBox& box) {
        return {box.x0 & -block_width, box.y0 & -block_height, (box.x1 + block_width - 1) & -block_width,
                (box.y1 + block_height - 1) & -block_height};
    }

    template <class Int, class F>
    void cover_blocks(const ScreenTriangle<R>& t, const std::array<Edge, 3>& edges, const SampleBox& box,
                      F&& f) const {
        Ints<Int> row_start[3], step_x[3], step_y[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const Edge& e = edges[i];
            const auto x = static_cast<Int>(e.x), y = static_cast<Int>(e.y);
            const auto at = static_cast<Int>(e.at + std::int64_t{e.x} * box.x0 + std::int64_t{e.y} * box.y0);
            row_start[i] = at + x * __builtin_convertvector(column_, Ints<Int>) +
                           y * __builtin_convertvector(row_, Ints<Int>);
            step_x[i] = Ints<Int>{} + x * block_width;
            step_y[i] = Ints<Int>{} + y * block_height;
        }
        const std::int32_t from_column = left_ - t.z_column(), from_row = top_ - t.z_row();
        for (std::int32_t y = box.y0; y < box.y1; y += block_height) {
            Ints<Int> e0 = row_start[0], e1 = row_start[1], e2 = row_start[2];
            const L z_row = L(t.z) + L(t.z_y) * (rows_ + L(static_cast<R>(from_row + y)));
            std::size_t block = block_of(box.x0, y);
            for (std::int32_t x = box.x0; x < box.x1; x += block_width, ++block) {
                const auto outside = (e0 | e1 | e2) < 0;
                const Mask covered = !from_grid(__builtin_convertvector(outside, Grid));
                if (any(covered)) {
                    f(block, covered, z_row + L(t.z_x) * (columns_ + L(static_cast<R>(from_column + x))));
                }
                e0 += step_x[0];
                e1 += step_x[1];
                e2 += step_x[2];
            }
            row_start[0] += step_y[0];
            row_start[1] += step_y[1];
            row_start[2] += step_y[2];
        }
    }

    std::vector<L> z_;
    std::vector<Entries> entry_;
    Grid column_{}, row_{}; ///< of a block's lanes
    L columns_, rows_;      ///< the same
    int left_ = 0, top_ = 0;
};

} // namespace scc::runtime::raster
