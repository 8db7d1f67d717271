#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace scc::validation {

/// A program that scc can make use of.
struct Tool {
    std::string name;    ///< as looked up on PATH
    std::string purpose; ///< "compiles scenes (scc build)"
    bool found = false;
    std::string version;    ///< its own words; empty if not found or if it does not say
    std::string how_to_get; ///< "apt install povray"
};

/// C++ compilers and external renderers, in a fixed order, found or not.
std::vector<Tool> find_tools();

nlohmann::ordered_json to_json(const std::vector<Tool>& tools);

} // namespace scc::validation
