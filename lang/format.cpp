#include "lang/format.h"

#include "lang/brackets.h"
#include "lang/dump.h"
#include "lang/format_structure.h"
#include "lang/parser.h"
#include "lang/utf8.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace scc::lang {
namespace {

constexpr std::size_t widest_line = 100;
constexpr std::size_t step = 2; ///< of indentation

struct Comment {
    std::string text;
    bool is_line; ///< `//`
    int newlines; ///< between it and what stands before it
    bool after_separator = false;
};

/// What stands before a token, but for other tokens.
struct Gap {
    std::vector<Comment> comments;
    int newlines = 0; ///< directly before the token
};

/// Text on one line, as far as the source has it on one.
struct Flat {
    std::string text;
    bool is_complete = true;
};

bool is_separator(TokenKind kind) {
    return kind == TokenKind::comma || kind == TokenKind::semicolon;
}

/// No blank stands before these.
bool closes_up(TokenKind kind) {
    return is_separator(kind) || kind == TokenKind::right_paren || kind == TokenKind::right_bracket ||
           kind == TokenKind::colon || kind == TokenKind::dot;
}

std::size_t width_of(std::string_view text) {
    std::size_t width = 0;
    for (std::size_t i = 0; i < text.size();) {
        const Character c = decode(text, i);
        width += static_cast<std::size_t>(std::max(display_width(c.code), 0));
        i += c.length;
    }
    return width;
}

/// The text of a comment, with the line ends and without the trailing blanks that it may have in the source.
std::string tidy(std::string_view comment) {
    std::string text;
    for (const char c : comment) {
        if (c == '\n') {
            text.erase(text.find_last_not_of(" \t\r") + 1);
        }
        text += c;
    }
    text.erase(text.find_last_not_of(" \t\r") + 1);
    return text;
}

class Formatter {
public:
    Formatter(const SourceFile& source, const std::vector<Token>& tokens, const ast::File& file)
        : source_(source.text()), tokens_(tokens), structure_(structure_of(tokens, file)) {}

    std::string run() {
        list(structure_.items, 0, static_cast<std::uint32_t>(tokens_.size() - 1), 0);
        if (!out_.empty()) {
            out_ += '\n';
        }
        return std::move(out_);
    }

private:
    TokenKind kind(std::uint32_t i) const { return tokens_[i].kind; }
    std::string_view text(std::uint32_t i) const {
        const Span span = tokens_[i].span;
        return source_.substr(span.begin, span.end - span.begin);
    }
    const std::vector<TokenRange>* body_at(std::uint32_t i) const {
        const auto found = structure_.bodies.find(i);
        return found == structure_.bodies.end() ? nullptr : &found->second;
    }
    bool opens_group(std::uint32_t i) const {
        return kind(i) == TokenKind::left_paren || kind(i) == TokenKind::left_bracket;
    }

    Gap gap(std::uint32_t i) const;
    bool blank_between(std::uint32_t before, std::uint32_t i) const;
    bool joins_else(std::uint32_t i) const {
        return i > 0 && kind(i) == TokenKind::kw_else && kind(i - 1) == TokenKind::right_brace;
    }

    // text on one line
    Flat flat(TokenRange range) const;
    bool has_room(TokenRange range) const;
    bool add_flat(TokenRange range, std::string& out, std::size_t limit = std::string::npos) const;
    bool add_flat_body(std::uint32_t open, std::string& out) const;
    bool add_flat_between(std::uint32_t first, std::uint32_t next, bool is_first, bool is_last,
                          std::string& out) const;

    // text on several lines
    void list(const std::vector<TokenRange>& items, std::uint32_t begin, std::uint32_t end,
              std::size_t indent);
    std::vector<Comment> comments_between(std::uint32_t first, std::uint32_t next, int& newlines) const;
    void item(TokenRange range);
    void pieces(TokenRange range, std::size_t indent, const std::vector<std::uint32_t>& breaks);
    std::vector<std::uint32_t> breaks_of(TokenRange range, std::size_t indent) const;
    void before(std::uint32_t i, std::size_t indent, bool breaks);
    void group(std::uint32_t open);
    void body(std::uint32_t open);

    bool fits(std::string_view added) const { return column_ + width_of(added) <= widest_line; }
    void put(std::string_view added);
    void new_line(std::size_t indent);
    void put_trailing(const Comment& comment) {
        put(comment.is_line ? "  " : " ");
        put(comment.text);
    }

    std::string_view source_;
    const std::vector<Token>& tokens_;
    FormatStructure structure_;
    std::string out_;
    std::size_t column_ = 0;
    std::size_t line_indent_ = 0; ///< of the line that is being written
};

// ---- what stands between tokens ---------------------------------------------------------------------------

Gap Formatter::gap(std::uint32_t i) const {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    std::size_t at = i == 0 ? (source_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0)
                            : tokens_[i - 1].span.end;
    const std::size_t end = tokens_[i].span.begin;
    Gap result;
    while (at < end) {
        if (source_[at] != '/') {
            result.newlines += source_[at] == '\n' ? 1 : 0;
            ++at;
            continue;
        }
        const bool is_line = source_[at + 1] == '/';
        const std::size_t found = is_line ? source_.find('\n', at) : source_.find("*/", at + 2) + 2;
        const std::size_t comment_end = std::min(found, end);
        result.comments.push_back({tidy(source_.substr(at, comment_end - at)), is_line, result.newlines});
        result.newlines = 0;
        at = comment_end;
    }
    return result;
}

bool Formatter::blank_between(std::uint32_t before, std::uint32_t i) const {
    const TokenKind left = kind(before);
    const TokenKind right = kind(i);
    if (closes_up(right) || left == TokenKind::left_paren || left == TokenKind::left_bracket ||
        left == TokenKind::dot || left == TokenKind::dot_dot || right == TokenKind::dot_dot) {
        return false;
    }
    if (left == TokenKind::minus && !structure_.infix.contains(before)) {
        return false;
    }
    const bool is_head = right == TokenKind::left_paren &&
                         (left == TokenKind::kw_fn || (before > 0 && kind(before - 1) == TokenKind::kw_fn));
    return !is_head && !structure_.postfix.contains(i);
}

// ---- text on one line -------------------------------------------------------------------------------------

Flat Formatter::flat(TokenRange range) const {
    Flat result;
    result.is_complete = add_flat(range, result.text);
    return result;
}

/// Whether the tokens fit on the current line as far as the source has them on one.
bool Formatter::has_room(TokenRange range) const {
    constexpr std::size_t too_long = 4 * widest_line; // in bytes
    std::string text;
    add_flat(range, text, too_long);
    return fits(text);
}

/// False at the first line end, which the text then reaches up to, and where the text exceeds the limit.
bool Formatter::add_flat(TokenRange range, std::string& out, std::size_t limit) const {
    for (std::uint32_t i = range.first; i <= range.last; ++i) {
        if (out.size() > limit) {
            return false;
        }
        if (i > range.first) {
            const Gap before = gap(i);
            for (const Comment& comment : before.comments) {
                if (comment.newlines > 0 || comment.is_line || comment.text.find('\n') != std::string::npos) {
                    return false;
                }
                out += ' ' + comment.text;
            }
            if (before.newlines > 0 && !(joins_else(i) && before.comments.empty())) {
                return false;
            }
            const bool blank = before.comments.empty() ? blank_between(i - 1, i) : !closes_up(kind(i));
            out += blank ? " " : "";
        }
        if (body_at(i)) {
            if (!add_flat_body(i, out)) {
                return false;
            }
            i = structure_.partner[i];
        } else {
            out += text(i);
        }
    }
    return true;
}

bool Formatter::add_flat_body(std::uint32_t open, std::string& out) const {
    const std::uint32_t close = structure_.partner[open];
    const std::vector<TokenRange>& items = *body_at(open);
    out += "{";
    std::uint32_t next = open + 1;
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (!add_flat_between(next, items[k].first, k == 0, false, out) || !add_flat(items[k], out)) {
            return false;
        }
        next = items[k].last + 1;
    }
    if (!add_flat_between(next, close, items.empty(), true, out)) {
        return false;
    }
    out += " }";
    return true;
}

/// Comments before a separator stay with what stands before it.
bool Formatter::add_flat_between(std::uint32_t first, std::uint32_t next, bool is_first, bool is_last,
                                 std::string& out) const {
    int newlines = 0;
    const std::vector<Comment> comments = comments_between(first, next, newlines);
    bool is_separated = is_first || is_last;
    for (const Comment& comment : comments) {
        if (comment.newlines > 0 || comment.is_line || comment.text.find('\n') != std::string::npos) {
            return false;
        }
        if (comment.after_separator && !is_separated) {
            out += ",";
            is_separated = true;
        }
        out += ' ' + comment.text;
    }
    if (newlines > 0) {
        return false;
    }
    out += !is_separated ? ", " : !is_last ? " " : "";
    return true;
}

// ---- text on several lines --------------------------------------------------------------------------------

void Formatter::put(std::string_view added) {
    out_ += added;
    const std::size_t line_end = added.rfind('\n');
    column_ =
        line_end == std::string_view::npos ? column_ + width_of(added) : width_of(added.substr(line_end + 1));
}

void Formatter::new_line(std::size_t indent) {
    if (!out_.empty()) {
        out_ += '\n';
    }
    out_.append(indent, ' ');
    column_ = indent;
    line_indent_ = indent;
}

/// All comments before the tokens from `first`, which are separators, up to `next`; and the line ends after
/// the last of them.
std::vector<Comment> Formatter::comments_between(std::uint32_t first, std::uint32_t next,
                                                 int& newlines) const {
    std::vector<Comment> found;
    for (std::uint32_t i = first; i <= next; ++i) {
        Gap before = gap(i);
        for (Comment& comment : before.comments) {
            comment.newlines += newlines;
            comment.after_separator = i > first;
            newlines = 0;
            found.push_back(std::move(comment));
        }
        newlines += before.newlines;
    }
    return found;
}

/// Items with a line each, and the comments around them, from the token `begin` on to the token `end`.
void Formatter::list(const std::vector<TokenRange>& items, std::uint32_t begin, std::uint32_t end,
                     std::size_t indent) {
    bool is_start = true; // of a body, where no empty line stands
    const auto start_line = [&](int newlines) {
        if (newlines > 1 && !is_start) {
            out_ += '\n';
        }
        new_line(indent);
        is_start = false;
    };
    for (std::size_t k = 0; k <= items.size(); ++k) {
        const bool is_end = k == items.size();
        const std::uint32_t next = is_end ? end : items[k].first;
        int newlines = 0;
        const std::vector<Comment> comments = comments_between(begin, next, newlines);
        // Those on the line of the item before, unless what follows is on that line too.
        const auto leads = [&](const Comment& comment) {
            return !comment.is_line && !is_end && newlines == 0 && (comment.after_separator || k == 0);
        };
        std::size_t c = 0;
        const bool has_line = k > 0 || begin > 0;
        for (; c < comments.size() && has_line && comments[c].newlines == 0 && !leads(comments[c]); ++c) {
            put_trailing(comments[c]);
        }
        bool is_on_line = false;
        for (; c < comments.size(); ++c) {
            if (is_on_line && comments[c].newlines == 0) {
                put(" ");
            } else {
                start_line(comments[c].newlines);
            }
            put(comments[c].text);
            is_on_line = !comments[c].is_line;
        }
        if (is_end) {
            return;
        }
        if (is_on_line && newlines == 0) {
            put(" ");
        } else {
            start_line(newlines);
        }
        item(items[k]);
        begin = items[k].last + 1;
    }
}

void Formatter::item(TokenRange range) {
    const std::size_t indent = line_indent_ + step;
    const Flat whole = flat(range);
    if (whole.is_complete && fits(whole.text)) {
        put(whole.text);
        return;
    }
    pieces(range, indent, whole.is_complete ? breaks_of(range, indent) : std::vector<std::uint32_t>{});
}

/// Where an item that the author wrote on one line is broken outside of brackets: after its `=` if the value
/// then fits, else before every `then` and `else`.
std::vector<std::uint32_t> Formatter::breaks_of(TokenRange range, std::size_t indent) const {
    std::vector<std::uint32_t> connectives;
    std::uint32_t value = 0;
    bool has_body = false;
    for (std::uint32_t i = range.first; i <= range.last; ++i) {
        has_body = has_body || body_at(i);
        if (structure_.partner[i] != no_partner) {
            i = structure_.partner[i];
        } else if (kind(i) == TokenKind::assign && value == 0) {
            value = i + 1;
        } else if (kind(i) == TokenKind::kw_then || kind(i) == TokenKind::kw_else) {
            connectives.push_back(i);
        }
    }
    if (has_body) {
        return {};
    }
    const bool fits_below = value > 0 && indent + width_of(flat({value, range.last}).text) <= widest_line;
    return fits_below ? std::vector<std::uint32_t>{value} : connectives;
}

/// The tokens of an item one by one. `breaks` are those that begin a line, besides the ones that the author
/// lets begin one.
void Formatter::pieces(TokenRange range, std::size_t indent, const std::vector<std::uint32_t>& breaks) {
    bool has_open_body = false;
    for (std::uint32_t i = range.first; i <= range.last; ++i) {
        if (i > range.first) {
            before(i, indent, std::binary_search(breaks.begin(), breaks.end(), i));
        }
        if (body_at(i)) {
            std::string alone;
            const bool stays = !has_open_body && has_room({i, range.last}) && add_flat_body(i, alone);
            if (stays) {
                put(alone);
            } else {
                body(i);
            }
            has_open_body = !stays;
            i = structure_.partner[i];
        } else if (opens_group(i)) {
            group(i);
            i = structure_.partner[i];
        } else {
            put(text(i));
        }
    }
}

/// What stands before a token within an item. Line ends are kept, except before the `else` of a body.
void Formatter::before(std::uint32_t i, std::size_t indent, bool breaks) {
    const Gap gap_before = gap(i);
    const std::vector<Comment>& comments = gap_before.comments;
    if (breaks) {
        new_line(indent);
    }
    bool is_start = breaks;
    for (const Comment& comment : comments) {
        if (comment.newlines > 0 && !is_start) {
            new_line(indent);
            put(comment.text);
        } else if (is_start) {
            put(comment.text);
        } else {
            put_trailing(comment);
        }
        is_start = false;
        if (comment.is_line) {
            new_line(indent);
            is_start = true;
        }
    }
    if (is_start) {
        return;
    }
    if (gap_before.newlines > 0 && !(joins_else(i) && comments.empty())) {
        new_line(indent);
    } else if (comments.empty() ? blank_between(i - 1, i) : !closes_up(kind(i))) {
        put(" ");
    }
}

/// `( )` or `[ ]`. One that the author wrote on one line and that is too wide gets a line for each element.
/// Lines of one that begins on the bracket's line are aligned with that beginning.
void Formatter::group(std::uint32_t open) {
    const std::uint32_t close = structure_.partner[open];
    const Flat whole = flat({open, close});
    if (whole.is_complete && fits(whole.text + ",")) {
        put(whole.text);
        return;
    }
    const std::size_t outer = line_indent_;
    put(text(open));
    std::vector<std::uint32_t> breaks;
    if (whole.is_complete) {
        breaks.push_back(open + 1);
        for (std::uint32_t i = open + 1; i < close; ++i) {
            if (structure_.partner[i] != no_partner) {
                i = structure_.partner[i];
            } else if (kind(i) == TokenKind::comma) {
                breaks.push_back(i + 1);
            }
        }
    }
    if (open + 1 < close) {
        const Gap first = gap(open + 1);
        const bool hangs = !whole.is_complete && first.newlines == 0 && first.comments.empty();
        const std::size_t inner = hangs ? column_ : outer + step;
        before(open + 1, inner, whole.is_complete);
        pieces({open + 1, close - 1}, inner, breaks);
    }
    before(close, outer, whole.is_complete);
    put(text(close));
}

void Formatter::body(std::uint32_t open) {
    const std::uint32_t close = structure_.partner[open];
    const std::size_t outer = line_indent_;
    put("{");
    list(*body_at(open), open + 1, close, outer + step);
    new_line(outer);
    put("}");
}

} // namespace

std::string format(const SourceSet& sources, const std::vector<Token>& tokens, const ast::File& file) {
    return Formatter(sources.file(file.file), tokens, file).run();
}

std::string checked_format(const SourceSet& sources, const std::vector<Token>& tokens,
                           const ast::File& file) {
    std::string result = format(sources, tokens, file);
    SourceSet laid_out;
    Diagnostics ignored;
    if (dump_ast(*parse_file(laid_out, laid_out.add("", result), ignored)) != dump_ast(file)) {
        throw std::logic_error(
            fmt::format("the layout of `{}` would change its meaning", sources.file(file.file).path()));
    }
    return result;
}

} // namespace scc::lang
