#pragma once

#include "runtime/bounds.h"
#include "runtime/host/cache.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace scc::compiler::ir {

/// A triangle mesh in object space. Three indices per triangle, counter-clockwise seen from the front. The
/// numbers are the owner's, which may be a mapped file.
struct Mesh {
    std::string name;                              ///< file name without folder and extension; unique
    std::span<const float> positions;              ///< x y z each
    std::span<const float> normals;                ///< x y z each, unit; empty: flat shading
    std::span<const std::uint32_t> indices;        ///< into positions
    std::span<const std::uint32_t> normal_indices; ///< into normals; same length as indices, or empty
    std::span<const float> uvs;                    ///< u v each; empty: none
    std::span<const std::uint32_t> uv_indices;     ///< into uvs; same length as indices, or empty
    runtime::Bounds<double> box;                   ///< of all positions
    std::shared_ptr<const void> owner;
    host::Cache cache; ///< may keep what is made of the mesh,
    std::string key;   ///< under this name
};

struct MeshArrays {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices, normal_indices, uv_indices;
};

/// A mesh of these numbers, of which nothing is kept.
Mesh make_mesh(std::string name, MeshArrays arrays);

} // namespace scc::compiler::ir
