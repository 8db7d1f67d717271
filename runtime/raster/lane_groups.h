#pragma once

#include "runtime/math/pack.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace scc::runtime::raster {

/// A pack's lanes by what they have in common. Most packs of a tile's samples show few triangles, so that
/// what is read of each triangle once is read far less often than lane by lane. Every lane is in one group.
template <class L>
class LaneGroups {
public:
    using Mask = MaskOf<L>;
    struct Group {
        Mask lanes;
        std::uint32_t number;
    };

    /// The first group has the inactive lanes, too; the others are added by their own lanes.
    void add(const Mask& lanes, std::uint32_t number) { groups_[count_++] = {lanes, number}; }

    std::uint32_t first() const { return groups_[0].number; }
    const Group* begin() const { return groups_.data(); }
    const Group* end() const { return groups_.data() + count_; }

    /// get(number), of the same type as V(...) or what a V can be made from, in the lanes of each group.
    template <class V, class Get>
    V gather(Get&& get) const {
        V result(get(groups_[0].number));
        for (std::size_t i = 1; i < count_; ++i) {
            result = choose(groups_[i].lanes, V(get(groups_[i].number)), result);
        }
        return result;
    }

private:
    std::array<Group, static_cast<std::size_t>(lane_count<L>)> groups_;
    std::size_t count_ = 0;
};

} // namespace scc::runtime::raster
