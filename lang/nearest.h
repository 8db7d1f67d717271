#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

/// What a person may have meant by a word that is none of those that there are.
namespace scc::lang {

namespace detail {

inline constexpr std::size_t longest_word = 64;

inline char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`, regardless of case.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            current[j] = std::min({last[j] + 1, current[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) {
                current[j] = std::min(current[j], before_last[j - 2] + 1);
            }
        }
        before_last.swap(last);
        last.swap(current);
    }
    return last[b.size()];
}

// In a short word one letter changes everything: `x` is not a misspelt `y`.
inline std::size_t tolerated_edits(std::size_t length) {
    return length < 3 ? 0 : length < 6 ? 1 : length < 10 ? 2 : 3;
}

} // namespace detail

/// The nearest of `candidates` to `word` by edit distance, if it is near enough to be what was meant.
inline std::optional<std::string_view> nearest(std::string_view word,
                                               const std::vector<std::string_view>& candidates) {
    std::optional<std::string_view> best;
    std::size_t best_distance = detail::tolerated_edits(word.size()) + 1;
    if (word.size() > detail::longest_word) {
        return best;
    }
    for (const std::string_view candidate : candidates) {
        if (candidate.size() > word.size() + best_distance ||
            word.size() > candidate.size() + best_distance) {
            continue;
        }
        const std::size_t distance = detail::edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

} // namespace scc::lang
