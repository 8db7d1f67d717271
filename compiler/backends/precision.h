#pragma once

#include <string>

namespace scc::compiler {

enum class Precision { single, full };

/// As the command line and the statistics name it.
constexpr const char* name_of(Precision precision) {
    return precision == Precision::single ? "float" : "double";
}

struct PrecisionChoice {
    Precision precision;
    std::string reason; ///< for people
};

} // namespace scc::compiler
