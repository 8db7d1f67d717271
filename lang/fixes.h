#pragma once

#include "lang/diagnostic.h"
#include "lang/source.h"

#include <cstddef>
#include <string>
#include <vector>

namespace scc::lang {

/// The fixes for one file that can be made together, in its order: of two that touch the same text, the one
/// that was reported first.
std::vector<Fix> fixes_for(FileId file, const std::vector<Diagnostic>& diagnostics);

/// The text with fixes as fixes_for gives them.
std::string with_fixes(std::string_view text, const std::vector<Fix>& fixes);

} // namespace scc::lang
