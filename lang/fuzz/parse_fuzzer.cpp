#include "lang/dump.h"
#include "lang/lexer.h"
#include "lang/parser.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

using namespace scc::lang;

void require(bool holds) {
    if (!holds) {
        std::abort();
    }
}

void check_tokens(std::string_view text, const std::vector<Token>& tokens) {
    std::uint32_t last = 0;
    for (const Token& token : tokens) {
        require(token.span.begin >= last && token.span.begin <= token.span.end &&
                token.span.end <= text.size());
        last = token.span.end;
    }
    require(!tokens.empty() && tokens.back().kind == TokenKind::end_of_file);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    SourceSet sources;
    const FileId file = sources.add("fuzz.scn", std::string(reinterpret_cast<const char*>(bytes), size));
    Diagnostics diagnostics;
    const std::vector<Token> tokens = lex(sources, file, diagnostics);
    check_tokens(sources.file(file).text(), tokens);
    const ast::File tree = parse(sources, file, tokens, diagnostics);
    const std::string dump = '\n' + dump_ast(tree);
    require(diagnostics.has_errors() || dump.find(" error\n") == std::string::npos);
    const std::vector<Diagnostic> sorted = diagnostics.sorted();
    constexpr std::size_t enough = 8; // rendering takes far longer than parsing
    for (std::size_t i = 0; i < std::min(enough, sorted.size()); ++i) {
        require(!render_text(sources, sorted[i], true).empty());
    }
    dump_tokens(sources, tokens);

    Diagnostics ignored;
    parse_expression(sources, file, ignored);
    return 0;
}
