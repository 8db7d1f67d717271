#include "lang/lsp/context.h"

#include <algorithm>

namespace scc::lang::lsp {
namespace {

using Where = Context::Where;

constexpr std::size_t none = static_cast<std::size_t>(-1);

bool is_word(TokenKind kind) {
    return kind == TokenKind::name || (kind >= TokenKind::kw_language && kind <= TokenKind::kw_false);
}

bool opens(TokenKind kind) {
    return kind == TokenKind::left_paren || kind == TokenKind::left_bracket || kind == TokenKind::left_brace;
}

bool closes(TokenKind kind) {
    return kind == TokenKind::right_paren || kind == TokenKind::right_bracket ||
           kind == TokenKind::right_brace;
}

bool ends_operand(TokenKind kind) {
    switch (kind) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::string:
    case TokenKind::hex_color:
    case TokenKind::kw_true:
    case TokenKind::kw_false:
    case TokenKind::error:
        return true;
    default:
        return closes(kind);
    }
}

/// Behind which a new name is made up, or a number is written.
bool comes_before_new_name(TokenKind kind) {
    return kind == TokenKind::kw_let || kind == TokenKind::kw_fn || kind == TokenKind::kw_param ||
           kind == TokenKind::kw_as || kind == TokenKind::kw_import || kind == TokenKind::kw_language;
}

bool separates(TokenKind kind) {
    return kind == TokenKind::comma || kind == TokenKind::semicolon;
}

/// What the tokens around a place say, read backwards.
class Reader {
public:
    explicit Reader(const Analysis& analysis) : analysis_(analysis), tokens_(analysis.tokens) {}

    TokenKind kind(std::size_t i) const { return i == none ? TokenKind::end_of_file : tokens_[i].kind; }
    TokenKind before(std::size_t i) const {
        return i == 0 || i == none ? TokenKind::end_of_file : kind(i - 1);
    }
    std::string_view text(std::size_t i) const { return analysis_.text(tokens_[i].span); }

    /// The bracket around the token before `i`, still open there; none: the file.
    std::size_t opener(std::size_t i) const {
        int depth = 0;
        while (i-- > 0) {
            depth += closes(kind(i)) ? 1 : opens(kind(i)) ? -1 : 0;
            if (depth < 0) {
                return i;
            }
        }
        return none;
    }

    /// A token that begins a line on which another item can begin.
    bool begins_item(std::size_t i) const {
        const bool is_joined = kind(i) == TokenKind::kw_then || kind(i) == TokenKind::kw_and ||
                               kind(i) == TokenKind::kw_or || kind(i) == TokenKind::kw_else;
        return tokens_[i].starts_line && !is_joined && (i == 0 || ends_operand(kind(i - 1)));
    }

    /// The first token of the item that the token before `i` belongs to; `body` is the bracket around it.
    std::size_t item_begin(std::size_t i, std::size_t body) const {
        int depth = 0;
        while (i > 0 && i - 1 != body) {
            const TokenKind previous = kind(i - 1);
            if (depth == 0 && separates(previous)) {
                return i;
            }
            --i;
            depth += closes(previous) ? 1 : opens(previous) ? -1 : 0;
            if (depth == 0 && begins_item(i)) {
                return i;
            }
        }
        return i;
    }

    /// What a brace belongs to.
    enum class Brace { thing, loop_or_condition, function, other };
    Brace brace(std::size_t i) const {
        const TokenKind previous = before(i);
        if (previous == TokenKind::kw_else) {
            return Brace::loop_or_condition;
        }
        if (previous == TokenKind::name && i >= 2) {
            return kind(i - 2) == TokenKind::arrow ? Brace::function : Brace::thing;
        }
        if (previous == TokenKind::right_bracket) { // of a type
            return Brace::function;
        }
        if (previous != TokenKind::right_paren) {
            return previous == TokenKind::name ? Brace::thing : Brace::other;
        }
        return ends_head(i - 1) ? Brace::loop_or_condition : Brace::function;
    }

    /// The closing parenthesis of `for (...)` or `if (...)`.
    bool ends_head(std::size_t i) const {
        const std::size_t paren = kind(i) == TokenKind::right_paren ? opener(i) : none;
        const TokenKind head = paren == none ? TokenKind::end_of_file : before(paren);
        return head == TokenKind::kw_for || head == TokenKind::kw_if;
    }

    /// The body in which an item at `i` stands, past loops and conditions; none: the file.
    std::size_t body(std::size_t i) const {
        std::size_t at = opener(i);
        while (at != none && kind(at) == TokenKind::left_brace && brace(at) == Brace::loop_or_condition) {
            at = opener(at);
        }
        return at;
    }

    const Constructor* constructor(std::size_t brace_at) const {
        return brace_at == none || brace_at == 0 ? nullptr : analysis_.schema.find(text(brace_at - 1));
    }

    /// Fields that are set directly in a body, from the names before `=`.
    std::vector<std::string_view> fields_set(std::size_t body_at, Span except) const {
        std::vector<std::string_view> names;
        int depth = 0;
        for (std::size_t i = body_at + 1; i + 1 < tokens_.size() && depth >= 0; ++i) {
            depth += opens(kind(i)) ? 1 : closes(kind(i)) ? -1 : 0;
            if (depth == 0 && kind(i) == TokenKind::name && kind(i + 1) == TokenKind::assign &&
                kind(i - 1) != TokenKind::kw_let && tokens_[i].span.begin != except.begin) {
                names.push_back(text(i));
            }
        }
        return names;
    }

    bool in_comment(std::size_t previous, std::uint32_t offset) const {
        const std::uint32_t begin = previous == none ? 0 : tokens_[previous].span.end;
        const std::string_view gap = analysis_.text({analysis_.file, begin, std::max(begin, offset)});
        for (std::size_t i = 0; i + 1 < gap.size();) {
            const bool is_line = gap.substr(i, 2) == "//";
            if (!is_line && gap.substr(i, 2) != "/*") {
                ++i;
                continue;
            }
            const std::string_view end = is_line ? "\n" : "*/";
            const std::size_t found = gap.find(end, i + 2);
            if (found == std::string_view::npos) {
                return true;
            }
            i = found + end.size();
        }
        return false;
    }

    bool new_line_between(std::size_t previous, std::uint32_t offset) const {
        const std::uint32_t begin = previous == none ? 0 : tokens_[previous].span.end;
        return analysis_.text({analysis_.file, begin, std::max(begin, offset)}).find('\n') !=
               std::string_view::npos;
    }

private:
    const Analysis& analysis_;
    const std::vector<Token>& tokens_;
};

/// Whether the cursor stands in the list of a function's parameters.
bool in_formals(const Reader& reader, std::size_t paren) {
    return reader.before(paren) == TokenKind::kw_fn ||
           (reader.before(paren) == TokenKind::name && paren >= 2 &&
            reader.before(paren - 1) == TokenKind::kw_fn);
}

/// What may be written behind the token `previous`.
Where after(const Reader& reader, std::size_t previous, std::size_t here, bool on_new_line) {
    const TokenKind kind = reader.kind(previous);
    const std::size_t around = reader.opener(here);
    const bool in_body = around == none || reader.kind(around) == TokenKind::left_brace;
    if (comes_before_new_name(kind)) {
        return Where::nothing;
    }
    if (kind == TokenKind::colon || kind == TokenKind::arrow) {
        return Where::type;
    }
    if (kind == TokenKind::dot) {
        return Where::member;
    }
    if (in_body && (previous == none || previous == around || separates(kind))) {
        return Where::item;
    }
    if (reader.ends_head(previous)) {
        return Where::operand;
    }
    if (ends_operand(kind) || kind == TokenKind::kw_else) {
        return in_body && on_new_line       ? Where::item
               : kind == TokenKind::kw_else ? Where::operand
                                            : Where::after_operand;
    }
    const bool is_first = previous == around || separates(kind);
    const bool is_new_name =
        is_first && !in_body && (in_formals(reader, around) || reader.before(around) == TokenKind::kw_for);
    return is_new_name ? Where::nothing : Where::operand;
}

/// The field whose value begins behind its `=`, the token `assign`.
const Field* field_of(const Reader& reader, std::size_t assign) {
    if (assign == none || assign == 0 || reader.kind(assign) != TokenKind::assign) {
        return nullptr;
    }
    const std::size_t body = reader.body(assign);
    const Constructor* thing = body == none || reader.kind(body) != TokenKind::left_brace ||
                                       reader.item_begin(assign, reader.opener(assign)) + 1 != assign
                                   ? nullptr
                                   : reader.constructor(body);
    return thing ? thing->find(reader.text(assign - 1)) : nullptr;
}

} // namespace

std::optional<std::size_t> token_at(const Analysis& analysis, std::uint32_t offset) {
    const auto& tokens = analysis.tokens;
    auto next = std::partition_point(tokens.begin(), tokens.end(),
                                     [&](const Token& token) { return token.span.end < offset; });
    const auto touches = [&](auto token) {
        return token != tokens.end() && token->span.begin <= offset && token->kind != TokenKind::end_of_file;
    };
    if (!touches(next)) {
        return std::nullopt;
    }
    if (touches(next + 1) && !is_word(next->kind)) {
        ++next;
    }
    return static_cast<std::size_t>(next - tokens.begin());
}

Context context_at(const Analysis& analysis, std::uint32_t offset) {
    const Reader reader(analysis);
    const auto& tokens = analysis.tokens;
    const auto next = std::partition_point(tokens.begin(), tokens.end(),
                                           [&](const Token& token) { return token.span.end < offset; });
    auto here = static_cast<std::size_t>(next - tokens.begin());
    Context context;
    context.word = {analysis.file, offset, offset};
    if (here < tokens.size() && tokens[here].span.begin < offset) { // in a token, or at its end
        const Token& token = tokens[here];
        const bool is_open_string =
            token.kind == TokenKind::string &&
            (offset < token.span.end || !analysis.text(token.span).substr(1).ends_with('"'));
        if (is_open_string) {
            context.where = Where::string;
            context.word = token.span;
            context.field = field_of(reader, here == 0 ? none : here - 1);
            return context;
        }
        if (is_word(token.kind)) {
            context.word = {analysis.file, token.span.begin, offset};
        } else if (offset < token.span.end || token.kind == TokenKind::number ||
                   token.kind == TokenKind::error || token.kind == TokenKind::hex_color) {
            return context;
        } else {
            ++here;
        }
    }
    const std::size_t previous = here == 0 ? none : here - 1;
    if (reader.in_comment(previous, context.word.begin)) {
        return context;
    }
    context.where = after(reader, previous, here, reader.new_line_between(previous, context.word.begin));
    context.field = field_of(reader, previous);
    const std::size_t body = reader.body(here);
    if (body == none) {
        context.is_file = true;
    } else if (reader.kind(body) == TokenKind::left_brace) {
        context.thing = reader.brace(body) == Reader::Brace::thing ? reader.constructor(body) : nullptr;
        context.is_function = reader.brace(body) == Reader::Brace::function;
        context.set = context.thing ? reader.fields_set(body, context.word) : std::vector<std::string_view>();
    }
    return context;
}

const Field* field_at(const Analysis& analysis, std::size_t token) {
    const bool is_last = token + 1 >= analysis.tokens.size();
    return is_last ? nullptr : field_of(Reader(analysis), token + 1);
}

const Constructor* thing_around(const Analysis& analysis, std::size_t token) {
    const Reader reader(analysis);
    const std::size_t body = reader.body(token);
    const bool is_thing = body != none && reader.kind(body) == TokenKind::left_brace &&
                          reader.brace(body) == Reader::Brace::thing;
    return is_thing ? reader.constructor(body) : nullptr;
}

} // namespace scc::lang::lsp
