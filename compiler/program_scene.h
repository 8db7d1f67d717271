#pragma once

#include "compiler/backends/cpp.h"
#include "runtime/render_settings.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

struct Loaded;
struct SceneOptions;

/// What a program with parameters keeps of its scene, to evaluate it again.
struct ProgramScene {
    std::string file;                              ///< the scene's, one of `texts`
    std::map<std::string, std::string> texts;      ///< by path, relative to the scene's folder
    std::vector<std::string> definitions;          ///< those that it was built with
    std::string camera;                            ///< as --camera
    runtime::Method method = runtime::Method::ray; ///< that it was built for
    std::optional<std::int64_t> frame;             ///< of an animated scene, the one that it was built for
};

ProgramScene program_scene(const Loaded& loaded, const SceneOptions& options);
std::string pack(const ProgramScene& scene);
ProgramScene unpack(std::string_view packed);

/// Of a scene with `param`s.
ProgramParameters parameters_of(const Loaded& loaded, const SceneOptions& options);

} // namespace scc::compiler
