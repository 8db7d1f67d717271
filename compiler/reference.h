#pragma once

#include <string>

namespace scc::compiler {

/// The reference of the language in Markdown: made from the tables that the compiler itself works with, so
/// that it says what is so. `lang/reference.md` is this text. Every block marked `scn` is a scene without
/// mistakes; one that begins with the comment `// name.scn` is a file that later blocks import.
std::string reference_text();

} // namespace scc::compiler
