#include "lang/fuzz/targets.h"

#include "lang/dump.h"
#include "lang/format.h"
#include "lang/test/toy_schema.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace scc::lang::fuzz {

namespace {

void require(bool holds) {
    if (!holds) {
        std::abort();
    }
}

/// Rendering takes far longer than finding, so a few of many have to do.
void require_texts(const SourceSet& sources, const Diagnostics& diagnostics) {
    constexpr std::size_t enough = 8;
    const std::vector<Diagnostic> sorted = diagnostics.sorted();
    for (std::size_t i = 0; i < std::min(enough, sorted.size()); ++i) {
        require(!render_text(sources, sorted[i], true).empty());
    }
}

} // namespace

void fuzz_lexer(std::string_view text) {
    test::Front front(text);
    const std::vector<Token> tokens = front.lex();
    std::uint32_t last = 0;
    for (const Token& token : tokens) {
        require(token.span.begin >= last && token.span.begin <= token.span.end &&
                token.span.end <= text.size());
        last = token.span.end;
    }
    require(!tokens.empty() && tokens.back().kind == TokenKind::end_of_file);
    require(!dump_tokens(front.sources, tokens).empty());
    require_texts(front.sources, front.diagnostics);
}

void fuzz_parser(std::string_view text) {
    test::Front front(text);
    const std::string dump = '\n' + dump_ast(*front.parse());
    require(front.diagnostics.has_errors() || dump.find(" error\n") == std::string::npos);
    require_texts(front.sources, front.diagnostics);
    Diagnostics ignored;
    parse_expression(front.sources, front.file, ignored);
}

void fuzz_checker(std::string_view text) {
    EvaluationLimits limits;
    limits.steps = 20'000;
    limits.list_length = 10'000;
    limits.string_length = 10'000;
    const test::Scene scene(std::string(text), {{"n", "4"}}, limits);
    require_texts(scene.sources, scene.diagnostics);
}

void fuzz_formatter(std::string_view text) {
    test::Front front(text);
    const std::vector<Token> tokens = front.lex();
    const ast::File tree = parse(front.sources, front.file, tokens, front.diagnostics);
    if (front.diagnostics.has_errors()) {
        return;
    }
    test::Front again(format(front.sources, tokens, tree));
    const std::vector<Token> tokens_again = again.lex();
    const ast::File tree_again = parse(again.sources, again.file, tokens_again, again.diagnostics);
    require(dump_ast(tree_again) == dump_ast(tree));
    require(format(again.sources, tokens_again, tree_again) == again.sources.file(again.file).text());
}

} // namespace scc::lang::fuzz
