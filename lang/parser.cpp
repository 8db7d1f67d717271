#include "lang/parser.h"

#include "lang/parser_rules.h"
#include "lang/utf8.h"

namespace scc::lang {

ast::File Parser::file() {
    ast::File file;
    file.file = file_;
    file.language = language();
    bool has_gaps = false;
    file.items = items(has_gaps);
    file.lost_names = lost_names();
    return file;
}

std::optional<double> Parser::language() {
    constexpr double known_language = 1;
    if (!at(TokenKind::kw_language) || peek() == TokenKind::assign) {
        return {};
    }
    const std::uint32_t start = position();
    advance();
    std::optional<double> version;
    if (at(TokenKind::number)) {
        version = token().number;
        if (version != known_language || token().unit != ast::Unit::none) {
            complain({}, Diag::unknown_language, token().span, shortened(text(token().span)));
        }
        advance();
    } else {
        fail("the number of a language version");
    }
    end_item(start);
    return version;
}

std::vector<ast::Item> Parser::items(bool& has_gaps) {
    std::vector<ast::Item> result;
    skip_line_end();
    while (!at_limit()) {
        const std::uint32_t start = position();
        item(result);
        has_gaps = end_item(start) || has_gaps;
    }
    return result;
}

void Parser::item(std::vector<ast::Item>& items) {
    const Span first = token().span;
    const auto add = [&](auto node) { items.push_back({std::move(node), span_from(first)}); };
    if (begins_field()) {
        return field(items);
    }
    switch (kind()) {
    case TokenKind::kw_import:
        return add(import());
    case TokenKind::kw_param:
        return add(param());
    case TokenKind::kw_let:
        return add(let());
    case TokenKind::kw_for:
        return add(loop());
    case TokenKind::kw_if:
        return cond(items);
    case TokenKind::kw_fn:
        if (peek() != TokenKind::left_paren) {
            return add(func());
        }
        break;
    case TokenKind::kw_else:
        complain({}, Diag::else_without_if, first);
        return panic();
    case TokenKind::kw_language:
        complain({}, Diag::language_not_first, first);
        return panic();
    case TokenKind::error:
        return panic();
    default:
        break;
    }
    child(items);
}

/// Text right behind a bare name makes it unlikely that the name is a value: `radius 3`, `lte a = 3`.
void Parser::child(std::vector<ast::Item>& items) {
    const Span first = token().span;
    ast::ExprPtr value = expr();
    const auto* word = std::get_if<ast::NameRef>(&value->node);
    if (word && !panicking() && !at_limit() && !at_separator()) {
        if (takes_fields_ && begins_operand()) {
            return field_without_sign(items, {word->name, value->span});
        }
        value->node = ast::ErrorExpr{};
    }
    items.push_back({ast::Child{std::move(value)}, span_from(first)});
}

void Parser::field_without_sign(std::vector<ast::Item>& items, ast::Name field_name) {
    const Span gap{file_, field_name.span.end, field_name.span.end};
    complain(Fix{gap, " ="}, Diag::field_assignment, token().span, shortened(text(token().span)),
             shortened(field_name.text));
    ast::ExprPtr value = expr();
    const Span span = span_from(field_name.span);
    items.push_back({ast::Field{std::move(field_name), std::move(value)}, span});
}

ast::Import Parser::import() {
    advance();
    ast::Import result;
    if (at(TokenKind::string)) {
        result.path = string();
    } else {
        result.path = error();
        fail("the path of a scene in quotes");
    }
    expect(TokenKind::kw_as);
    result.alias = name("a name for the scene");
    if (accept(TokenKind::kw_with)) {
        result.with = body(true);
    }
    return result;
}

ast::Param Parser::param() {
    advance();
    ast::Param result;
    result.name = name("the name of a param");
    result.type = type_after_colon();
    result.default_value = expr_after(TokenKind::assign);
    if (accept(TokenKind::kw_in)) {
        result.range = expr();
    }
    if (at(TokenKind::string)) {
        result.text = string_value(text(token().span));
        advance();
    }
    return result;
}

ast::Let Parser::let() {
    const Span first = token().span;
    advance();
    ast::Let result;
    result.name = name("the name of a value");
    if (accept(TokenKind::colon)) {
        result.type = type();
    }
    result.value = expr_after(TokenKind::assign);
    result.span = span_from(first);
    return result;
}

ast::Function Parser::func() {
    advance();
    ast::Function result;
    result.name = name("the name of a function");
    result.has_gaps = !formals(result.formals);
    if (accept(TokenKind::arrow)) {
        result.result = type();
    }
    result.body = function_body();
    return result;
}

/// False if they could not be read.
bool Parser::formals(std::vector<ast::Formal>& formals) {
    if (!at(TokenKind::left_paren)) {
        fail("`(`");
        return false;
    }
    Group parens(*this);
    comma_separated(TokenKind::right_paren, [&] { formals.push_back(formal()); });
    parens.finish("`,` or `)`");
    return !parens.failed();
}

ast::Formal Parser::formal() {
    ast::Formal result;
    result.name = name("the name of a parameter");
    result.type = type_after_colon();
    if (accept(TokenKind::assign)) {
        result.default_value = expr();
    }
    return result;
}

ast::FunctionBody Parser::function_body() {
    if (at_body()) {
        pass_brace_on_new_line();
        return block();
    }
    if (accept(TokenKind::assign)) {
        return {{}, expr()};
    }
    ast::FunctionBody missing{{}, error()};
    fail("`=` or `{`");
    return missing;
}

ast::FunctionBody Parser::block() {
    ast::FunctionBody result;
    Group braces(*this);
    skip_line_end();
    while (at(TokenKind::kw_let)) {
        const std::uint32_t start = position();
        result.lets.push_back(let());
        end_item(start);
    }
    if (at_limit()) {
        complain({}, Diag::missing_result, token().span);
        result.result = error();
    } else {
        result.result = expr();
        if (!accept(TokenKind::comma)) {
            accept(TokenKind::semicolon);
        }
        skip_line_end();
        if (!panicking() && !at_limit()) {
            complain({}, Diag::after_result, token().span, description());
            panic();
        }
    }
    braces.finish("`}`");
    return result;
}

ast::For Parser::loop() {
    advance();
    auto [variable, range] = variable_in_range();
    const Nest nest(*this);
    return {std::move(variable), std::move(range), body(takes_fields_)};
}

/// `if` with bodies, or the expression that begins the same way.
void Parser::cond(std::vector<ast::Item>& items) {
    const Span first = token().span;
    advance();
    ast::ExprPtr condition = parenthesised_condition();
    if (at_body() || panicking()) {
        ast::If node = cond_with_body(std::move(condition));
        items.push_back({std::move(node), span_from(first)});
    } else {
        ast::ExprPtr value = choice(first, std::move(condition));
        items.push_back({ast::Child{std::move(value)}, span_from(first)});
    }
}

ast::If Parser::cond_with_body(ast::ExprPtr condition) {
    ast::If result;
    result.condition = std::move(condition);
    const Nest nest(*this);
    result.yes = body(takes_fields_);
    if (accept(TokenKind::kw_else)) {
        result.otherwise = std::make_unique<ast::Item>(otherwise());
    }
    return result;
}

ast::Item Parser::otherwise() {
    const Span first = token().span;
    if (accept(TokenKind::kw_if)) {
        ast::ExprPtr condition = parenthesised_condition();
        ast::If node = cond_with_body(std::move(condition));
        return {std::move(node), span_from(first)};
    }
    ast::Body rest = body(takes_fields_);
    return {ast::Block{std::move(rest)}, span_from(first)};
}

/// Also what was meant as a field: with `:` or `==`, and outside of any thing, where only `let` binds a name.
void Parser::field(std::vector<ast::Item>& items) {
    const Span first = token().span;
    ast::Name field_name = name("the name of a field");
    const Span op = token().span;
    const bool is_assigned = at(TokenKind::assign);
    if (!takes_fields_) {
        complain(Fix{join(first, op), fmt::format("let {} =", field_name.text)}, Diag::field_outside, first,
                 shortened(field_name.text));
    } else if (!is_assigned) {
        const bool glued = op.begin == first.end;
        complain(Fix{op, glued ? " =" : "="}, Diag::field_assignment, op, text(op),
                 shortened(field_name.text));
    }
    advance();
    ast::ExprPtr value = expr();
    const Span span = span_from(first);
    if (takes_fields_) {
        items.push_back({ast::Field{std::move(field_name), std::move(value)}, span});
    } else {
        items.push_back({ast::Let{std::move(field_name), nullptr, std::move(value), span}, span});
    }
}

ast::Body Parser::body(bool takes_fields) {
    const Span first = token().span;
    pass_brace_on_new_line();
    if (!at(TokenKind::left_brace)) {
        fail("`{`");
        return {{}, first};
    }
    const bool outer = std::exchange(takes_fields_, takes_fields);
    Group braces(*this);
    ast::Body result;
    result.items = items(result.has_gaps);
    result.span = braces.finish("`}`");
    result.is_open = !braces.is_paired();
    takes_fields_ = outer;
    return result;
}

void Parser::pass_brace_on_new_line() {
    if (!at_brace_on_new_line()) {
        return;
    }
    const Span gap{file_, previous().span.end, token().span.begin};
    const bool is_blank = text(gap).find_first_not_of(" \t\r\n") == std::string_view::npos;
    complain(is_blank ? std::optional(Fix{gap, " "}) : std::nullopt, Diag::brace_on_new_line, token().span);
    skip_line_end();
}

/// Passes the separator after an item, or what stands in its place. True if text was skipped.
bool Parser::end_item(std::uint32_t start) {
    if (!panicking() && !at_limit() && !at_separator()) {
        juxtaposed();
    }
    const bool skips = panicking();
    if (skips) {
        recover(start);
    }
    if (!accept(TokenKind::comma)) {
        accept(TokenKind::semicolon);
    }
    skip_line_end();
    return skips;
}

/// Two items on one line. What is surely an item is read as one, other text would only lead to more messages.
void Parser::juxtaposed() {
    if (at(TokenKind::kw_else)) {
        complain({}, Diag::else_without_if, token().span);
        return panic();
    }
    const Span gap{file_, previous().span.end, previous().span.end};
    complain(Fix{gap, ","}, Diag::missing_separator, token().span, description());
    if (!begins_item()) {
        panic();
    }
}

bool Parser::begins_item() const {
    switch (kind()) {
    case TokenKind::kw_import:
    case TokenKind::kw_param:
    case TokenKind::kw_let:
    case TokenKind::kw_fn:
    case TokenKind::kw_for:
    case TokenKind::kw_if:
        return true;
    case TokenKind::name:
        return begins_field() || peek() == TokenKind::left_brace;
    default:
        return false;
    }
}

/// At what can only be the value of something.
bool Parser::begins_operand() const {
    switch (kind()) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::string:
    case TokenKind::hex_color:
    case TokenKind::kw_true:
    case TokenKind::kw_false:
        return !begins_field();
    default:
        return false;
    }
}

bool Parser::begins_field() const {
    const bool is_word = kind() >= TokenKind::kw_language && kind() <= TokenKind::kw_false;
    const TokenKind next = peek();
    return (at(TokenKind::name) &&
            (next == TokenKind::assign || next == TokenKind::colon || next == TokenKind::equal)) ||
           (is_word && takes_fields_ && next == TokenKind::assign);
}

ast::File parse(const SourceSet& sources, FileId file, const std::vector<Token>& tokens,
                Diagnostics& diagnostics) {
    return Parser(sources.file(file), file, tokens, diagnostics).file();
}

std::shared_ptr<const ast::File> parse_file(const SourceSet& sources, FileId file, Diagnostics& diagnostics) {
    const std::vector<Token> tokens = lex(sources, file, diagnostics);
    return std::make_shared<const ast::File>(parse(sources, file, tokens, diagnostics));
}

ast::ExprPtr parse_expression(const SourceSet& sources, FileId file, Diagnostics& diagnostics) {
    const std::vector<Token> tokens = lex(sources, file, diagnostics);
    return Parser(sources.file(file), file, tokens, diagnostics).whole_expression();
}

} // namespace scc::lang
