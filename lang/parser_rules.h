#pragma once

#include "lang/ast.h"
#include "lang/cursor.h"

#include <string_view>
#include <utility>
#include <vector>

namespace scc::lang {

/// One function per production of grammar.md, each of which stands at its first token when it is called.
class Parser : private Cursor {
public:
    Parser(const SourceFile& source, FileId file, const std::vector<Token>& tokens, Diagnostics& diagnostics)
        : Cursor(source, tokens, diagnostics), file_(file) {}

    ast::File file();
    ast::ExprPtr whole_expression();

private:
    // parser.cpp: items
    std::optional<double> language();
    std::vector<ast::Item> items(bool& has_gaps);
    void item(std::vector<ast::Item>& items);
    ast::Import import();
    ast::Param param();
    ast::Let let();
    ast::Function func();
    bool formals(std::vector<ast::Formal>& formals);
    ast::Formal formal();
    ast::FunctionBody function_body();
    ast::FunctionBody block();
    ast::For loop();
    void cond(std::vector<ast::Item>& items);
    ast::If cond_with_body(ast::ExprPtr condition);
    ast::Item otherwise();
    void field(std::vector<ast::Item>& items);
    void child(std::vector<ast::Item>& items);
    void field_without_sign(std::vector<ast::Item>& items, ast::Name field_name);
    ast::Body body(bool takes_fields);

    bool end_item(std::uint32_t start);
    void juxtaposed();
    bool begins_item() const;
    bool begins_field() const;
    bool begins_operand() const;
    bool at_body() const { return at(TokenKind::left_brace) || at_brace_on_new_line(); }
    void pass_brace_on_new_line();

    // parser_expressions.cpp
    ast::ExprPtr expr();
    ast::ExprPtr binary(int level);
    ast::ExprPtr unary();
    ast::ExprPtr power();
    ast::ExprPtr exponent();
    ast::ExprPtr postfix();
    ast::ExprPtr member(ast::ExprPtr object);
    ast::ExprPtr call(ast::ExprPtr callee);
    ast::Argument actual();
    ast::ExprPtr index(ast::ExprPtr object);
    ast::ExprPtr primary();
    ast::ExprPtr number();
    ast::ExprPtr string();
    ast::ExprPtr name_or_construct();
    ast::ExprPtr parenthesised();
    ast::ExprPtr list();
    ast::ExprPtr comprehension(Span opener, Group& brackets);
    ast::ExprPtr if_expression();
    ast::ExprPtr choice(Span first, ast::ExprPtr condition);
    ast::ExprPtr lambda();
    ast::TypeExprPtr type();
    ast::TypeExprPtr list_type();
    ast::TypeExprPtr function_type();

    ast::Name name(std::string_view what);
    std::pair<ast::Name, ast::ExprPtr> variable_in_range();
    ast::ExprPtr parenthesised_condition();
    ast::ExprPtr expr_after(TokenKind kind);
    ast::TypeExprPtr type_after_colon();
    void complain_of_missing(TokenKind kind, std::string_view addition);
    ast::ExprPtr error() const { return error(place()); }
    ast::ExprPtr error(Span span) const { return make(ast::ErrorExpr{}, span); }

    template <class Node>
    ast::ExprPtr make(Node node, Span span) const {
        return std::make_unique<ast::Expr>(ast::Expr{std::move(node), span});
    }
    template <class Element>
    void comma_separated(TokenKind closer, Element element) {
        if (at(closer)) {
            return;
        }
        do {
            element();
        } while (accept(TokenKind::comma));
    }

    FileId file_;
    bool takes_fields_ = false; ///< the surrounding body is a thing's
};

} // namespace scc::lang
