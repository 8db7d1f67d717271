#include "lang/cursor.h"

#include "lang/utf8.h"

namespace scc::lang {
namespace {

bool is_closer(TokenKind kind) {
    return kind == TokenKind::right_paren || kind == TokenKind::right_bracket ||
           kind == TokenKind::right_brace;
}

/// After these the next line goes on with the item.
bool leaves_line_open(TokenKind kind) {
    switch (kind) {
    case TokenKind::left_paren:
    case TokenKind::left_bracket:
    case TokenKind::left_brace:
    case TokenKind::assign:
    case TokenKind::arrow:
    case TokenKind::dot_dot:
    case TokenKind::equal:
    case TokenKind::not_equal:
    case TokenKind::less:
    case TokenKind::less_equal:
    case TokenKind::greater:
    case TokenKind::greater_equal:
    case TokenKind::plus:
    case TokenKind::minus:
    case TokenKind::star:
    case TokenKind::slash:
    case TokenKind::percent:
    case TokenKind::caret:
    case TokenKind::kw_then:
    case TokenKind::kw_and:
    case TokenKind::kw_or:
    case TokenKind::kw_not:
    case TokenKind::kw_else:
        return true;
    default:
        return false;
    }
}

/// A line that begins with these goes on with the item of the line before.
bool continues_item(TokenKind kind) {
    return kind == TokenKind::kw_then || kind == TokenKind::kw_and || kind == TokenKind::kw_or ||
           kind == TokenKind::kw_else;
}

bool defines_next(TokenKind kind) {
    return kind == TokenKind::kw_let || kind == TokenKind::kw_fn || kind == TokenKind::kw_param ||
           kind == TokenKind::kw_as;
}

} // namespace

bool Cursor::line_ends_before(std::uint32_t index) const {
    if (!tokens_[index].starts_line || !lines_end_items_ || index == 0 ||
        continues_item(tokens_[index].kind)) {
        return false;
    }
    return !leaves_line_open(tokens_[index - 1].kind) || begins_only_items(index);
}

/// No expression goes on like this: what the line before lacks is not here.
bool Cursor::begins_only_items(std::uint32_t index) const {
    switch (tokens_[index].kind) {
    case TokenKind::kw_import:
    case TokenKind::kw_param:
    case TokenKind::kw_let:
    case TokenKind::kw_for:
        return true;
    case TokenKind::name: // a field, unless it is the result type of a function; a name is never the last
                          // token
        return tokens_[index + 1].kind == TokenKind::assign && tokens_[index - 1].kind != TokenKind::arrow;
    default:
        return false;
    }
}

/// A closing bracket that closes nothing was reported and is as good as unreadable.
TokenKind Cursor::raw_kind(std::uint32_t index) const {
    const TokenKind kind = tokens_[index].kind;
    return is_closer(kind) && partner_[index] == no_partner ? TokenKind::error : kind;
}

bool Cursor::at_separator() const {
    return at(TokenKind::end_of_line) || at(TokenKind::comma) || at(TokenKind::semicolon);
}

Span Cursor::place() const {
    const bool after_previous = at(TokenKind::end_of_line) || token().kind == TokenKind::end_of_file;
    if (!after_previous || pos_ == 0) {
        return token().span;
    }
    const Span last = previous().span;
    return {last.file, last.end, last.end};
}

std::string Cursor::description() const {
    switch (kind_) {
    case TokenKind::error:
    case TokenKind::end_of_file:
    case TokenKind::end_of_line:
    case TokenKind::string:
        return std::string(spelling(kind_));
    default:
        break;
    }
    return fmt::format("`{}`", shortened(text(token().span)));
}

bool Cursor::expect(TokenKind kind) {
    if (accept(kind)) {
        return true;
    }
    fail(fmt::format("`{}`", spelling(kind)));
    return false;
}

bool Cursor::is_consequence() const {
    return panic_ || muted_ || is_unreadable(pos_) || (pos_ > 0 && is_unreadable(pos_ - 1));
}

void Cursor::fail(std::string_view expected) {
    if (!is_consequence()) {
        diagnostics_.report(Diag::unexpected_token, place(), description(), expected);
    }
    panic();
}

void Cursor::report_too_deep() {
    if (!panic_ && !too_deep_reported_) {
        diagnostics_.report(Diag::nesting_too_deep, token().span, max_nesting);
        too_deep_reported_ = true;
    }
    panic();
}

bool Cursor::grow(Span op) {
    if (++height_ <= max_chain) {
        return true;
    }
    complain({}, Diag::chain_too_long, op, max_chain);
    height_ = 0;
    panic();
    return false;
}

void Cursor::skip() {
    const bool is_pair = partner_[pos_] != no_partner && partner_[pos_] > pos_;
    pos_ = is_pair ? partner_[pos_] + 1 : pos_ + 1;
}

void Cursor::recover(std::uint32_t start) {
    panic_ = false;
    const std::uint32_t first = pos_;
    if (pos_ == start && pos_ < limit_) {
        skip();
    }
    while (pos_ < limit_ && !line_ends_before(pos_) && tokens_[pos_].kind != TokenKind::comma &&
           tokens_[pos_].kind != TokenKind::semicolon) {
        skip();
    }
    lost_.push_back({first, pos_, false});
    update();
}

std::unordered_set<std::string> Cursor::lost_names() const {
    std::unordered_set<std::string> names;
    for (const Lost& lost : lost_) {
        for (std::uint32_t i = lost.begin; i < lost.end; ++i) {
            const bool counts = !lost.only_definitions || (i > 0 && defines_next(tokens_[i - 1].kind));
            if (counts && tokens_[i].kind == TokenKind::name) {
                names.emplace(text(tokens_[i].span));
            }
        }
    }
    return names;
}

Group::Group(Cursor& cursor)
    : cursor_(cursor), opener_(cursor.token().span), begin_(cursor.pos_),
      partner_(cursor.partner_[cursor.pos_]), outer_limit_(cursor.limit_),
      outer_lines_end_items_(cursor.lines_end_items_), outer_muted_(cursor.muted_),
      is_brace_(cursor.at(TokenKind::left_brace)) {
    const bool paired = partner_ != no_partner;
    const bool mispaired =
        paired && static_cast<int>(cursor.tokens_[partner_].kind) != static_cast<int>(cursor.kind()) + 1;
    cursor_.lines_end_items_ = is_brace_ || !paired;
    cursor_.limit_ = paired ? partner_ : outer_limit_;
    failed_ = !paired || mispaired;
    cursor_.muted_ = outer_muted_ || (failed_ && !is_brace_);
    cursor_.advance();
}

bool Group::is_paired() const {
    return partner_ != no_partner;
}

Span Group::finish(std::string_view expected) {
    const bool paired = partner_ != no_partner;
    if (paired && !cursor_.panic_ && cursor_.pos_ != partner_) {
        cursor_.fail(expected);
    }
    failed_ = failed_ || cursor_.panic_;
    if (failed_) {
        cursor_.lost_.push_back({begin_, paired ? partner_ : cursor_.pos_, is_brace_});
    }
    cursor_.limit_ = outer_limit_;
    cursor_.lines_end_items_ = outer_lines_end_items_;
    cursor_.muted_ = outer_muted_;
    if (paired) {
        cursor_.panic_ = false;
        cursor_.pos_ = partner_ + 1;
    } else if (!is_brace_) {
        cursor_.panic_ = true; // nobody knows where it ends
    }
    cursor_.update();
    return cursor_.span_from(opener_);
}

} // namespace scc::lang
