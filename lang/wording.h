#pragma once

#include "lang/schema.h"

#include <fmt/core.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Pieces of sentences that several messages share.
namespace scc::lang {

inline std::string in_code(std::string_view text) {
    return fmt::format("`{}`", text);
}

/// `; did you mean `x`?`, or nothing.
inline std::string did_you_mean(std::optional<std::string_view> best) {
    return best ? fmt::format("; did you mean `{}`?", *best) : "";
}

inline std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// `a, b or c`.
inline std::string alternatives(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    }
    return text;
}

/// `the choices are "a" or "b"`, for a field that has some.
inline std::string choice_rule(const Field& field) {
    std::vector<std::string> words;
    for (std::string_view choice : field.choices) {
        words.push_back(fmt::format("\"{}\"", choice));
    }
    return "the choices are " + alternatives(words);
}

} // namespace scc::lang
