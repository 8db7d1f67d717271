#include "lang/lsp/words.h"

#include "lang/check.h"
#include "lang/wording.h"

#include <fmt/core.h>
#include <fmt/format.h>

namespace scc::lang::lsp {
namespace {

/// Adds a paragraph of one sentence.
void say(std::string& text, std::string sentence) {
    if (!sentence.empty()) {
        const char first = sentence[0];
        sentence[0] = first >= 'a' && first <= 'z' ? static_cast<char>(first - 'a' + 'A') : first;
        text += fmt::format("{}{}.", text.empty() ? "" : "\n\n", sentence);
    }
}

std::string_view keyword(SymbolKind kind) {
    switch (kind) {
    case SymbolKind::let:
        return "let ";
    case SymbolKind::param:
        return "param ";
    case SymbolKind::function:
        return "fn ";
    case SymbolKind::import:
        return "import ";
    case SymbolKind::variable:
    case SymbolKind::misplaced:
        break;
    }
    return "";
}

/// The parameters as they are written: with names and defaults. Empty if they cannot be found.
std::string_view formals_of(const Symbol& function, const Analysis& analysis) {
    const std::string_view text = analysis.text({function.span.file, function.span.end, function.extent.end});
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        if (depth == 0) {
            return text.substr(0, text[i] == ')' ? i + 1 : 0);
        }
    }
    return {};
}

} // namespace

std::string declaration(const Field& field) {
    const std::string text = fmt::format("{}: {}", field.name, to_string(field.type));
    return field.default_value ? fmt::format("{} = {}", text, to_string(*field.default_value)) : text;
}

std::string description(const Field& field) {
    std::string text;
    say(text, std::string(field.doc));
    say(text, rule_of(field));
    say(text, field.choices.empty() ? "" : choice_rule(field));
    say(text, field.required ? "it has to be set" : "");
    say(text,
        field.per_point ? fmt::format("also a function `fn(surface) -> {}`", to_string(field.type)) : "");
    return text;
}

std::string declaration(const Constructor& constructor) {
    std::string text = fmt::format("{} {{", constructor.name);
    const char* joint = " ";
    for (const Field& field : constructor.fields) {
        if (field.supported) {
            text += joint + std::string(field.name);
            joint = ", ";
        }
    }
    return fmt::format("{} }}: {}", text, to_string(constructor.type));
}

std::string description(const Constructor& constructor) {
    std::string text;
    say(text, std::string(constructor.doc));
    say(text, constructor.takes_children ? "it takes shapes as items" : "");
    return text;
}

std::string declaration(const Symbol& symbol, const Analysis& analysis) {
    const std::string name = fmt::format("{}{}", keyword(symbol.kind), symbol.name);
    if (symbol.kind == SymbolKind::function && symbol.type.kind == TypeKind::function) {
        return fmt::format("{}{} -> {}", name, formals_of(symbol, analysis),
                           to_string(symbol.type.args.back()));
    }
    return symbol.type.kind == TypeKind::error ? name : fmt::format("{}: {}", name, to_string(symbol.type));
}

const FunctionDoc* function_named(std::string_view name) {
    for (const FunctionDoc& function : function_docs()) {
        if (function.name == name) {
            return &function;
        }
    }
    return nullptr;
}

std::string declaration(const FunctionDoc& function) {
    return fmt::format("{}", fmt::join(function.signatures, "\n"));
}

std::string description(const FunctionDoc& function) {
    std::string text;
    say(text, std::string(function.doc));
    return function.example.empty() ? text : fmt::format("{}\n\n```scn\n{}\n```", text, function.example);
}

Json markdown(const std::string& code, const std::string& text) {
    return {{"kind", "markdown"}, {"value", fmt::format("```scn\n{}\n```\n{}", code, text)}};
}

} // namespace scc::lang::lsp
