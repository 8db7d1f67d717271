#include "lang/text_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>

namespace scc::lang {
namespace {

/// Shorter runs cost nothing to speak of as they are.
constexpr std::size_t fewest_rows = 32;
constexpr std::size_t most_numbers = 64;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c);
}

/// Reads a number as the lexer does, with a sign before it; null where there is none, or more than a number.
/// Up to 15 digits and powers of ten up to 10^22 are exact in a double, so one rounding is all there is.
const char* read_number(const char* at, const char* end, double& value) {
    static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const bool negative = at < end && *at == '-';
    at += negative ? 1 : 0;
    const char* begin = at;
    std::uint64_t digits = 0;
    for (; at < end && is_digit(*at); ++at) {
        digits = digits * 10 + static_cast<std::uint64_t>(*at - '0');
    }
    if (at == begin) {
        return nullptr;
    }
    std::ptrdiff_t length = at - begin;
    std::ptrdiff_t fraction = 0;
    if (at + 1 < end && *at == '.' && is_digit(at[1])) {
        const char* point = at++;
        for (; at < end && is_digit(*at); ++at) {
            digits = digits * 10 + static_cast<std::uint64_t>(*at - '0');
        }
        fraction = at - point - 1;
        length += fraction;
    }
    if (at < end && (*at == ' ' || *at == ',' || *at == ')')) {
        if (length <= 15) {
            value = static_cast<double>(digits) / powers[static_cast<std::size_t>(fraction)];
            value = negative ? -value : value;
            return at;
        }
    } else if (at < end && (*at == 'e' || *at == 'E')) {
        const char* exponent = at + 1;
        exponent += exponent < end && (*exponent == '+' || *exponent == '-') ? 1 : 0;
        at = exponent;
        while (at < end && is_digit(*at)) {
            ++at;
        }
        if (at == exponent || at == end || (*at != ' ' && *at != ',' && *at != ')')) {
            return nullptr;
        }
    } else {
        return nullptr;
    }
    const std::from_chars_result result = std::from_chars(begin, at, value);
    value = negative ? -value : value;
    return result.ec == std::errc{} && result.ptr == at ? at : nullptr;
}

/// The text of a row between its numbers.
struct Skeleton {
    std::vector<std::string_view> parts; ///< one more than numbers
    std::size_t least_length = 0;        ///< of a row with its line end
};

std::string_view line_at(std::string_view text, std::size_t begin) {
    const std::size_t end = text.find('\n', begin);
    std::string_view line = text.substr(begin, (end == std::string_view::npos ? text.size() : end) - begin);
    return line;
}

std::optional<Skeleton> skeleton_of(std::string_view line) {
    const std::size_t word = line.find_first_not_of(" \t");
    const bool is_candidate =
        word != std::string_view::npos && is_word(line[word]) && !is_digit(line[word]) &&
        line.find_last_of('}') != std::string_view::npos &&
        line.find_first_not_of(" \t\r", line.find_last_of('}') + 1) == std::string_view::npos &&
        line.find_first_of("\"/;") == std::string_view::npos;
    if (!is_candidate) {
        return std::nullopt;
    }
    Skeleton skeleton;
    const char* const end = line.data() + line.size();
    const char* part = line.data();
    for (const char* at = part; at < end;) {
        const bool follows = at > line.data() && (is_word(at[-1]) || at[-1] == '.' || at[-1] == '#');
        if (!is_digit(*at) || follows) {
            ++at;
            continue;
        }
        const char* begin = at > line.data() && at[-1] == '-' ? at - 1 : at;
        double value = 0;
        at = read_number(begin, end, value);
        if (at == nullptr || skeleton.parts.size() == most_numbers) {
            return std::nullopt;
        }
        skeleton.parts.emplace_back(part, static_cast<std::size_t>(begin - part));
        part = at;
    }
    if (skeleton.parts.empty()) {
        return std::nullopt;
    }
    skeleton.parts.emplace_back(part, static_cast<std::size_t>(end - part));
    for (const std::string_view one : skeleton.parts) {
        skeleton.least_length += one.size() + 1;
    }
    return skeleton;
}

/// The end of a row at `at`, its numbers; null if there is no such row.
const char* match(const Skeleton& skeleton, const char* at, const char* end, double* numbers) {
    const std::size_t last = skeleton.parts.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const std::string_view part = skeleton.parts[i];
        if (static_cast<std::size_t>(end - at) < part.size() ||
            std::memcmp(at, part.data(), part.size()) != 0) {
            return nullptr;
        }
        at += part.size();
        if (i < last && (at = read_number(at, end, numbers[i])) == nullptr) {
            return nullptr;
        }
    }
    return at == end || *at == '\n' ? at : nullptr;
}

class TableReader {
public:
    TableReader(std::string_view text, FileId file) : text_(text), file_(file) {}

    /// The table whose first row is the line at `begin`, if there is one. `begin` moves past what has been
    /// read.
    std::optional<TextTable> read(std::size_t& begin) {
        const std::string_view line = line_at(text_, begin);
        const std::optional<Skeleton> skeleton = skeleton_of(line);
        const char* const end = text_.data() + text_.size();
        const char* const second = std::min(line.data() + line.size() + 1, end);
        std::array<double, most_numbers> numbers{};
        std::size_t like_it = 0;
        const char* at = second;
        while (skeleton && like_it < fewest_rows && at < end) {
            const char* row_end = match(*skeleton, at, end, numbers.data());
            if (row_end == nullptr) {
                break;
            }
            ++like_it;
            at = std::min(row_end + 1, end);
        }
        const std::size_t text_left = text_.size() - begin;
        begin = offset(at);
        if (like_it + 1 < fewest_rows) {
            return std::nullopt;
        }
        // Room for all rows that the text can have; what is not used is never touched.
        const std::size_t most_rows = text_left / skeleton->least_length + 2;
        auto columns = std::make_shared<std::vector<Column>>();
        for (std::size_t i = 0; i + 1 < skeleton->parts.size(); ++i) {
            columns->emplace_back(most_rows);
        }
        auto places = std::make_shared<Places>();
        places->reserve(most_rows);
        const std::size_t indent = line.find_first_not_of(" \t");
        const std::size_t tail = line.size() - (line.find_last_of('}') + 1);
        at = line.data();
        while (at < end) {
            const char* row_end = match(*skeleton, at, end, numbers.data());
            if (row_end == nullptr) {
                break;
            }
            for (std::size_t i = 0; i < columns->size(); ++i) {
                (*columns)[i].data()[places->size()] = numbers[i];
            }
            places->emplace_back(offset(at + indent), offset(row_end - tail));
            at = std::min(row_end + 1, end);
        }
        begin = offset(at);
        return TextTable{{file_, places->front().first, places->front().second},
                         {file_, offset(second), offset(at)},
                         std::move(columns),
                         std::move(places)};
    }

private:
    std::uint32_t offset(const char* at) const { return static_cast<std::uint32_t>(at - text_.data()); }

    std::string_view text_;
    FileId file_;
};

} // namespace

std::vector<TextTable> find_tables(std::string_view text, FileId file) {
    std::vector<TextTable> tables;
    TableReader reader(text, file);
    for (std::size_t begin = 0; begin < text.size();) {
        if (auto table = reader.read(begin)) {
            tables.push_back(std::move(*table));
        }
    }
    return tables;
}

} // namespace scc::lang
