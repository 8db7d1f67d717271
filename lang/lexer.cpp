#include "lang/lexer.h"

#include "lang/lexer_tables.h"
#include "lang/utf8.h"

#include <charconv>
#include <optional>
#include <utility>

namespace scc::lang {
namespace {

class Lexer {
public:
    Lexer(const SourceFile& source, FileId file, const std::vector<Span>& left_out, Diagnostics& diagnostics)
        : text_(source.text()), file_(file), left_out_(left_out), diagnostics_(diagnostics) {}
    Lexer(const SourceFile& source, Span span, const std::vector<Span>& left_out, Diagnostics& diagnostics)
        : text_(source.text().substr(0, span.end)), file_(span.file), left_out_(left_out),
          diagnostics_(diagnostics), pos_(span.begin) {}

    std::vector<Token> run();

private:
    // A std::string ends in a zero byte, so looking one character past the last is in bounds.
    char peek(std::size_t ahead = 0) const { return text_.data()[pos_ + ahead]; }
    bool at_end() const { return pos_ >= text_.size(); }
    Span span(std::size_t begin, std::size_t end) const {
        return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    }
    std::string_view slice(std::size_t begin, std::size_t end) const {
        return text_.substr(begin, end - begin);
    }

    void push(TokenKind kind, std::size_t begin, double number = 0, ast::Unit unit = ast::Unit::none) {
        tokens_.push_back({number, span(begin, pos_), kind, unit, line_start_});
        line_start_ = false;
    }
    void punctuation(TokenKind kind, std::size_t length = 1) {
        pos_ += length;
        push(kind, pos_ - length);
    }
    void either(char second, TokenKind both, TokenKind alone) {
        peek(1) == second ? punctuation(both, 2) : punctuation(alone);
    }

    void check_encoding();
    void skip_left_out();
    void token();
    void word();
    void line_comment();
    void block_comment();
    void number();
    void scan_digits();
    void finish_number(std::size_t begin);
    void unit(std::size_t begin, std::size_t unit_begin, double value);
    void dot();
    void hex_color();
    void string();
    void escape();
    void unterminated_string(std::size_t begin, std::size_t line_end);
    void foreign_operator(TokenKind meant, std::size_t length);
    bool wrong_quotes(const Character& open);
    void unreadable();
    Diagnostic* unexpected(std::size_t begin, const Character& c);

    std::string_view text_;
    FileId file_;
    const std::vector<Span>& left_out_;
    Diagnostics& diagnostics_;
    std::vector<Token> tokens_;
    std::size_t pos_ = 0;
    std::size_t next_left_out_ = 0;
    bool line_start_ = true;
    bool is_utf8_ = true;
};

std::vector<Token> Lexer::run() {
    constexpr std::size_t usual_bytes_per_token = 4;
    std::size_t bytes = text_.size() - pos_;
    for (const Span& span : left_out_) {
        bytes -= span.end - span.begin;
    }
    tokens_.reserve(bytes / usual_bytes_per_token + 1);
    check_encoding();
    if (pos_ == 0 && text_.starts_with("\xEF\xBB\xBF")) {
        pos_ = 3;
    }
    while (!at_end()) {
        token();
    }
    push(TokenKind::end_of_file, pos_);
    return std::move(tokens_);
}

/// Lines within a comment are passed over by the comment.
void Lexer::skip_left_out() {
    while (next_left_out_ < left_out_.size() && left_out_[next_left_out_].begin < pos_) {
        ++next_left_out_;
    }
    if (next_left_out_ < left_out_.size() && left_out_[next_left_out_].begin == pos_) {
        pos_ = left_out_[next_left_out_].end;
    }
}

void Lexer::check_encoding() {
    std::size_t malformed = find_malformed(text_.substr(pos_));
    if (malformed != std::string_view::npos) {
        malformed += pos_;
        is_utf8_ = false;
        const unsigned byte = static_cast<unsigned char>(text_[malformed]);
        diagnostics_.report(Diag::bad_utf8, span(malformed, malformed + 1), byte);
    }
}

void Lexer::token() {
    const char c = peek();
    switch (c) {
    case ' ':
    case '\t':
    case '\r':
        ++pos_;
        return;
    case '\n':
        ++pos_;
        line_start_ = true;
        skip_left_out();
        return;
    case '/':
        if (peek(1) == '/') {
            return line_comment();
        }
        return peek(1) == '*' ? block_comment() : punctuation(TokenKind::slash);
    case '"':
        return string();
    case '#':
        return hex_color();
    case '(':
        return punctuation(TokenKind::left_paren);
    case ')':
        return punctuation(TokenKind::right_paren);
    case '[':
        return punctuation(TokenKind::left_bracket);
    case ']':
        return punctuation(TokenKind::right_bracket);
    case '{':
        return punctuation(TokenKind::left_brace);
    case '}':
        return punctuation(TokenKind::right_brace);
    case ',':
        return punctuation(TokenKind::comma);
    case ';':
        return punctuation(TokenKind::semicolon);
    case ':':
        return punctuation(TokenKind::colon);
    case '.':
        return dot();
    case '+':
        return punctuation(TokenKind::plus);
    case '-':
        return either('>', TokenKind::arrow, TokenKind::minus);
    case '*':
        return punctuation(TokenKind::star);
    case '%':
        return punctuation(TokenKind::percent);
    case '^':
        return punctuation(TokenKind::caret);
    case '=':
        return either('=', TokenKind::equal, TokenKind::assign);
    case '<':
        return either('=', TokenKind::less_equal, TokenKind::less);
    case '>':
        return either('=', TokenKind::greater_equal, TokenKind::greater);
    case '!':
        return peek(1) == '=' ? punctuation(TokenKind::not_equal, 2) : foreign_operator(TokenKind::kw_not, 1);
    case '&':
        return peek(1) == '&' ? foreign_operator(TokenKind::kw_and, 2) : unreadable();
    case '|':
        return peek(1) == '|' ? foreign_operator(TokenKind::kw_or, 2) : unreadable();
    default:
        break;
    }
    if (is_digit(c)) {
        return number();
    }
    return is_letter(c) ? word() : unreadable();
}

void Lexer::word() {
    const std::size_t begin = pos_;
    while (continues_name(peek())) {
        ++pos_;
    }
    if (!is_ascii(peek())) {
        pos_ = begin;
        return unreadable();
    }
    push(kind_of_word(slice(begin, pos_)), begin);
}

void Lexer::line_comment() {
    const std::size_t end = text_.find('\n', pos_);
    pos_ = end == std::string_view::npos ? text_.size() : end;
}

void Lexer::block_comment() {
    const std::size_t begin = pos_;
    const std::size_t end = text_.find("*/", begin + 2);
    if (end == std::string_view::npos) {
        diagnostics_.report(Diag::unterminated_comment, span(begin, begin + 2));
        pos_ = text_.size();
    } else {
        pos_ = end + 2;
    }
    line_start_ = line_start_ || slice(begin, pos_).find('\n') != std::string_view::npos;
}

void Lexer::scan_digits() {
    while (is_digit(peek())) {
        ++pos_;
    }
}

void Lexer::number() {
    const std::size_t begin = pos_;
    scan_digits();
    if (peek() == '.' && is_digit(peek(1))) {
        ++pos_;
        scan_digits();
    }
    if (peek() == 'e' || peek() == 'E') {
        const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
        if (is_digit(peek(1 + sign))) {
            pos_ += 1 + sign;
            scan_digits();
        }
    }
    finish_number(begin);
}

void Lexer::finish_number(std::size_t begin) {
    if (peek() == '.' && is_digit(peek(1))) {
        while (is_digit(peek()) || (peek() == '.' && is_digit(peek(1)))) {
            ++pos_;
        }
        diagnostics_.report(Diag::bad_number, span(begin, pos_), shortened(slice(begin, pos_)));
        return push(TokenKind::error, begin);
    }
    double value = 0;
    const std::from_chars_result result = std::from_chars(text_.data() + begin, text_.data() + pos_, value);
    if (result.ec == std::errc::result_out_of_range) {
        diagnostics_.report(Diag::number_out_of_range, span(begin, pos_), shortened(slice(begin, pos_)));
        return push(TokenKind::error, begin);
    }
    const bool has_unit = continues_name(peek()) || !is_ascii(peek());
    return has_unit ? unit(begin, pos_, value) : push(TokenKind::number, begin, value);
}

void Lexer::unit(std::size_t begin, std::size_t unit_begin, double value) {
    while (continues_name(peek()) || !is_ascii(peek())) {
        ++pos_;
    }
    const std::string_view text = slice(unit_begin, pos_);
    if (const std::optional<ast::Unit> known = unit_named(text)) {
        return push(TokenKind::number, begin, value, *known);
    }
    if (is_utf8_) {
        const std::optional<std::string_view> meant = likely_unit(text);
        Diagnostic& diagnostic =
            diagnostics_.report(Diag::unknown_unit, span(unit_begin, pos_), shortened(text),
                                meant ? fmt::format("; did you mean `{}`?", *meant) : "");
        if (meant) {
            diagnostic.suggest(span(unit_begin, pos_), std::string(*meant));
        }
    }
    push(TokenKind::error, begin);
}

void Lexer::dot() {
    if (!is_digit(peek(1))) {
        return either('.', TokenKind::dot_dot, TokenKind::dot);
    }
    const std::size_t begin = pos_;
    while (continues_name(peek()) || (peek() == '.' && is_digit(peek(1)))) {
        ++pos_;
    }
    diagnostics_.report(Diag::bad_number, span(begin, pos_), shortened(slice(begin, pos_)))
        .suggest(span(begin, begin), "0");
    push(TokenKind::error, begin);
}

void Lexer::hex_color() {
    const std::size_t begin = pos_++;
    bool all_hex = true;
    for (; continues_name(peek()); ++pos_) {
        all_hex = all_hex && is_hex_digit(peek());
    }
    const std::string_view digits = slice(begin + 1, pos_);
    std::uint32_t rgb = 0;
    if (all_hex && digits.size() == 6) {
        std::from_chars(digits.data(), digits.data() + digits.size(), rgb, 16);
        return push(TokenKind::hex_color, begin, rgb);
    }
    Diagnostic& diagnostic =
        diagnostics_.report(Diag::bad_hex_color, span(begin, pos_), shortened(slice(begin, pos_)));
    if (all_hex && digits.size() == 3) {
        const char r = digits[0], g = digits[1], b = digits[2];
        diagnostic.suggest(span(begin, pos_), std::string{'#', r, r, g, g, b, b});
    } else if (all_hex && digits.size() == 8) {
        diagnostic.suggest(span(begin, pos_), std::string(slice(begin, begin + 7)));
    }
    push(TokenKind::error, begin);
}

void Lexer::string() {
    const std::size_t begin = pos_++;
    for (;;) {
        const char c = peek();
        if (c == '"') {
            ++pos_;
            return push(TokenKind::string, begin);
        }
        if (at_end() || c == '\n' || (c == '\r' && peek(1) == '\n')) {
            return unterminated_string(begin, pos_);
        }
        if (c == '\\') {
            escape();
        } else {
            if (is_control(c) && c != '\t') {
                unexpected(pos_, decode(text_, pos_));
            }
            ++pos_;
        }
    }
}

void Lexer::escape() {
    const std::size_t begin = pos_++;
    if (at_end() || peek() == '\n' || peek() == '\r') {
        return; // the string ends here without its quote, which is the mistake to report
    }
    const Character c = decode(text_, pos_);
    pos_ += c.length;
    if (c.code != '"' && c.code != '\\' && c.code != 'n' && c.code != 't') {
        diagnostics_.report(Diag::bad_escape, span(begin, pos_), slice(begin + 1, pos_))
            .suggest(span(begin, begin), "\\");
    }
}

// A bracket on the same line that closes one opened before the string ends it, so that the missing quote does
// not also cost the brackets around it.
void Lexer::unterminated_string(std::size_t begin, std::size_t line_end) {
    int open = 0;
    const bool has_escapes = slice(begin, line_end).find('\\') != std::string_view::npos;
    pos_ = has_escapes ? line_end : begin + 1;
    for (; pos_ < line_end && open >= 0; ++pos_) {
        const char c = peek();
        open += c == '(' || c == '[' || c == '{' ? 1 : c == ')' || c == ']' || c == '}' ? -1 : 0;
    }
    pos_ -= open < 0 ? 1 : 0;
    while (pos_ > begin + 1 && (text_[pos_ - 1] == ' ' || text_[pos_ - 1] == '\t')) {
        --pos_;
    }
    Diagnostic& diagnostic = diagnostics_.report(Diag::unterminated_string, span(begin, pos_));
    const bool other_places_are_likely = slice(begin, pos_).find_first_of(",;=\\") != std::string_view::npos;
    if (!other_places_are_likely) {
        diagnostic.suggest(span(pos_, pos_), "\"");
    }
    push(TokenKind::string, begin);
}

/// `&&` for `and` and the like: read as what was meant.
void Lexer::foreign_operator(TokenKind meant, std::size_t length) {
    const std::size_t begin = pos_;
    punctuation(meant, length);
    const bool glued = continues_name(peek());
    diagnostics_
        .report(Diag::unexpected_character, span(begin, pos_), fmt::format("`{}`", slice(begin, pos_)))
        .suggest(span(begin, pos_), fmt::format("{}{}", spelling(meant), glued ? " " : ""));
}

/// Reports `'text'` as a whole, if the line has the closing quote.
bool Lexer::wrong_quotes(const Character& open) {
    const std::size_t begin = pos_;
    for (std::size_t i = begin + open.length; i < text_.size() && text_[i] != '\n';) {
        const Character c = decode(text_, i);
        if (c.code == '"' || is_wrong_quote(c.code)) {
            pos_ = i + c.length;
            const std::string_view content = slice(begin + open.length, i);
            Diagnostic* diagnostic = unexpected(begin, open);
            if (diagnostic && content.find('\\') == std::string_view::npos) {
                diagnostic->suggest(span(begin, pos_), fmt::format("\"{}\"", content));
            }
            push(TokenKind::error, begin);
            return true;
        }
        i += c.length;
    }
    return false;
}

/// One token and one message for a run of characters that mean nothing here.
void Lexer::unreadable() {
    const std::size_t begin = pos_;
    std::size_t culprit = begin;
    while (is_ascii(text_[culprit]) && continues_name(text_[culprit])) {
        ++culprit;
    }
    const Character first = decode(text_, culprit);
    if (is_wrong_quote(first.code) && culprit == begin && wrong_quotes(first)) {
        return;
    }
    pos_ = culprit + first.length;
    while (!at_end() && (peek() == text_[culprit] || !is_ascii(peek()) ||
                         (first.code >= 0x80 && continues_name(peek())))) {
        ++pos_;
    }
    Diagnostic* diagnostic = unexpected(culprit, first);
    const std::string_view meant = ascii_look_alike(first.code);
    if (diagnostic && !meant.empty()) {
        diagnostic->suggest(span(culprit, culprit + first.length), std::string(meant));
    }
    push(TokenKind::error, begin);
}

/// Silent in a file that is not UTF-8, where this was said once and for all.
Diagnostic* Lexer::unexpected(std::size_t begin, const Character& c) {
    if (!is_utf8_) {
        return nullptr;
    }
    return &diagnostics_.report(Diag::unexpected_character, span(begin, begin + c.length), named(c));
}

} // namespace

std::string string_value(std::string_view literal) {
    std::string value;
    value.reserve(literal.size());
    for (std::size_t i = 1; i < literal.size() && literal[i] != '"'; ++i) {
        if (literal[i] != '\\' || i + 1 == literal.size()) {
            value += literal[i];
            continue;
        }
        const char c = literal[++i];
        value += c == 'n' ? '\n' : c == 't' ? '\t' : c;
    }
    return value;
}

std::vector<Token> lex(const SourceSet& sources, FileId file, Diagnostics& diagnostics) {
    return lex_around(sources, file, {}, diagnostics);
}

std::vector<Token> lex_around(const SourceSet& sources, FileId file, const std::vector<Span>& left_out,
                              Diagnostics& diagnostics) {
    return Lexer(sources.file(file), file, left_out, diagnostics).run();
}

std::vector<Token> lex_within(const SourceSet& sources, Span span, Diagnostics& diagnostics) {
    const std::vector<Span> nothing;
    return Lexer(sources.file(span.file), span, nothing, diagnostics).run();
}

} // namespace scc::lang
