#include "lang/lsp/navigation.h"

#include "lang/builtins.h"
#include "lang/check.h"
#include "lang/lexer_tables.h"
#include "lang/lsp/context.h"
#include "lang/lsp/words.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace scc::lang::lsp {
namespace {

Json code_hover(Document& document, Span span, const std::string& code, const std::string& text) {
    return {{"contents", markdown(code, text)}, {"range", document.range(span)}};
}

/// The name's value, if it is found quickly and short.
std::string value_of(const Document& document, const Symbol& symbol, const Schema& schema) {
    constexpr std::size_t longest = 120;
    const bool has_value = symbol.kind == SymbolKind::let || symbol.kind == SymbolKind::param;
    if (!has_value || symbol.scope != 0) {
        return "";
    }
    const EvaluationLimits quick{
        .steps = 100'000, .call_depth = 200, .list_length = 1000, .string_length = 1000};
    Analysis own(document.path(), document.text(), schema); // to evaluate needs a tree of its own
    const auto value = evaluate_name(own.tree, symbol.span, schema, own.sources, quick);
    return value && value->size() <= longest ? fmt::format(" = {}", *value) : "";
}

std::string text_of(const Symbol& symbol, const ast::File& file) {
    for (const ast::Item& item : file.items) {
        const auto* param = std::get_if<ast::Param>(&item.node);
        if (param && param->name.span == symbol.span) {
            return param->text.value_or("");
        }
    }
    return "";
}

const Symbol* symbol_at(const Analysis& analysis, std::uint32_t offset) {
    return analysis.symbols.at(offset);
}

/// Every place where the symbol's name stands, in the order of the text.
std::vector<Span> places(const Symbol& symbol, bool with_definition) {
    std::vector<Span> spans;
    for (const Mention& mention : symbol.mentions) {
        spans.push_back(mention.span);
    }
    if (with_definition) {
        spans.push_back(symbol.span);
    }
    std::sort(spans.begin(), spans.end(), [](Span a, Span b) { return a.begin < b.begin; });
    spans.erase(std::unique(spans.begin(), spans.end()), spans.end());
    return spans;
}

[[noreturn]] void refuse(const std::string& why) {
    throw RequestError(ErrorCode::request_failed, why);
}

void check_spelling(const std::string& name, const Schema& schema) {
    const bool is_name =
        !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), continues_name);
    if (!is_name) {
        refuse(fmt::format(
            "`{}` is not a name; a name is made of letters, digits and `_`, and begins with no digit", name));
    }
    if (kind_of_word(name) != TokenKind::name) {
        refuse(fmt::format("`{}` is a reserved word; it cannot be a name", name));
    }
    if (schema.find(name)) {
        refuse(fmt::format("`{}` is a constructor; the new name would hide it", name));
    }
    const auto& functions = function_names();
    if (std::find(functions.begin(), functions.end(), name) != functions.end()) {
        refuse(fmt::format("`{}` is a built-in function; the new name would hide it", name));
    }
    if (name == "pi") {
        refuse("`pi` is a constant; the new name would hide it");
    }
}

/// No mention may come to stand for something else: neither the symbol's for what has the new name, nor the
/// other way round.
void check_collisions(const Analysis& analysis, const Symbol& symbol, const std::string& name) {
    const SymbolIndex& index = analysis.symbols;
    const auto line = [&](const Symbol& other) {
        return analysis.sources.file(analysis.file).position(other.span.begin).line;
    };
    for (const Symbol& other : index.symbols) {
        if (other.name == name && other.scope == symbol.scope) {
            refuse(fmt::format("`{}` is bound in this scope already, in line {}", name, line(other)));
        }
    }
    for (const Mention& mention : symbol.mentions) {
        const Symbol* other = index.find(mention.scope, name);
        if (other && index.is_within(other->scope, symbol.scope)) {
            refuse(fmt::format("where `{}` is used, `{}` is what line {} binds", symbol.name, name,
                               line(*other)));
        }
    }
    for (const Symbol& other : index.symbols) {
        const bool is_outer = other.name == name && index.is_within(symbol.scope, other.scope);
        const bool is_hidden =
            is_outer &&
            std::any_of(other.mentions.begin(), other.mentions.end(),
                        [&](const Mention& mention) { return index.is_within(mention.scope, symbol.scope); });
        if (is_hidden) {
            refuse(fmt::format("the new name would hide the `{}` of line {}, which is used there", name,
                               line(other)));
        }
    }
}

} // namespace

Json hover(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset) {
    const Analysis& analysis = document.analysis(schema);
    const auto token = token_at(analysis, offset);
    if (!token || analysis.tokens[*token].kind != TokenKind::name) {
        return nullptr;
    }
    const Span span = analysis.tokens[*token].span;
    if (const Field* field = field_at(analysis, *token)) {
        return code_hover(document, span, declaration(*field), description(*field));
    }
    if (const Symbol* symbol = symbol_at(analysis, span.begin)) {
        return code_hover(document, span,
                          declaration(*symbol, analysis) + value_of(document, *symbol, schema),
                          text_of(*symbol, *analysis.tree));
    }
    if (const ast::Import* import = import_before_dot(analysis, *token)) {
        const auto imported = analyse_import(*import, document.path(), schema, open);
        const Symbol* symbol = imported ? exported_symbol(*imported, analysis.text(span)) : nullptr;
        return symbol ? code_hover(document, span, declaration(*symbol, *imported),
                                   text_of(*symbol, *imported->tree))
                      : Json(nullptr);
    }
    for (const MemberMention& member : analysis.symbols.members) {
        if (member.span == span && member.object.kind != TypeKind::error) {
            const bool is_scalar = member.object.kind != TypeKind::surface;
            return code_hover(document, span,
                              fmt::format("{}{}", analysis.text(span), is_scalar ? ": number" : ""),
                              fmt::format("Of {}.", described(member.object)));
        }
    }
    const std::string_view word = analysis.text(span);
    if (const Constructor* row = schema.find(word)) {
        return code_hover(document, span, declaration(*row), description(*row));
    }
    if (const FunctionDoc* function = function_named(word)) {
        return code_hover(document, span, declaration(*function), description(*function));
    }
    return nullptr;
}

Json definition(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset) {
    const Analysis& analysis = document.analysis(schema);
    if (const Symbol* symbol = symbol_at(analysis, offset)) {
        return {{"uri", document.uri()}, {"range", document.range(symbol->span)}};
    }
    const auto token = token_at(analysis, offset);
    if (!token) {
        return nullptr;
    }
    const ast::Import* of_path = import_of_path(analysis, *token);
    const ast::Import* import = of_path ? of_path : import_before_dot(analysis, *token);
    const auto imported = import ? analyse_import(*import, document.path(), schema, open) : nullptr;
    if (!imported) {
        return nullptr;
    }
    const Symbol* symbol =
        of_path ? nullptr : exported_symbol(*imported, analysis.text(analysis.tokens[*token].span));
    const Span place = symbol ? symbol->span : Span{};
    const Positions positions(imported->text(), document.encoding());
    return {{"uri", uri_of(imported->sources.file(imported->file).path())},
            {"range", range_in(positions, place.begin, place.end)}};
}

Json references(Document& document, const Schema& schema, std::uint32_t offset, bool with_definition) {
    const Symbol* symbol = symbol_at(document.analysis(schema), offset);
    if (!symbol) {
        return nullptr;
    }
    Json locations = Json::array();
    for (const Span span : places(*symbol, with_definition)) {
        locations.push_back({{"uri", document.uri()}, {"range", document.range(span)}});
    }
    return locations;
}

Json highlights(Document& document, const Schema& schema, std::uint32_t offset) {
    const Symbol* symbol = symbol_at(document.analysis(schema), offset);
    if (!symbol) {
        return nullptr;
    }
    constexpr int read = 2, write = 3; // DocumentHighlightKind
    Json result = Json::array();
    for (const Span span : places(*symbol, true)) {
        result.push_back({{"range", document.range(span)}, {"kind", span == symbol->span ? write : read}});
    }
    return result;
}

Json prepare_rename(Document& document, const Schema& schema, std::uint32_t offset) {
    const Symbol* symbol = symbol_at(document.analysis(schema), offset);
    if (!symbol) {
        return nullptr;
    }
    for (const Span span : places(*symbol, true)) {
        if (span.begin <= offset && offset <= span.end) {
            return {{"range", document.range(span)}, {"placeholder", symbol->name}};
        }
    }
    return nullptr;
}

Json rename(Document& document, const Schema& schema, std::uint32_t offset, const std::string& new_name) {
    const Analysis& analysis = document.analysis(schema);
    const Symbol* symbol = symbol_at(analysis, offset);
    if (!symbol) {
        refuse("only names that the file binds can be renamed");
    }
    if (new_name != symbol->name) {
        check_spelling(new_name, schema);
        check_collisions(analysis, *symbol, new_name);
    }
    for (const std::string& name : {symbol->name, new_name}) {
        if (analysis.tree->lost_names.contains(name)) {
            refuse(fmt::format("`{}` also stands in text that cannot be read; that has to be mended first",
                               name));
        }
    }
    Json edits = Json::array();
    for (const Span span : places(*symbol, true)) {
        edits.push_back({{"range", document.range(span)}, {"newText", new_name}});
    }
    return {{"changes", {{document.uri(), std::move(edits)}}}};
}

} // namespace scc::lang::lsp
