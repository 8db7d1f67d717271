#pragma once

#include "validation/renderers.h"

#include <optional>
#include <string>
#include <vector>

/// Reading what renderers say about their run.
namespace scc::validation {

/// The lines of a program's talk, progress lines that overwrite each other (carriage returns) reduced to the
/// last.
std::vector<std::string> lines_of(const std::string& text);

struct PovrayOutput {
    std::optional<double> parse; ///< seconds
    std::optional<double> bounding;
    std::optional<double> trace;
    std::vector<std::string> warnings; ///< one per message, unwrapped
    std::vector<std::string> errors;
    std::string version;
    std::string log;
};
PovrayOutput read_povray_output(const std::string& err);

struct BlenderOutput {
    std::optional<double> render; ///< seconds, saving not counted
    std::optional<double> saving;
    std::string error; ///< the last line of a Python traceback
    std::string version;
    std::string log;
};
BlenderOutput read_blender_output(const std::string& out, const std::string& err);

} // namespace scc::validation
