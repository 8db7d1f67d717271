#pragma once

#include "lang/importer.h"

#include <map>
#include <string>

namespace scc::lang::test {

/// Files held in memory, in one folder. A name that begins with a slash lies outside of it.
class MemoryImporter : public Importer {
public:
    using Files = std::map<std::string, std::string>;

    explicit MemoryImporter(Files files) : files_(std::move(files)) {}

    ImportTarget find(const std::string&, const std::string& name) override {
        if (name.starts_with('/')) {
            return {ImportTarget::Status::outside, {}, {}, {}};
        }
        if (name != "a.scn" && !files_.contains(name)) {
            return {ImportTarget::Status::missing, {}, {}, "there is no such file"};
        }
        return {ImportTarget::Status::found, name, name, {}};
    }
    std::string identity(const std::string& path) override { return path; }
    ImportText read(const ImportTarget& target) override {
        const std::string& text = files_.at(target.path);
        return text == "unreadable" ? ImportText{{}, "it is not readable"} : ImportText{text, {}};
    }

private:
    Files files_;
};

} // namespace scc::lang::test
