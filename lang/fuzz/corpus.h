#pragma once

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang::fuzz {

/// The texts in the file `corpus`, which the fuzzers found: of each, its length as a line, and itself as
/// another, whatever bytes it has. Throws where it is cut off.
inline std::vector<std::string_view> texts_of(std::string_view corpus) {
    std::vector<std::string_view> texts;
    while (!corpus.empty()) {
        std::size_t length = 0;
        const auto [end, error] = std::from_chars(corpus.data(), corpus.data() + corpus.size(), length);
        const auto digits = static_cast<std::size_t>(end - corpus.data());
        if (error != std::errc() || corpus.size() - digits < 2 || length > corpus.size() - digits - 2) {
            throw std::runtime_error("the corpus is cut off");
        }
        texts.push_back(corpus.substr(digits + 1, length));
        corpus.remove_prefix(digits + length + 2);
    }
    return texts;
}

} // namespace scc::lang::fuzz
