#include "lang/brackets.h"

#include "lang/parser.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace scc::lang {
namespace {

constexpr std::size_t bracket_kinds = 3; // ( [ {

// tokens.def lists the brackets as ( ) [ ] { }.
constexpr std::size_t first_bracket = static_cast<std::size_t>(TokenKind::left_paren);
constexpr bool is_bracket(TokenKind kind) {
    return kind >= TokenKind::left_paren && kind <= TokenKind::right_brace;
}
constexpr std::size_t shape(TokenKind kind) {
    return (static_cast<std::size_t>(kind) - first_bracket) / 2;
}
constexpr bool opens(TokenKind kind) {
    return (static_cast<std::size_t>(kind) - first_bracket) % 2 == 0;
}
constexpr TokenKind closer_of(TokenKind opener) {
    return static_cast<TokenKind>(static_cast<std::size_t>(opener) + 1);
}

class Pairing {
public:
    Pairing(const std::vector<Token>& tokens, Diagnostics& diagnostics)
        : tokens_(tokens), diagnostics_(diagnostics), partner_(tokens.size(), no_partner) {}

    std::vector<std::uint32_t> run();

private:
    void close(std::uint32_t closer);
    void pair(std::uint32_t closer);
    void pop() {
        --open_of_shape_[shape(tokens_[open_.back()].kind)];
        open_.pop_back();
    }
    void report_unclosed(std::size_t first);

    const std::vector<Token>& tokens_;
    Diagnostics& diagnostics_;
    std::vector<std::uint32_t> partner_;
    std::vector<std::uint32_t> open_; ///< indices of the brackets that are open
    std::array<std::size_t, bracket_kinds> open_of_shape_{};
};

std::vector<std::uint32_t> Pairing::run() {
    for (std::uint32_t i = 0; i < tokens_.size(); ++i) {
        const TokenKind kind = tokens_[i].kind;
        if (!is_bracket(kind)) {
            continue;
        }
        if (opens(kind)) {
            open_.push_back(i);
            ++open_of_shape_[shape(kind)];
        } else {
            close(i);
        }
    }
    report_unclosed(0);
    return std::move(partner_);
}

void Pairing::close(std::uint32_t closer) {
    const Token& token = tokens_[closer];
    if (open_.empty()) {
        diagnostics_.report(Diag::unopened_bracket, token.span, spelling(token.kind));
        return;
    }
    if (open_of_shape_[shape(token.kind)] == 0) {
        const Token& opener = tokens_[open_.back()];
        const std::string_view expected = spelling(closer_of(opener.kind));
        diagnostics_.report(Diag::wrong_bracket, token.span, spelling(token.kind), expected)
            .suggest(token.span, std::string(expected))
            .note(opener.span, "it was opened here");
        return pair(closer);
    }
    std::size_t first_unclosed = open_.size();
    while (shape(tokens_[open_[first_unclosed - 1]].kind) != shape(token.kind)) {
        --first_unclosed;
    }
    report_unclosed(first_unclosed);
    while (open_.size() > first_unclosed) {
        pop();
    }
    pair(closer);
}

void Pairing::pair(std::uint32_t closer) {
    const std::uint32_t opener = open_.back();
    partner_[opener] = closer;
    partner_[closer] = opener;
    pop();
}

/// One message for the brackets of open_ from `first` on; those that nest too deep are the parser's to
/// report.
void Pairing::report_unclosed(std::size_t first) {
    constexpr std::size_t most_notes = 3;
    if (first >= open_.size() || open_.size() > static_cast<std::size_t>(max_nesting)) {
        return;
    }
    const Token& innermost = tokens_[open_.back()];
    Diagnostic& diagnostic =
        diagnostics_.report(Diag::unclosed_bracket, innermost.span, spelling(innermost.kind));
    const std::size_t noted = std::min(most_notes, open_.size() - first - 1);
    for (std::size_t i = 0; i < noted; ++i) {
        const Token& outer = tokens_[open_[open_.size() - 2 - i]];
        diagnostic.note(outer.span, fmt::format("nor is this `{}`", spelling(outer.kind)));
    }
}

} // namespace

std::vector<std::uint32_t> pair_brackets(const std::vector<Token>& tokens, Diagnostics& diagnostics) {
    return Pairing(tokens, diagnostics).run();
}

} // namespace scc::lang
