#pragma once

#include <cstdint>
#include <string_view>

namespace scc::runtime {

/// A set of triangles that the scene stores once (see MeshData) and may place many times. Not described by
/// fields: the author names a file, which the compiler reads.
template <class R>
struct Mesh {
    static constexpr std::string_view name = "mesh";

    std::uint32_t mesh = 0; ///< index into the scene's meshes
};

} // namespace scc::runtime
