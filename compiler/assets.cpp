#include "compiler/assets.h"

#include <algorithm>

namespace scc::compiler {

namespace fs = std::filesystem;

namespace {

bool lies_in(const fs::path& file, const fs::path& folder) {
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end();
}

} // namespace

Asset find_asset(const AssetPolicy& policy, const std::string& name) {
    std::error_code error;
    std::vector<fs::path> folders{policy.scene_folder.empty() ? fs::path(".") : policy.scene_folder};
    folders.insert(folders.end(), policy.asset_paths.begin(), policy.asset_paths.end());

    Asset result;
    for (const fs::path& folder : folders) {
        const fs::path file = fs::canonical(folder / name, error);
        if (error) {
            continue;
        }
        const bool inside = std::any_of(folders.begin(), folders.end(), [&](const fs::path& allowed) {
            std::error_code ignored;
            const fs::path root = fs::canonical(allowed, ignored);
            return !ignored && lies_in(file, root);
        });
        if (inside || policy.named_by_user.contains(name)) {
            return {AssetStatus::found, folder / name};
        }
        result.status = AssetStatus::outside;
    }
    if (policy.named_by_user.contains(name) && fs::exists(name, error)) {
        return {AssetStatus::found, name};
    }
    return result;
}

} // namespace scc::compiler
