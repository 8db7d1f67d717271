#pragma once

#include "lang/source.h"

#include <cstdint>
#include <string>

namespace scc::lang {

/// A file that an `import` names.
struct ImportTarget {
    enum class Status : std::uint8_t { found, missing, outside };

    Status status = Status::missing;
    std::string path;     ///< as messages name it
    std::string identity; ///< the same however the file is named
    std::string problem;  ///< of a missing one, in words
};

struct ImportText {
    std::string text;
    std::string problem; ///< empty if the file could be read
};

/// Where the files come from that a scene imports: the front end itself opens none.
class Importer {
public:
    virtual ~Importer() = default;
    /// `from` is the path of the importing file as the SourceSet has it, `name` what the author wrote.
    virtual ImportTarget find(const std::string& from, const std::string& name) = 0;
    /// The identity that `find` would give the file with this path.
    virtual std::string identity(const std::string& path) = 0;
    virtual ImportText read(const ImportTarget& target) = 0;
};

} // namespace scc::lang
