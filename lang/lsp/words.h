#pragma once

#include "lang/builtins.h"
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
/// Null for names of other things.
const FunctionDoc* function_named(std::string_view name);
/// Every form of it, a line each: `sin(a: angle) -> number`.
std::string declaration(const FunctionDoc& function);
std::string description(const FunctionDoc& function);

/// A block of code and a text below it, as the protocol's MarkupContent.
Json markdown(const std::string& code, const std::string& text);

} // namespace scc::lang::lsp
