#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace scc::compiler {

/// Where a scene may read files from: its own folder and those of --asset-path. A name that the command line
/// itself gave (`-D model=...`) may also be a path from the working directory, wherever it leads.
struct AssetPolicy {
    std::filesystem::path scene_folder;
    std::vector<std::filesystem::path> asset_paths;
    std::set<std::string> named_by_user; ///< values of -D
};

enum class AssetStatus { found, missing, outside };

struct Asset {
    AssetStatus status = AssetStatus::missing;
    std::filesystem::path path; ///< of the file, if found
};

/// Looks the name up in the scene's folder, then in the asset paths, then, if the user named it, from the
/// working directory. Symbolic links are followed before the folder is checked.
Asset find_asset(const AssetPolicy& policy, const std::string& name);

} // namespace scc::compiler
