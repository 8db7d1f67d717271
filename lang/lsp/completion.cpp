#include "lang/lsp/completion.h"

#include "lang/builtins.h"
#include "lang/lsp/context.h"
#include "lang/lsp/words.h"
#include "lang/wording.h"

#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <set>

namespace scc::lang::lsp {
namespace {

using Where = Context::Where;

/// The protocol's CompletionItemKind.
enum class ItemKind {
    function = 3,
    constructor = 4,
    field = 5,
    variable = 6,
    module = 9,
    property = 10,
    value = 12,
    keyword = 14,
    constant = 21,
    type = 25,
};

/// How near the top of the list.
enum class Rank { likely, possible, remote };

ItemKind kind_of(SymbolKind kind) {
    switch (kind) {
    case SymbolKind::function:
        return ItemKind::function;
    case SymbolKind::import:
        return ItemKind::module;
    case SymbolKind::param:
        return ItemKind::constant;
    case SymbolKind::let:
    case SymbolKind::variable:
    case SymbolKind::misplaced:
        break;
    }
    return ItemKind::variable;
}

bool is_scene_item(TypeKind kind) {
    return kind == TypeKind::shape || kind == TypeKind::light || kind == TypeKind::camera ||
           kind == TypeKind::setting;
}

class Completion {
public:
    Completion(Document& document, const Analysis& analysis, const Context& context, CompletionStyle style)
        : document_(document), analysis_(analysis), context_(context), style_(style),
          replaced_(document.range(context.word)) {}

    Json list() {
        switch (context_.where) {
        case Where::nothing:
        case Where::member:
            break;
        case Where::string:
            if (context_.field) {
                replaced_ = inside_quotes();
                choices("");
            }
            break;
        case Where::type:
            for (const std::string_view name : type_names()) {
                add(name, ItemKind::type, Rank::likely);
            }
            keywords({"fn"});
            break;
        case Where::item:
            items();
            break;
        case Where::operand:
            operands();
            break;
        case Where::after_operand:
            keywords({"then", "and", "or", "else", "in"});
            break;
        }
        return {{"isIncomplete", false}, {"items", std::move(items_)}};
    }

    Json members(const std::vector<std::string_view>& names, const Type& object) {
        for (const std::string_view name : names) {
            Json& item = add(name, ItemKind::property, Rank::likely);
            item["detail"] = "of " + described(object);
        }
        return {{"isIncomplete", false}, {"items", std::move(items_)}};
    }

    /// Null: the file cannot be read.
    Json imported_names(const Analysis* imported) {
        for (const Symbol* symbol : imported ? exported_symbols(*imported) : std::vector<const Symbol*>()) {
            add_symbol(*symbol, *imported);
        }
        add("scene", ItemKind::module, Rank::remote)["detail"] = "all that the imported file shows";
        return {{"isIncomplete", false}, {"items", std::move(items_)}};
    }

private:
    Json& add(std::string_view label, ItemKind kind, Rank rank) {
        return add(label, kind, rank, std::string(label));
    }
    Json& add(std::string_view label, ItemKind kind, Rank rank, const std::string& text) {
        Json item{{"label", label},
                  {"kind", kind},
                  {"sortText", fmt::format("{}{}", static_cast<int>(rank), label)},
                  {"textEdit", {{"range", replaced_}, {"newText", text}}}};
        items_.push_back(std::move(item));
        return items_.back();
    }
    /// With brackets, between which the cursor is to stand, for clients that can place it.
    Json& add_around(std::string_view label, ItemKind kind, Rank rank, std::string_view opening,
                     std::string_view closing) {
        if (!style_.snippets) {
            return add(label, kind, rank);
        }
        Json& item = add(label, kind, rank, fmt::format("{}{}$0{}", label, opening, closing));
        item["insertTextFormat"] = 2;
        return item;
    }

    /// What is written at the cursor so far, a whole string if it stands in one.
    std::string_view written() const {
        return std::string_view(document_.text())
            .substr(context_.word.begin, context_.word.end - context_.word.begin);
    }
    Json inside_quotes() {
        const bool is_closed = context_.word.end > context_.word.begin + 1 && written().ends_with('"');
        return document_.range(context_.word.begin + 1, context_.word.end - (is_closed ? 1 : 0));
    }

    void choices(std::string_view quote) {
        for (const std::string_view choice : context_.field->choices) {
            const std::string text = fmt::format("{}{}{}", quote, choice, quote);
            add(text, ItemKind::value, Rank::likely);
        }
    }

    void keywords(std::initializer_list<std::string_view> words) {
        for (const std::string_view word : words) {
            add(word, ItemKind::keyword, Rank::remote);
        }
    }

    void items() {
        if (context_.is_function) {
            keywords({"let"});
            return operands();
        }
        if (context_.thing) {
            fields();
        }
        if (context_.is_file) {
            keywords({"import", "param"});
        }
        keywords({"let", "fn", "for", "if"});
        if (context_.is_file || (context_.thing && context_.thing->takes_children)) {
            symbols();
            constructors();
        }
    }

    void fields() {
        for (const Field& field : context_.thing->fields) {
            const bool is_set =
                std::find(context_.set.begin(), context_.set.end(), field.name) != context_.set.end();
            if (!field.supported || is_set) {
                continue;
            }
            Json& item = add(field.name, ItemKind::field, Rank::likely, fmt::format("{} = ", field.name));
            item["detail"] = declaration(field);
            item["documentation"] = {{"kind", "markdown"}, {"value", description(field)}};
        }
    }

    void operands() {
        if (context_.field && !context_.field->choices.empty()) {
            return choices("\"");
        }
        symbols();
        constructors();
        functions();
        Json& pi = add("pi", ItemKind::constant, rank_of(TypeKind::number));
        pi["detail"] = "number";
        for (const std::string_view word : {"true", "false"}) {
            add(word, ItemKind::keyword, rank_of(TypeKind::boolean));
        }
        keywords({"if", "fn", "not"});
    }

    /// Whether a value of this type may stand here; of anything if nothing is known.
    bool is_wanted(const Type& type) const {
        if (!context_.field) {
            return context_.where != Where::item || !context_.is_file || is_scene_item(type.kind);
        }
        const Field& field = *context_.field;
        return fits(field.type, type) ||
               (field.per_point && fits(Type::function({TypeKind::surface}, field.type), type));
    }
    Rank rank_of(const Type& type) const {
        return !context_.field || !is_wanted(type) ? Rank::possible : Rank::likely;
    }

    void symbols() {
        std::set<std::string_view> seen;
        for (std::uint32_t scope = analysis_.symbols.scope_at(context_.word.begin + 1);
             scope != SymbolScope::none; scope = analysis_.symbols.scopes[scope].parent) {
            for (const std::uint32_t index : analysis_.symbols.scopes[scope].symbols) {
                const Symbol& symbol = analysis_.symbols.symbols[index];
                if (is_usable(symbol) && seen.insert(symbol.name).second) {
                    add_symbol(symbol, analysis_);
                }
            }
        }
    }

    /// A `let` cannot stand in its own value.
    bool is_usable(const Symbol& symbol) const {
        const bool is_around =
            symbol.extent.begin < context_.word.begin && context_.word.begin <= symbol.extent.end;
        return symbol.kind != SymbolKind::let || !is_around;
    }

    void add_symbol(const Symbol& symbol, const Analysis& origin) {
        const bool is_function = symbol.kind == SymbolKind::function;
        const bool is_called = is_function && !is_wanted_as_value(symbol);
        Json& item = is_called
                         ? add_around(symbol.name, kind_of(symbol.kind), rank_of_result(symbol), "(", ")")
                         : add(symbol.name, kind_of(symbol.kind), rank_of(symbol.type));
        item["detail"] = declaration(symbol, origin);
    }
    bool is_wanted_as_value(const Symbol& function) const {
        return context_.field && is_wanted(function.type);
    }
    Rank rank_of_result(const Symbol& function) const {
        return function.type.kind == TypeKind::function ? rank_of(function.type.args.back()) : Rank::possible;
    }

    void constructors() {
        const bool in_file = context_.where == Where::item && context_.is_file;
        const bool in_thing = context_.where == Where::item && context_.thing;
        for (const Constructor& row : analysis_.schema.constructors) {
            const bool fits_here = in_file    ? is_scene_item(row.type)
                                   : in_thing ? row.type == TypeKind::shape
                                              : !context_.field || is_wanted(row.type);
            if (row.supported && fits_here) {
                Json& item = add_around(row.name, ItemKind::constructor, rank_of(row.type), " { ", " }");
                item["detail"] = declaration(row);
                item["documentation"] = {{"kind", "markdown"}, {"value", description(row)}};
            }
        }
    }

    void functions() {
        for (const FunctionDoc& function : function_docs()) {
            if (is_statement(function.name)) {
                continue;
            }
            Json& item = add_around(function.name, ItemKind::function, rank_of(function), "(", ")");
            item["detail"] = declaration(function);
            item["documentation"] = {{"kind", "markdown"}, {"value", description(function)}};
        }
    }
    Rank rank_of(const FunctionDoc& function) const {
        const Builtin* builtin = context_.field ? find_builtin(function.name) : nullptr;
        const bool gives_it =
            builtin && std::any_of(builtin->overloads.begin(), builtin->overloads.end(),
                                   [&](const Overload& overload) { return is_wanted(overload.result); });
        return gives_it ? Rank::likely : Rank::possible;
    }

    Document& document_;
    const Analysis& analysis_; ///< of the text with a name where the cursor is
    const Context& context_;
    CompletionStyle style_;
    Json replaced_;
    Json items_ = Json::array();
};

/// The text with a whole name where the cursor is: without one, what stands around it often cannot be parsed.
Analysis with_name(const Document& document, const Schema& schema, Span word) {
    std::string text = document.text();
    text.replace(word.begin, word.end - word.begin, "x");
    return Analysis(document.path(), std::move(text), schema);
}

Type type_before_dot(const Analysis& analysis, Span word) {
    for (const MemberMention& mention : analysis.symbols.members) {
        if (mention.span.begin == word.begin) {
            return mention.object;
        }
    }
    return {};
}

} // namespace

Json completion(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset,
                CompletionStyle style) {
    const Context context = context_at(document.analysis(schema), offset);
    const Analysis analysis = with_name(document, schema, context.word);
    Completion completion(document, analysis, context, style);
    if (context.where == Where::member) {
        const auto token = token_at(analysis, context.word.begin + 1);
        if (const ast::Import* import = token ? import_before_dot(analysis, *token) : nullptr) {
            const auto imported = analyse_import(*import, document.path(), schema, open);
            return completion.imported_names(imported.get());
        }
        const Type object = type_before_dot(analysis, context.word);
        return completion.members(members_of(object.kind), object);
    }
    return completion.list();
}

} // namespace scc::lang::lsp
