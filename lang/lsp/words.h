#pragma once

#include "lang/lsp/document.h"
#include "lang/schema.h"
#include "lang/symbols.h"

#include <string>
#include <string_view>
#include <vector>

/// What is said of fields, constructors, functions and names: a line of the language, and sentences about it.
namespace scc::lang::lsp {

/// `radius: number = 1`
std::string declaration(const Field& field);
/// Documentation, rule and choices, in Markdown.
std::string description(const Field& field);
/// `sphere { center, radius, ... }: shape`
std::string declaration(const Constructor& constructor);
std::string description(const Constructor& constructor);
/// `let red: material`, `fn checker(s: surface) -> color`
std::string declaration(const Symbol& symbol, const Analysis& analysis);
/// Every form of a built-in function, as `sin(angle) -> number`.
std::vector<std::string> signatures(std::string_view function);

/// A block of code and a text below it, as the protocol's MarkupContent.
Json markdown(const std::string& code, const std::string& text);

} // namespace scc::lang::lsp
