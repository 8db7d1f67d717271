#include "compiler/writer.h"

#include <cassert>
#include <cctype>
#include <cmath>

namespace scc::compiler {

namespace {

bool is_plain(char c) {
    return c >= 0x20 && c < 0x7f;
}

// SDL has no numeric escapes, so what it cannot write becomes `?`; only comments and file names are quoted
// there.
std::string escaped(Language language, char c) {
    switch (c) {
    case '"':
        return "\\\"";
    case '\\':
        return "\\\\";
    case '\n':
        return language == Language::sdl ? "?" : "\\n";
    case '\t':
        return language == Language::sdl ? "?" : "\\t";
    case '?':
        return language == Language::cpp ? "\\?" : "?"; // no trigraphs
    default:
        break;
    }
    if (is_plain(c)) {
        return {c};
    }
    const auto byte = static_cast<unsigned char>(c);
    switch (language) {
    case Language::cpp:
        return fmt::format("\\{:03o}", byte);
    case Language::python:
        return fmt::format("\\x{:02x}", byte);
    case Language::sdl:
        break;
    }
    return "?";
}

} // namespace

void Writer::raw_line(std::string_view text) {
    if (!text.empty()) {
        text_.append(static_cast<std::size_t>(depth_ * width_), ' ');
        text_ += text;
    }
    text_ += '\n';
}

std::string number(double value) {
    assert(std::isfinite(value));
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

std::string quote(Language language, std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        result += escaped(language, c);
    }
    return result + '"';
}

std::string comment_text(std::string_view text) {
    std::string result;
    for (const char c : text) {
        // A comment that ends in a backslash would swallow the next line in C++; `*/` and `/*` would end or
        // open one.
        const bool unsafe =
            !is_plain(c) || c == '\\' ||
            (!result.empty() && ((result.back() == '*' && c == '/') || (result.back() == '/' && c == '*')));
        result += unsafe ? '?' : c;
    }
    return result;
}

std::string Identifiers::make(std::string_view name) {
    std::string base = prefix_;
    for (const char c : name) {
        const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0 && is_plain(c);
        const char next = word ? c : '_';
        if (next != '_' || base.empty() || base.back() != '_') {
            base += next;
        }
    }
    while (base.size() > prefix_.size() && base.back() == '_') {
        base.pop_back();
    }
    std::string candidate = base;
    for (int i = 2; !taken_.insert(candidate).second; ++i) {
        candidate = fmt::format("{}_{}", base, i);
    }
    return candidate;
}

} // namespace scc::compiler
