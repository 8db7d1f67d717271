#pragma once

#include "compiler/assets.h"
#include "compiler/image_table.h"
#include "compiler/ir/scene.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace scc::compiler {

struct LowerOptions {
    std::string name; ///< of the scene: the file's, without folder and extension
    AssetPolicy assets;
    /// Of imported files, whose assets lie beside them.
    std::map<lang::FileId, std::filesystem::path> import_folders{};
    std::string camera;                      ///< --camera; empty: the scene's choice
    std::optional<runtime::Method> method{}; ///< --mode; nothing: that of the scene's first render
    ImageTable* images = nullptr;            ///< null: there are none
    bool keep_meshes = false;                ///< take them from the user's cache and leave them there
};

/// Makes the Scene IR from a checked module: groups are taken apart into objects with composed transforms,
/// inherited materials are resolved, per-point functions are recorded, meshes are read. Reports what only
/// shows here (a shape that encloses nothing, a mesh file that cannot be read); the scene is only meaningful
/// if no error was reported.
ir::Scene lower(const lang::Module& module, const LowerOptions& options, lang::Diagnostics& diagnostics);

} // namespace scc::compiler
