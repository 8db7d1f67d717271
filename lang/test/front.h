#pragma once

#include "lang/dump.h"
#include "lang/lexer.h"
#include "lang/parser.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang::test {

/// A scene held in memory under the name `a.scn`, with what was reported about it.
struct Front {
    SourceSet sources;
    Diagnostics diagnostics;
    FileId file;

    explicit Front(std::string_view text) : file(sources.add("a.scn", std::string(text))) {}

    std::vector<Token> lex() { return scc::lang::lex(sources, file, diagnostics); }
    std::shared_ptr<const ast::File> parse() { return parse_file(sources, file, diagnostics); }
    std::string messages() const {
        std::string text;
        for (const Diagnostic& diagnostic : diagnostics.sorted()) {
            text += render_text(sources, diagnostic, false);
        }
        return text;
    }
    /// Line and name of every diagnostic: "2 unknown-unit\n".
    std::string summary() const {
        std::string text;
        for (const Diagnostic& diagnostic : diagnostics.sorted()) {
            const Position position = sources.file(file).position(diagnostic.span.begin);
            text += fmt::format("{} {}\n", position.line, row(diagnostic.kind).name);
        }
        return text;
    }
};

} // namespace scc::lang::test
