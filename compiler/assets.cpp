#include "compiler/assets.h"

#include <algorithm>

namespace scc::compiler {

namespace fs = std::filesystem;

namespace {

bool lies_in(const fs::path& file, const fs::path& folder) {
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end();
}

fs::path or_here(const fs::path& folder) {
    return folder.empty() ? fs::path(".") : folder;
}

Asset search(const AssetPolicy& policy, const fs::path& folder, const std::string& name) {
    std::error_code error;
    std::vector<fs::path> allowed_folders{or_here(policy.scene_folder)};
    allowed_folders.insert(allowed_folders.end(), policy.asset_paths.begin(), policy.asset_paths.end());
    std::vector<fs::path> folders{or_here(folder)};
    folders.insert(folders.end(), allowed_folders.begin(), allowed_folders.end());

    Asset result;
    for (const fs::path& start : folders) {
        const fs::path file = fs::canonical(start / name, error);
        if (error) {
            continue;
        }
        const bool inside =
            std::any_of(allowed_folders.begin(), allowed_folders.end(), [&](const fs::path& allowed) {
                std::error_code ignored;
                const fs::path root = fs::canonical(allowed, ignored);
                return !ignored && lies_in(file, root);
            });
        if (inside || policy.named_by_user.contains(name)) {
            return {AssetStatus::found, start / name};
        }
        result.status = AssetStatus::outside;
    }
    if (policy.named_by_user.contains(name) && fs::exists(name, error)) {
        return {AssetStatus::found, name};
    }
    return result;
}

} // namespace

Asset find_asset(const AssetPolicy& policy, const fs::path& folder, const std::string& name) {
    Asset asset = search(policy, folder, name);
    if (policy.found && asset.status == AssetStatus::found) {
        policy.found->insert(asset.path.lexically_normal());
    }
    return asset;
}

} // namespace scc::compiler
