#pragma once

#include <fmt/core.h>

#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace scc::compiler {

enum class Language { cpp, sdl, python };

/// Collects indented lines of generated text.
class Writer {
public:
    explicit Writer(int indent_width = 4) : width_(indent_width) {}

    template <class... Args>
    void line(fmt::format_string<Args...> text, Args&&... args) {
        raw_line(fmt::format(text, std::forward<Args>(args)...));
    }
    void raw_line(std::string_view text);
    void blank() { text_ += '\n'; }
    void indent() { ++depth_; }
    void dedent() { --depth_; }

    const std::string& text() const { return text_; }
    std::string take() { return std::move(text_); }

private:
    std::string text_;
    int depth_ = 0;
    int width_;
};

/// The shortest text that reads back as exactly this double, with a decimal point or exponent. Must be
/// finite.
std::string number(double value);

/// A string literal of the language that no content can leave: quotes, backslashes, line ends and bytes
/// outside printable ASCII are escaped.
std::string quote(Language language, std::string_view text);

/// Text that is safe inside a one-line comment: line ends, other control characters and whatever could end or
/// open a comment are replaced.
std::string comment_text(std::string_view text);

/// Hands out identifiers made from authors' names: letters, digits and `_` only, distinct. The prefix keeps
/// them apart from the reserved words of the language they are written in.
class Identifiers {
public:
    explicit Identifiers(std::string prefix) : prefix_(std::move(prefix)) {}
    std::string make(std::string_view name);

private:
    std::string prefix_;
    std::set<std::string> taken_;
};

} // namespace scc::compiler
