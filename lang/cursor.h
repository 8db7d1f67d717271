#pragma once

#include "lang/brackets.h"
#include "lang/diagnostic.h"
#include "lang/lexer.h"
#include "lang/parser.h"
#include "lang/source.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace scc::lang {

/// Walks over the tokens of a file for the parser: decides where lines end items, bounds nesting, and holds
/// the state of error recovery. After fail() the cursor panics: it stands still and matches nothing, so that
/// the parser's rules return, until the innermost bracket or item that can be skipped as a whole ends the
/// panic.
class Cursor {
public:
    Cursor(const SourceFile& source, const std::vector<Token>& tokens, Diagnostics& diagnostics)
        : text_(source.text()), tokens_(tokens), diagnostics_(diagnostics),
          partner_(pair_brackets(tokens, diagnostics)),
          limit_(static_cast<std::uint32_t>(tokens.size() - 1)) {
        update();
    }

    /// The current token's kind, or end_of_line where the line before it ends an item.
    TokenKind kind() const { return kind_; }
    bool at(TokenKind kind) const { return kind_ == kind; }
    bool at_separator() const;
    /// At the end of the innermost brackets, or of the file.
    bool at_limit() const { return pos_ >= limit_; }
    bool panicking() const { return panic_; }
    TokenKind peek() const { return panic_ ? kind_ : effective_kind(std::min(pos_ + 1, limit_)); }
    /// A line ends here, and the next begins with an opening brace.
    bool at_brace_on_new_line() const {
        return at(TokenKind::end_of_line) && token().kind == TokenKind::left_brace;
    }

    const Token& token() const { return tokens_[pos_]; }
    const Token& previous() const { return tokens_[pos_ == 0 ? 0 : pos_ - 1]; }
    std::uint32_t position() const { return pos_; }
    std::string_view text(Span span) const { return text_.substr(span.begin, span.end - span.begin); }
    /// From a token's begin to the end of the last token that was read.
    Span span_from(Span first) const {
        return {first.file, first.begin, std::max(first.end, previous().span.end)};
    }
    /// Where a message about the current token points.
    Span place() const;
    /// The current token as a message names it.
    std::string description() const;

    void advance() {
        ++pos_;
        update();
    }
    bool accept(TokenKind kind) {
        if (kind_ != kind) {
            return false;
        }
        advance();
        return true;
    }
    bool expect(TokenKind kind);
    void skip_line_end() {
        if (at(TokenKind::end_of_line)) {
            kind_ = raw_kind(pos_);
        }
    }

    /// Reports a mistake, unless it follows from one that was reported already.
    template <class... Args>
    void complain(std::optional<Fix> fix, Diag kind, Span where, const Args&... args) {
        if (!is_consequence()) {
            diagnostics_.report(kind, where, args...).fix = std::move(fix);
        }
    }
    /// "found the current token where `expected` is expected"
    void fail(std::string_view expected);
    void panic() {
        panic_ = true;
        kind_ = TokenKind::end_of_file;
    }
    /// Ends a panic: skips to the next separator in the current brackets, but at least one token from
    /// `start`.
    void recover(std::uint32_t start);
    /// The names in text that was skipped, and those defined in braces that cannot be trusted.
    std::unordered_set<std::string> lost_names() const;

    /// One more operator in a chain, which makes the tree one higher. False if it is one too many; what was
    /// built of the chain is then dropped, for the height is counted anew.
    bool grow(Span op);

private:
    friend class Group;
    friend class Nest;
    friend class Height;

    bool line_ends_before(std::uint32_t index) const;
    bool begins_only_items(std::uint32_t index) const;
    bool is_unreadable(std::uint32_t index) const { return raw_kind(index) == TokenKind::error; }
    TokenKind raw_kind(std::uint32_t index) const;
    TokenKind effective_kind(std::uint32_t index) const {
        const bool starts_line = tokens_[index].starts_line;
        return starts_line && line_ends_before(index) ? TokenKind::end_of_line : raw_kind(index);
    }
    void update() { kind_ = panic_ ? TokenKind::end_of_file : effective_kind(pos_); }
    void skip();
    /// Text that is not in the tree, or of which only single items are.
    struct Lost {
        std::uint32_t begin, end; ///< tokens
        bool only_definitions;
    };
    bool is_consequence() const;
    void report_too_deep();

    std::string_view text_;
    const std::vector<Token>& tokens_;
    Diagnostics& diagnostics_;
    std::vector<std::uint32_t> partner_;
    std::uint32_t pos_ = 0;
    std::uint32_t limit_; ///< the closing bracket of the innermost pair, or the end of the file
    TokenKind kind_ = TokenKind::end_of_file;
    bool lines_end_items_ = true; ///< false inside ( ) and [ ]
    bool panic_ = false;
    bool muted_ = false; ///< inside a bracket that was reported, where every line looks wrong
    bool too_deep_reported_ = false;
    std::vector<Lost> lost_;
    int depth_ = 0;
    int height_ = 0; ///< an upper bound for the tree built in the current Height
};

/// The inside of a pair of brackets. finish() is called on every path; it also ends a panic that began
/// inside.
class Group {
public:
    explicit Group(Cursor& cursor); ///< at the opening bracket, which it passes

    /// Passes the closing bracket; what stands before it instead is reported. The span is that of the whole
    /// group.
    Span finish(std::string_view expected);
    /// After finish(): the inside is not to be trusted.
    bool failed() const { return failed_; }
    bool is_paired() const;

private:
    Cursor& cursor_;
    Span opener_;
    std::uint32_t begin_;
    std::uint32_t partner_;
    std::uint32_t outer_limit_;
    bool outer_lines_end_items_, outer_muted_;
    bool is_brace_;
    bool failed_ = false;
};

/// Tracks the height of one subtree.
class Height {
public:
    explicit Height(Cursor& cursor) : cursor_(cursor), outer_(cursor.height_) { cursor_.height_ = 0; }
    ~Height() { cursor_.height_ = std::max(outer_, cursor_.height_ + 1); }
    Height(const Height&) = delete;
    Height& operator=(const Height&) = delete;

private:
    Cursor& cursor_;
    int outer_;
};

/// One level of recursion of the parser; false if it is one too many, which is reported.
class Nest {
public:
    explicit Nest(Cursor& cursor) : cursor_(cursor), height_(cursor) {
        if (++cursor_.depth_ > max_nesting) {
            cursor_.report_too_deep();
        }
    }
    ~Nest() { --cursor_.depth_; }
    Nest(const Nest&) = delete;
    Nest& operator=(const Nest&) = delete;

    explicit operator bool() const { return !cursor_.panicking(); }

private:
    Cursor& cursor_;
    Height height_;
};

} // namespace scc::lang
