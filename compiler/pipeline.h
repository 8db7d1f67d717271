#pragma once

#include "compiler/assets.h"
#include "compiler/ir/scene.h"
#include "lang/check.h"
#include "lang/diagnostic.h"
#include "lang/lexer.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace scc::compiler {

/// What the commands that read a scene have in common.
struct SceneOptions {
    std::string file;
    std::vector<std::string> definitions; ///< -D name=value
    std::vector<std::string> asset_paths;
    std::string camera;
    std::optional<runtime::Method> method{}; ///< nothing: that of the scene's first render
    std::optional<std::int64_t> frame;     ///< of an animated scene; nothing: its first
    bool keep_meshes = true;               ///< in the user's cache
    bool tells_frame = true;               ///< of an animated scene, which one was taken
    /// Texts that stand for the content of files; null: none.
    const std::map<std::string, std::string>* texts = nullptr;
    bool only_texts = false; ///< scene files are not read: those are all
};

/// A scene on its way through the stages; each stage is run by `load` as far as it was asked to.
struct Loaded {
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    std::vector<lang::Token> tokens;
    std::shared_ptr<const lang::ast::File> tree;
    lang::Module module;
    ir::Scene scene;
    std::vector<std::pair<std::string, double>> times_ms;
    /// Imports, meshes and images that were found, but not the scene's own file.
    FoundFiles assets = std::make_shared<std::set<std::filesystem::path>>();
};

/// `lowered`: a scene as its author placed it, that the passes have not run over.
enum class Stage { tokens, tree, module, lowered, scene };

/// A file that the command line names. Throws host::FileError.
std::string read_text_file(const std::string& path);

/// Reads the file and runs the stages up to `last`; after errors each does what it can, to find more of them.
/// Throws host::FileError if the scene file cannot be read, host::UsageError for a -D without `=` or a
/// frame that the scene does not have.
Loaded load(const SceneOptions& options, Stage last);

/// Where the files come from that the scene imports.
std::unique_ptr<lang::Importer> make_importer(const SceneOptions& options, FoundFiles found = {});

/// Prints all diagnostics to stderr, what the scene printed, and how many errors there were. True if there
/// were none.
bool report(const Loaded& loaded);

/// As `scc params` lists it, in a line.
std::string described(const lang::Param& param);

} // namespace scc::compiler
