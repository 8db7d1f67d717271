#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace scc::compiler {

/// Where files that are found are written down, as they are opened; null: nowhere.
using FoundFiles = std::shared_ptr<std::set<std::filesystem::path>>;

/// Where a scene and its imports may read files from: the scene's folder and those of --asset-path. A name
/// that the command line itself gave (`-D model=...`) may also be a path from the working directory, wherever
/// it leads.
struct AssetPolicy {
    std::filesystem::path scene_folder;
    std::vector<std::filesystem::path> asset_paths;
    std::set<std::string> named_by_user; ///< values of -D
    FoundFiles found{};
};

enum class AssetStatus { found, missing, outside };

struct Asset {
    AssetStatus status = AssetStatus::missing;
    std::filesystem::path path; ///< of the file, if found
};

/// Looks the name up in `folder`, that of the file in which it is written, then in the scene's folder, in the
/// asset paths and, if the user named it, from the working directory. Symbolic links are followed before the
/// folder is checked, which is one of the scene's and the asset paths.
Asset find_asset(const AssetPolicy& policy, const std::filesystem::path& folder, const std::string& name);

} // namespace scc::compiler
