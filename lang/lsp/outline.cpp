#include "lang/lsp/outline.h"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_map>

namespace scc::lang::lsp {
namespace {

/// The protocol's SymbolKind.
enum class Shown { module = 2, function = 12, variable = 13, constant = 14, array = 18, object = 19 };

class Outline {
public:
    Outline(Document& document, const Analysis& analysis) : document_(document), analysis_(analysis) {
        if (document.checked) {
            for (const ObjectPlace& object : document.checked->objects) {
                objects_.emplace(object.begin, &object);
            }
        }
    }

    Json items(const std::vector<ast::Item>& items) const {
        Json shown = Json::array();
        for (const ast::Item& item : items) {
            Json symbol = std::visit([&](const auto& node) { return show(node, item.span); }, item.node);
            if (!symbol.is_null()) {
                shown.push_back(std::move(symbol));
            }
        }
        return shown;
    }

private:
    Json symbol(const std::string& name, const std::string& detail, Shown kind, Span span,
                Span name_span) const {
        return {{"name", name.empty() ? "?" : name}, // the protocol wants no empty ones
                {"detail", detail},
                {"kind", kind},
                {"range", document_.range(join(span, name_span))},
                {"selectionRange", document_.range(name_span)},
                {"children", Json::array()}};
    }
    Json definition(const ast::Name& name, Shown kind, Span span) const {
        const Symbol* symbol_here = analysis_.symbols.at(name.span.begin);
        const bool is_known = symbol_here && symbol_here->type.kind != TypeKind::error;
        return symbol(name.text, is_known ? to_string(symbol_here->type) : "", kind, span, name.span);
    }
    /// Of an item that begins with a word of the language.
    Json block(const std::string& name, Shown kind, Span span, const ast::Body& body) const {
        Json shown = symbol(name, "", kind, span, {span.file, span.begin, span.begin});
        shown["children"] = items(body.items);
        return shown;
    }

    Json show(const ast::Import& node, Span span) const {
        return definition(node.alias, Shown::module, span);
    }
    Json show(const ast::Param& node, Span span) const {
        return definition(node.name, Shown::constant, span);
    }
    Json show(const ast::Let& node, Span span) const { return definition(node.name, Shown::variable, span); }
    Json show(const ast::Function& node, Span span) const {
        return definition(node.name, Shown::function, span);
    }
    Json show(const ast::Field&, Span) const { return nullptr; }
    Json show(const ast::Table&, Span) const { return nullptr; } // parse_file makes none
    Json show(const ast::For& node, Span span) const {
        return block(fmt::format("for {}", node.variable.text), Shown::array, span, node.body);
    }
    Json show(const ast::Block& node, Span span) const {
        return block("else", Shown::array, span, node.body);
    }
    Json show(const ast::If& node, Span span) const {
        Json shown = block("if", Shown::array, span, node.yes);
        if (node.otherwise) {
            shown["children"].push_back(std::visit(
                [&](const auto& other) { return show(other, node.otherwise->span); }, node.otherwise->node));
        }
        return shown;
    }
    Json show(const ast::Child& node, Span span) const {
        const auto* thing = std::get_if<ast::Construct>(&node.value->node);
        if (thing) {
            Json shown = symbol(name_of(*thing, *node.value), thing->constructor.text, Shown::object, span,
                                thing->constructor.span);
            shown["children"] = items(thing->body.items);
            return shown;
        }
        const auto* name = std::get_if<ast::NameRef>(&node.value->node);
        return name ? symbol(name->name, "", Shown::object, span, node.value->span) : Json(nullptr);
    }

    /// The path in the scene; of a thing that no shape came of, its constructor.
    std::string name_of(const ast::Construct& thing, const ast::Expr& expr) const {
        std::string path = path_of(thing, expr);
        return path.empty() ? thing.constructor.text : path;
    }
    std::string path_of(const ast::Construct& thing, const ast::Expr& expr) const {
        if (const auto found = objects_.find(expr.span.begin); found != objects_.end()) {
            const ObjectPlace& object = *found->second;
            return object.count > 1 ? fmt::format("{} (of {})", object.path, object.count) : object.path;
        }
        for (const ast::Item& item : thing.body.items) { // a group's is what its shapes' begin with
            const auto* child = std::get_if<ast::Child>(&item.node);
            const auto* shape = child ? std::get_if<ast::Construct>(&child->value->node) : nullptr;
            const std::string path = shape ? path_of(*shape, *child->value) : "";
            if (const std::size_t slash = path.rfind('/'); slash != std::string::npos) {
                return path.substr(0, slash);
            }
        }
        return "";
    }

    Document& document_;
    const Analysis& analysis_;
    std::unordered_map<std::uint32_t, const ObjectPlace*> objects_;
};

} // namespace

Json outline(Document& document, const Schema& schema) {
    const Analysis& analysis = document.analysis(schema);
    return Outline(document, analysis).items(analysis.tree->items);
}

} // namespace scc::lang::lsp
