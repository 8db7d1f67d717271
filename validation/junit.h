#pragma once

#include "validation/report.h"

#include <string>

namespace scc::validation {

/// The report for continuous integration, as JUnit XML (UTF-8): a test suite per scene, a test case per
/// renderer. A scene that could not be drawn is an error. Characters that XML cannot hold become U+FFFD.
std::string to_junit(const Report& report);

} // namespace scc::validation
