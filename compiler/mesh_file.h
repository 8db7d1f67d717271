#pragma once

#include "compiler/ir/scene.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

enum class MeshNormals { file, smooth, flat };

/// What is wrong with a mesh file, in words that name the place in it.
struct MeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LoadedMesh {
    ir::Mesh mesh;
    std::vector<std::string> warnings;
    std::vector<std::string> parts;     ///< what stands after `usemtl`, once each; empty: the file has none
    std::vector<std::uint32_t> part_of; ///< each triangle's, in `parts`, if there are some
};

/// The part that faces before the first `usemtl` are in.
inline constexpr std::string_view unnamed_part = "none";

/// The file's bytes. Throws MeshError.
std::string read_obj(const std::filesystem::path& path);

/// Reads the text of a Wavefront OBJ file through tinyobjloader: polygons are split into triangles,
/// degenerate triangles are left out. `smooth` normals are the face normals around a vertex, weighted by
/// their angle there; `file` falls back to flat shading where the file has no normals. Throws MeshError on
/// what cannot be drawn: no faces, indices beyond the vertices, coordinates that are not finite, faces with
/// fewer than three corners (a truncated file).
LoadedMesh parse_obj(std::string_view text, MeshNormals normals);

/// Both; the mesh has the file's name.
LoadedMesh load_obj(const std::filesystem::path& path, MeshNormals normals);

/// The triangles of one part with the vertices that they use, of the whole mesh's box, normals and place.
/// Throws MeshError if there is no such part.
ir::Mesh select_part(const LoadedMesh& whole, std::string_view part);

} // namespace scc::compiler
