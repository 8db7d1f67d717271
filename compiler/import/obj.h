#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Wavefront OBJ files and their material libraries, as a beginning of a scene.
namespace scc::compiler::obj {

/// A scene with one `mesh` per part of the file with this text, a material for each that its library
/// describes, and a camera and lights that show all of it. Colours are taken as linear light. `folder`: the
/// OBJ file's, in which alone libraries and images are looked for; `mesh_file`: how the scene names the file.
/// What the library says and a material cannot is a comment there and a warning. Throws MeshError.
std::string scene_text(std::string_view text, const std::filesystem::path& folder, std::string_view mesh_file,
                       std::vector<std::string>& warnings);

} // namespace scc::compiler::obj
