#pragma once

#include <string_view>

/// What must hold for every text, whatever is in it: each aborts where it does not. The fuzzers run one of
/// them each; a test runs all of them over the project's scenes.
namespace scc::lang::fuzz {

/// The lexer: tokens lie one after the other within the text.
void fuzz_lexer(std::string_view text);
/// The parser: a tree with a mistake in it comes with an error.
void fuzz_parser(std::string_view text);
/// The checker and the evaluator, within tight limits; and what their messages look like.
void fuzz_checker(std::string_view text);
/// The formatter: the same tree, and laid out again the same text.
void fuzz_formatter(std::string_view text);

} // namespace scc::lang::fuzz
