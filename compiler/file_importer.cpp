#include "compiler/file_importer.h"

#include <fstream>
#include <iterator>
#include <utility>

namespace scc::compiler {

namespace fs = std::filesystem;

using Status = lang::ImportTarget::Status;

/// That a -D has the same text as an import does not make it one that the user named.
FileImporter::FileImporter(AssetPolicy policy) : policy_(std::move(policy)) {
    policy_.named_by_user.clear();
}

lang::ImportTarget FileImporter::find(const std::string& from, const std::string& name) {
    const Asset asset = find_asset(policy_, fs::path(from).parent_path(), name);
    if (asset.status == AssetStatus::outside) {
        return {Status::outside, {}, {}, {}};
    }
    if (asset.status == AssetStatus::missing) {
        return {Status::missing, {}, {}, "there is no such file in the folder of this one"};
    }
    std::error_code error;
    if (!fs::is_regular_file(asset.path, error)) {
        return {Status::missing, {}, {}, "it is not a file"};
    }
    const std::string path = asset.path.lexically_normal().string();
    return {Status::found, path, identity(path), {}};
}

std::string FileImporter::identity(const std::string& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    return error ? path : canonical.string();
}

lang::ImportText FileImporter::read(const lang::ImportTarget& target) {
    std::error_code error;
    if (fs::file_size(target.path, error) > largest_scene_file && !error) {
        return {{}, "it is larger than 1 GiB"};
    }
    std::ifstream stream(target.path, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream.is_open() || stream.bad()) {
        return {{}, "it is not readable"};
    }
    return {std::move(text), {}};
}

lang::ImportTarget TextImporter::find(const std::string& from, const std::string& name) {
    const fs::path beside = fs::path(from).parent_path() / name;
    for (const fs::path& path :
         {beside.lexically_normal(), fs::path(name).lexically_normal(), beside.filename()}) {
        if (texts_.contains(path.string())) {
            return {Status::found, path.string(), path.string(), {}};
        }
    }
    return {Status::missing, {}, {}, "it was not imported when this was built"};
}

lang::ImportText TextImporter::read(const lang::ImportTarget& target) {
    return {texts_.at(target.path), {}};
}

} // namespace scc::compiler
