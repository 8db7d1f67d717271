#pragma once

#include "compiler/assets.h"
#include "lang/importer.h"

#include <cstdint>
#include <map>
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

/// Imports texts that are in memory, by their paths relative to the scene's folder; one from elsewhere has
/// its file's name only.
class TextImporter : public lang::Importer {
public:
    /// `texts` must outlive this.
    explicit TextImporter(const std::map<std::string, std::string>& texts) : texts_(texts) {}

    lang::ImportTarget find(const std::string& from, const std::string& name) override;
    std::string identity(const std::string& path) override { return path; }
    lang::ImportText read(const lang::ImportTarget& target) override;

private:
    const std::map<std::string, std::string>& texts_;
};

} // namespace scc::compiler
