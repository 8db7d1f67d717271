#pragma once

#include <cstdint>
#include <string_view>

namespace scc::runtime {

/// A solid made of others by set operations, in world coordinates: a tree in the scene's csg_nodes (see
/// CsgNode in scene.h). Not described by fields: the author writes union, intersection or difference.
template <class R>
struct Csg {
    static constexpr std::string_view name = "csg";

    std::uint32_t root = 0; ///< index into the scene's csg_nodes
};

} // namespace scc::runtime
