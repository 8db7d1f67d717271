#pragma once

#include "compiler/assets.h"
#include "lang/importer.h"

#include <string>

namespace scc::compiler {

/// A scene file is smaller than this.
inline constexpr std::uintmax_t largest_scene_file = std::uintmax_t{1} << 30;

/// Imports from the disk, relative to the importing file, then from the asset paths. What may be read is what
/// AssetPolicy allows.
class FileImporter : public lang::Importer {
public:
    explicit FileImporter(AssetPolicy policy);

    lang::ImportTarget find(const std::string& from, const std::string& name) override;
    std::string identity(const std::string& path) override;
    lang::ImportText read(const lang::ImportTarget& target) override;

private:
    AssetPolicy policy_;
};

} // namespace scc::compiler
