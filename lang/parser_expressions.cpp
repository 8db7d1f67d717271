#include "lang/lexer_tables.h"
#include "lang/parser_rules.h"

namespace scc::lang {
namespace {

using ast::BinaryOp;

struct Operator {
    int level; ///< binds tighter the higher; negative: not an operator
    BinaryOp op;
};

constexpr int comparison_level = 3;
constexpr int range_level = 4;

constexpr Operator operator_of(TokenKind kind) {
    switch (kind) {
    case TokenKind::kw_then:
        return {0, BinaryOp::then};
    case TokenKind::kw_or:
        return {1, BinaryOp::logical_or};
    case TokenKind::kw_and:
        return {2, BinaryOp::logical_and};
    case TokenKind::equal:
        return {comparison_level, BinaryOp::eq};
    case TokenKind::not_equal:
        return {comparison_level, BinaryOp::ne};
    case TokenKind::less:
        return {comparison_level, BinaryOp::lt};
    case TokenKind::less_equal:
        return {comparison_level, BinaryOp::le};
    case TokenKind::greater:
        return {comparison_level, BinaryOp::gt};
    case TokenKind::greater_equal:
        return {comparison_level, BinaryOp::ge};
    case TokenKind::dot_dot:
        return {range_level, BinaryOp::range};
    case TokenKind::plus:
        return {5, BinaryOp::add};
    case TokenKind::minus:
        return {5, BinaryOp::sub};
    case TokenKind::star:
        return {6, BinaryOp::mul};
    case TokenKind::slash:
        return {6, BinaryOp::div};
    case TokenKind::percent:
        return {6, BinaryOp::mod};
    default:
        return {-1, BinaryOp::then};
    }
}

} // namespace

ast::ExprPtr Parser::whole_expression() {
    ast::ExprPtr result = expr();
    skip_line_end();
    if (!panicking() && !at_limit()) {
        fail("the end of the expression");
    }
    return result;
}

ast::ExprPtr Parser::expr() {
    const Nest nest(*this);
    return nest ? binary(0) : error();
}

ast::ExprPtr Parser::binary(int level) {
    const Height height(*this);
    ast::ExprPtr left = unary();
    int last_level = -1;
    for (;;) {
        const Operator op = operator_of(kind());
        if (op.level < level) {
            return left;
        }
        const Span op_span = token().span;
        if (op.level == last_level && (op.level == comparison_level || op.level == range_level)) {
            const Span last_op = std::get<ast::Binary>(left->node).op_span;
            complain({}, Diag::chained_operator, op_span, text(op_span), text(last_op));
            panic();
            return left;
        }
        last_level = op.level;
        advance();
        ast::ExprPtr right = binary(op.level + 1);
        const Span span = join(left->span, right->span);
        left = make(ast::Binary{op.op, std::move(left), std::move(right), op_span}, span);
        if (!grow(op_span)) {
            return error(op_span);
        }
    }
}

ast::ExprPtr Parser::unary() {
    if (!at(TokenKind::minus) && !at(TokenKind::kw_not)) {
        return power();
    }
    const Nest nest(*this);
    if (!nest) {
        return error();
    }
    const Span first = token().span;
    const ast::UnaryOp op = at(TokenKind::minus) ? ast::UnaryOp::minus : ast::UnaryOp::logical_not;
    advance();
    ast::ExprPtr operand = unary();
    const Span span = join(first, operand->span);
    return make(ast::Unary{op, std::move(operand)}, span);
}

ast::ExprPtr Parser::power() {
    ast::ExprPtr base = postfix();
    if (!at(TokenKind::caret)) {
        return base;
    }
    const Span op_span = token().span;
    ast::ExprPtr raised_to = exponent();
    if (!grow(op_span)) {
        return error(op_span);
    }
    const Span span = join(base->span, raised_to->span);
    return make(ast::Binary{BinaryOp::pow, std::move(base), std::move(raised_to), op_span}, span);
}

ast::ExprPtr Parser::exponent() {
    const Nest nest(*this);
    if (!nest) {
        return error();
    }
    advance();
    return unary();
}

ast::ExprPtr Parser::postfix() {
    ast::ExprPtr result = primary();
    for (;;) {
        const Span op_span = token().span;
        if (at(TokenKind::dot)) {
            result = member(std::move(result));
        } else if (at(TokenKind::left_paren)) {
            result = call(std::move(result));
        } else if (at(TokenKind::left_bracket)) {
            result = index(std::move(result));
        } else {
            return result;
        }
        if (!grow(op_span)) {
            return error(op_span);
        }
    }
}

ast::ExprPtr Parser::member(ast::ExprPtr object) {
    advance();
    ast::Name member_name = name("the name of a member");
    const Span span = span_from(object->span);
    return panicking() ? error(span) : make(ast::Member{std::move(object), std::move(member_name)}, span);
}

ast::ExprPtr Parser::call(ast::ExprPtr callee) {
    Group parens(*this);
    std::vector<ast::Argument> arguments;
    comma_separated(TokenKind::right_paren, [&] { arguments.push_back(actual()); });
    const Span span = join(callee->span, parens.finish("`,` or `)`"));
    return parens.failed() ? error(span) : make(ast::Call{std::move(callee), std::move(arguments)}, span);
}

ast::Argument Parser::actual() {
    const bool is_named = peek() == TokenKind::assign && !at(TokenKind::end_of_line);
    if (!is_named) {
        return {{}, expr()};
    }
    ast::Name argument = name("the name of an argument");
    return {std::move(argument), expr_after(TokenKind::assign)};
}

ast::ExprPtr Parser::index(ast::ExprPtr object) {
    Group brackets(*this);
    ast::ExprPtr where = expr();
    const Span span = join(object->span, brackets.finish("`]`"));
    return brackets.failed() ? error(span) : make(ast::Index{std::move(object), std::move(where)}, span);
}

ast::ExprPtr Parser::primary() {
    const Span span = token().span;
    switch (kind()) {
    case TokenKind::number:
        return number();
    case TokenKind::string:
        return string();
    case TokenKind::hex_color: {
        const auto rgb = static_cast<std::uint32_t>(token().number);
        advance();
        return make(ast::HexColor{rgb}, span);
    }
    case TokenKind::kw_true:
    case TokenKind::kw_false: {
        const bool value = at(TokenKind::kw_true);
        advance();
        return make(ast::Bool{value}, span);
    }
    case TokenKind::name:
        return name_or_construct();
    case TokenKind::left_paren:
        return parenthesised();
    case TokenKind::left_bracket:
        return list();
    case TokenKind::kw_if:
        return if_expression();
    case TokenKind::kw_fn:
        return lambda();
    case TokenKind::error:
        advance();
        return error(span);
    default:
        break;
    }
    ast::ExprPtr nothing = error();
    fail("an expression");
    return nothing;
}

ast::ExprPtr Parser::number() {
    const Span first = token().span;
    const double value = token().number;
    ast::Unit unit = token().unit;
    advance();
    if (at(TokenKind::name) && unit == ast::Unit::none) {
        if (const std::optional<ast::Unit> apart = unit_named(text(token().span))) {
            const Span both = join(first, token().span);
            complain(Fix{both, fmt::format("{}{}", text(first), text(token().span))}, Diag::unit_apart, both);
            unit = *apart;
            advance();
        }
    }
    return make(ast::Number{value, unit}, span_from(first));
}

ast::ExprPtr Parser::string() {
    const Span span = token().span;
    advance();
    return make(ast::String{string_value(text(span))}, span);
}

ast::ExprPtr Parser::name_or_construct() {
    const Span span = token().span;
    advance();
    std::string word(text(span));
    if (!at_body()) {
        return make(ast::NameRef{std::move(word)}, span);
    }
    ast::Body inside = body(true);
    const Span whole = join(span, inside.span);
    return make(ast::Construct{{std::move(word), span}, std::move(inside)}, whole);
}

/// A vector, or an expression that keeps no trace of its parentheses but the span.
ast::ExprPtr Parser::parenthesised() {
    Group parens(*this);
    std::vector<ast::ExprPtr> elements;
    do {
        elements.push_back(expr());
    } while (accept(TokenKind::comma));
    const Span span = parens.finish("`,` or `)`");
    if (parens.failed()) {
        return error(span);
    }
    if (elements.size() == 1) {
        elements[0]->span = span;
        return std::move(elements[0]);
    }
    if (elements.size() > 3) {
        complain({}, Diag::vector_size, span, elements.size());
        return error(span);
    }
    return make(ast::Tuple{std::move(elements)}, span);
}

ast::ExprPtr Parser::list() {
    const Span opener = token().span;
    Group brackets(*this);
    if (at(TokenKind::kw_for)) {
        return comprehension(opener, brackets);
    }
    std::vector<ast::ExprPtr> elements;
    comma_separated(TokenKind::right_bracket, [&] { elements.push_back(expr()); });
    const Span span = brackets.finish("`,` or `]`");
    return brackets.failed() ? error(span) : make(ast::List{std::move(elements)}, span);
}

ast::ExprPtr Parser::comprehension(Span opener, Group& brackets) {
    advance();
    auto [variable, range] = variable_in_range();
    ast::ExprPtr element = expr();
    const Span span = join(opener, brackets.finish("`]`"));
    if (brackets.failed()) {
        return error(span);
    }
    return make(ast::Comprehension{std::move(variable), std::move(range), std::move(element)}, span);
}

ast::ExprPtr Parser::if_expression() {
    const Span first = token().span;
    advance();
    ast::ExprPtr condition = parenthesised_condition();
    return choice(first, std::move(condition));
}

ast::ExprPtr Parser::choice(Span first, ast::ExprPtr condition) {
    ast::ExprPtr yes = expr();
    ast::ExprPtr no = expr_after(TokenKind::kw_else);
    const Span span = join(first, no->span);
    return make(ast::Conditional{std::move(condition), std::move(yes), std::move(no)}, span);
}

ast::ExprPtr Parser::lambda() {
    const Span first = token().span;
    advance();
    std::vector<ast::Formal> parameters;
    const bool is_complete = formals(parameters);
    ast::ExprPtr result = expr_after(TokenKind::assign);
    const Span span = join(first, result->span);
    return !is_complete ? error(span) : make(ast::Lambda{std::move(parameters), std::move(result)}, span);
}

ast::TypeExprPtr Parser::type() {
    const Nest nest(*this);
    if (at(TokenKind::left_bracket)) {
        return list_type();
    }
    if (at(TokenKind::kw_fn)) {
        return function_type();
    }
    ast::Name type_name = name("a type");
    const Span span = type_name.span;
    return std::make_unique<ast::TypeExpr>(ast::TypeExpr{ast::NamedType{std::move(type_name)}, span});
}

ast::TypeExprPtr Parser::list_type() {
    Group brackets(*this);
    ast::TypeExprPtr element = type();
    const Span span = brackets.finish("`]`");
    return std::make_unique<ast::TypeExpr>(ast::TypeExpr{ast::ListType{std::move(element)}, span});
}

ast::TypeExprPtr Parser::function_type() {
    const Span first = token().span;
    advance();
    std::vector<ast::TypeExprPtr> parameters;
    if (at(TokenKind::left_paren)) {
        Group parens(*this);
        do {
            parameters.push_back(type());
        } while (accept(TokenKind::comma));
        parens.finish("`,` or `)`");
    } else {
        fail("`(`");
    }
    expect(TokenKind::arrow);
    ast::TypeExprPtr result = type();
    return std::make_unique<ast::TypeExpr>(
        ast::TypeExpr{ast::FunctionType{std::move(parameters), std::move(result)}, span_from(first)});
}

/// A missing `=` before what can only be a value is added.
ast::ExprPtr Parser::expr_after(TokenKind kind) {
    if (kind == TokenKind::assign && begins_operand()) {
        complain_of_missing(kind, " =");
        return expr();
    }
    return expect(kind) ? expr() : error();
}

ast::TypeExprPtr Parser::type_after_colon() {
    if (at(TokenKind::name)) {
        complain_of_missing(TokenKind::colon, ":");
    } else {
        expect(TokenKind::colon);
    }
    return type();
}

void Parser::complain_of_missing(TokenKind kind, std::string_view addition) {
    const Span gap{file_, previous().span.end, previous().span.end};
    complain(Fix{gap, std::string(addition)}, Diag::unexpected_token, token().span, description(),
             fmt::format("`{}`", spelling(kind)));
}

/// A reserved word is reported and taken for the name; otherwise what is missing leaves an empty one.
ast::Name Parser::name(std::string_view what) {
    const Span span = token().span;
    const bool is_word = kind() >= TokenKind::kw_language && kind() <= TokenKind::kw_false;
    if (!at(TokenKind::name) && !is_word) {
        const Span missing = place();
        fail(what);
        return {{}, missing};
    }
    if (is_word) {
        complain({}, Diag::reserved_word, span, text(span));
    }
    advance();
    return {std::string(text(span)), span};
}

/// `(i in range)`
std::pair<ast::Name, ast::ExprPtr> Parser::variable_in_range() {
    if (!at(TokenKind::left_paren)) {
        fail("`(`");
        return {ast::Name{{}, place()}, error()};
    }
    Group parens(*this);
    ast::Name variable = name("the name of a variable");
    ast::ExprPtr range = expr_after(TokenKind::kw_in);
    const Span span = parens.finish("`)`");
    return {std::move(variable), parens.failed() ? error(span) : std::move(range)};
}

ast::ExprPtr Parser::parenthesised_condition() {
    if (!at(TokenKind::left_paren)) {
        fail("`(`");
        return error();
    }
    Group parens(*this);
    ast::ExprPtr condition = expr();
    const Span span = parens.finish("`)`");
    return parens.failed() ? error(span) : std::move(condition);
}

} // namespace scc::lang
