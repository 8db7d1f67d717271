#pragma once

#include "runtime/math/vec.h"
#include "runtime/raster/stream.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace scc::runtime::raster {

/// Rows of a picture's pixels that show the background alone. Memory takes long to write them, and a
/// processor that has more to do need not wait for it: so they are kept, and written bit by bit between other
/// work.
class BackgroundRows {
public:
    /// `width`: pixels of the longest row.
    BackgroundRows(const Rgb<float>& color, int width) {
        pixels_.reserve(std::size_t{3} * static_cast<std::size_t>(width));
        for (int i = 0; i < width; ++i) {
            pixels_.insert(pixels_.end(), {color.r, color.g, color.b});
        }
    }
    void add(float* to, int width) {
        rows_.push_back({to, std::size_t{3} * static_cast<std::size_t>(width)});
    }

    /// About as much as a processor has under way at once.
    void write_some() {
        if (rows_.empty()) {
            return;
        }
        Row& row = rows_.back();
        const std::size_t count = std::min(at_once, row.numbers);
        stream(pixels_.data(), count, row.to);
        row.to += count;
        row.numbers -= count;
        if (row.numbers == 0) {
            rows_.pop_back();
        }
    }
    void write_all() {
        for (const Row& row : rows_) {
            stream(pixels_.data(), row.numbers, row.to);
        }
        rows_.clear();
        streams_end();
    }

private:
    static constexpr std::size_t at_once = 3 * 48; ///< whole pixels and whole cache lines
    struct Row {
        float* to;
        std::size_t numbers;
    };
    std::vector<float> pixels_; ///< of the background
    std::vector<Row> rows_;
};

} // namespace scc::runtime::raster
