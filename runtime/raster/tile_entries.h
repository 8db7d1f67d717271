#pragma once

#include "runtime/raster/fill.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::runtime::raster {

/// The triangles and lines that a tile may show, in the order in which they were drawn. Those that it does
/// show are found by marking what each sample shows: that takes no decisions, and most tiles show about half.
class TileEntries {
public:
    void clear() { ids_.clear(); }
    void reserve(std::size_t count) { ids_.reserve(count); }
    bool empty() const { return ids_.empty(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(ids_.size()); }

    /// `id`: of a triangle (see screen_triangle.h), or of a line its segment.
    std::uint32_t add(std::uint32_t id) {
        ids_.push_back(id);
        return size() - 1;
    }
    std::uint32_t id(std::uint32_t entry) const { return ids_[entry]; }

    void clear_marks() { is_marked_.assign(ids_.size() + 1, 0); }
    void mark(std::uint32_t entry) { is_marked_[entry + 1U] = 1; } ///< may be no_entry
    /// Gives each that is marked the number that f(entry) is.
    template <class F>
    void number_marked(F&& f) {
        marked_.resize(ids_.size());
        numbers_.resize(ids_.size());
        std::size_t count = 0;
        for (std::uint32_t entry = 0; entry < size(); ++entry) {
            marked_[count] = entry;
            count += is_marked_[entry + 1U];
        }
        for (std::size_t i = 0; i < count; ++i) {
            numbers_[marked_[i]] = f(marked_[i]);
        }
    }
    std::uint32_t number(std::uint32_t entry) const { return numbers_[entry]; }

private:
    static_assert(no_entry + 1U == 0); // has the first mark
    std::vector<std::uint32_t> ids_, numbers_;
    std::vector<std::uint32_t> marked_; ///< the first of them, one after the other
    std::vector<std::uint8_t> is_marked_;
};

} // namespace scc::runtime::raster
