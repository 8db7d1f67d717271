#include "lang/lsp/framing.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

namespace scc::lang::lsp {
namespace {

constexpr std::size_t longest_header = 1 << 12;
constexpr std::string_view length_field = "content-length:";

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// The number of a header line that states a length. Junk may stand before it: the rest of a message whose
/// length was stated too small.
std::optional<std::size_t> stated_length(std::string_view line) {
    const auto found = std::search(line.begin(), line.end(), length_field.begin(), length_field.end(),
                                   [](char a, char b) { return lower(a) == b; });
    if (found == line.end()) {
        return std::nullopt;
    }
    line.remove_prefix(static_cast<std::size_t>(found - line.begin()) + length_field.size());
    const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t last = line.find_last_not_of(" \t\r");
    std::size_t length = 0;
    const char* end = line.data() + (last == std::string_view::npos ? 0 : last + 1);
    const std::from_chars_result result = std::from_chars(line.data() + first, end, length);
    const bool is_number = result.ec == std::errc() && result.ptr == end;
    return is_number && length <= Framing::longest_message ? std::optional(length) : std::nullopt;
}

bool is_blank(std::string_view line) {
    return line.empty() || line == "\r";
}

} // namespace

void Framing::add(std::string_view bytes) {
    buffer_.erase(0, pos_);
    pos_ = 0;
    buffer_ += bytes;
}

/// Reads lines up to the empty one that ends a header with a length.
std::optional<std::size_t> Framing::find_header() {
    std::size_t line_begin = pos_;
    std::optional<std::size_t> length;
    for (;;) {
        const std::size_t line_end = buffer_.find('\n', line_begin);
        if (line_end == std::string::npos) {
            if (!length && buffer_.size() - pos_ > longest_header) { // the end of it may begin a header
                pos_ = buffer_.size() - longest_header;
            }
            return std::nullopt;
        }
        const std::string_view line(buffer_.data() + line_begin, line_end - line_begin);
        line_begin = line_end + 1;
        if (is_blank(line) && length) {
            pos_ = line_begin;
            return length;
        }
        const std::optional<std::size_t> stated = stated_length(line);
        length = stated ? stated : length;
        if (!length) {
            pos_ = line_begin;
        }
    }
}

std::optional<std::string> Framing::next() {
    if (!message_bytes_) {
        message_bytes_ = find_header();
    }
    if (!message_bytes_ || buffer_.size() - pos_ < *message_bytes_) {
        return std::nullopt;
    }
    std::string message = buffer_.substr(pos_, *message_bytes_);
    pos_ += *message_bytes_;
    message_bytes_.reset();
    return message;
}

std::string Framing::framed(std::string_view message) {
    return fmt::format("Content-Length: {}\r\n\r\n{}", message.size(), message);
}

} // namespace scc::lang::lsp
