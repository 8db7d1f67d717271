#include "lang/format_structure.h"

#include "lang/brackets.h"

#include <algorithm>

namespace scc::lang {
namespace {

class Collector {
public:
    Collector(const std::vector<Token>& tokens, FormatStructure& structure)
        : tokens_(tokens), structure_(structure) {}

    void file(const ast::File& file) {
        if (file.language) {
            structure_.items.push_back({0, 1});
        }
        items(file.items, structure_.items);
    }

    void operator()(const ast::ErrorExpr&) {}
    void operator()(const ast::Number&) {}
    void operator()(const ast::String&) {}
    void operator()(const ast::HexColor&) {}
    void operator()(const ast::Bool&) {}
    void operator()(const ast::NameRef&) {}
    void operator()(const ast::Construct& node) { body(node.body); }
    void operator()(const ast::Tuple& node) { all(node.elements); }
    void operator()(const ast::List& node) { all(node.elements); }
    void operator()(const ast::Comprehension& node) {
        expr(node.range);
        expr(node.element);
    }
    void operator()(const ast::Conditional& node) {
        expr(node.condition);
        expr(node.yes);
        expr(node.no);
    }
    void operator()(const ast::Lambda& node) {
        formals(node.formals);
        expr(node.body);
    }
    void operator()(const ast::Unary& node) { expr(node.operand); }
    void operator()(const ast::Binary& node) {
        expr(node.left);
        structure_.infix.insert(at(node.op_span.begin));
        expr(node.right);
    }
    void operator()(const ast::Member& node) { expr(node.object); }
    void operator()(const ast::Call& node) {
        expr(node.callee);
        structure_.postfix.insert(at(node.callee->span.end));
        for (const ast::Argument& argument : node.arguments) {
            expr(argument.value);
        }
    }
    void operator()(const ast::Index& node) {
        expr(node.object);
        structure_.postfix.insert(at(node.object->span.end));
        expr(node.index);
    }

    void operator()(const ast::Import& node) {
        if (node.with) {
            body(*node.with);
        }
    }
    void operator()(const ast::Param& node) {
        expr(node.default_value);
        expr(node.range);
    }
    void operator()(const ast::Let& node) { expr(node.value); }
    void operator()(const ast::Function& node) {
        formals(node.formals);
        for (const ast::Let& let : node.body.lets) {
            expr(let.value);
        }
        expr(node.body.result);
        block(node.body);
    }
    void operator()(const ast::For& node) {
        expr(node.range);
        body(node.body);
    }
    void operator()(const ast::If& node) {
        expr(node.condition);
        body(node.yes);
        if (node.otherwise) {
            std::visit(*this, node.otherwise->node);
        }
    }
    void operator()(const ast::Block& node) { body(node.body); }
    void operator()(const ast::Field& node) { expr(node.value); }
    void operator()(const ast::Child& node) { expr(node.value); }
    void operator()(const ast::Table&) {} // only read_file makes these

private:
    /// The first token that begins there or later.
    std::uint32_t at(std::uint32_t offset) const {
        const auto found = std::lower_bound(
            tokens_.begin(), tokens_.end(), offset,
            [](const Token& token, std::uint32_t begin) { return token.span.begin < begin; });
        return static_cast<std::uint32_t>(found - tokens_.begin());
    }
    TokenRange range(Span span) const { return {at(span.begin), at(span.end) - 1}; }

    void expr(const ast::ExprPtr& expression) {
        if (expression) {
            std::visit(*this, expression->node);
        }
    }
    void all(const std::vector<ast::ExprPtr>& elements) {
        for (const ast::ExprPtr& element : elements) {
            expr(element);
        }
    }
    void formals(const std::vector<ast::Formal>& formals) {
        for (const ast::Formal& formal : formals) {
            expr(formal.default_value);
        }
    }
    void items(const std::vector<ast::Item>& items, std::vector<TokenRange>& ranges) {
        for (const ast::Item& item : items) {
            ranges.push_back(range(item.span));
            std::visit(*this, item.node);
        }
    }
    void body(const ast::Body& node) {
        std::vector<TokenRange> ranges;
        items(node.items, ranges);
        structure_.bodies.emplace(at(node.span.begin), std::move(ranges));
    }
    /// In braces, or after a `=`, where it is no body.
    void block(const ast::FunctionBody& node) {
        const Span first = node.lets.empty() ? node.result->span : node.lets.front().span;
        const std::uint32_t before = at(first.begin) - 1;
        if (tokens_[before].kind != TokenKind::left_brace) {
            return;
        }
        std::vector<TokenRange> ranges;
        for (const ast::Let& let : node.lets) {
            ranges.push_back(range(let.span));
        }
        ranges.push_back(range(node.result->span));
        structure_.bodies.emplace(before, std::move(ranges));
    }

    const std::vector<Token>& tokens_;
    FormatStructure& structure_;
};

} // namespace

FormatStructure structure_of(const std::vector<Token>& tokens, const ast::File& file) {
    FormatStructure structure;
    Diagnostics none; // the parser paired them without a complaint
    structure.partner = pair_brackets(tokens, none);
    Collector(tokens, structure).file(file);
    return structure;
}

} // namespace scc::lang
