#include "lang/format.h"
#include "lang/test/toy_schema.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

/// Checks and evaluates any text, and lays it out if it parses.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace scc::lang;
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    EvaluationLimits limits;
    limits.steps = 20000;
    limits.list_length = 10000;
    limits.string_length = 10000;
    const test::Scene scene(text, {{"n", "4"}}, limits);
    const auto require = [](bool holds) {
        if (!holds) {
            std::abort();
        }
    };
    constexpr std::size_t enough = 8; // rendering takes far longer than checking
    std::size_t rendered = 0;
    for (const Diagnostic& diagnostic : scene.diagnostics.sorted()) {
        if (rendered++ < enough) {
            require(!render_text(scene.sources, diagnostic, true).empty());
        }
    }
    test::Front front(text);
    const std::vector<Token> tokens = front.lex();
    const ast::File tree = parse(front.sources, front.file, tokens, front.diagnostics);
    if (front.diagnostics.has_errors()) {
        return 0;
    }
    test::Front again(format(front.sources, tokens, tree));
    const std::vector<Token> tokens_again = again.lex();
    const ast::File tree_again = parse(again.sources, again.file, tokens_again, again.diagnostics);
    require(dump_ast(tree_again) == dump_ast(tree));
    require(format(again.sources, tokens_again, tree_again) == again.sources.file(again.file).text());
    return 0;
}
