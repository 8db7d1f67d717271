#pragma once

#include "compiler/backends/cpp.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

struct Loaded;
struct SceneOptions;

/// What a program with parameters keeps of its scene, to evaluate it again.
struct ProgramScene {
    std::string file;                         ///< the scene's, one of `texts`
    std::map<std::string, std::string> texts; ///< by path, relative to the scene's folder
    std::vector<std::string> definitions;     ///< those that it was built with
    std::string camera;                       ///< as --camera
};

ProgramScene program_scene(const Loaded& loaded, const SceneOptions& options);
std::string pack(const ProgramScene& scene);
ProgramScene unpack(std::string_view packed);

/// Of a scene with `param`s.
ProgramParameters parameters_of(const Loaded& loaded, const SceneOptions& options);

} // namespace scc::compiler
