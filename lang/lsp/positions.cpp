#include "lang/lsp/positions.h"

#include <algorithm>

namespace scc::lang::lsp {
namespace {

bool continues_character(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

/// Code units that a byte of UTF-8 stands for; those of a character count at its first byte.
std::uint32_t units(char c, Encoding encoding) {
    if (encoding == Encoding::utf8) {
        return 1;
    }
    const bool needs_surrogates = static_cast<unsigned char>(c) >= 0xf0;
    return continues_character(c) ? 0 : needs_surrogates ? 2 : 1;
}

} // namespace

Positions::Positions(std::string_view text, Encoding encoding) : text_(text), encoding_(encoding) {
    line_starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_end = text[i] == '\n' || (text[i] == '\r' && text.substr(i + 1, 1) != "\n");
        if (is_end) {
            line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
        }
    }
}

Place Positions::place(std::uint32_t offset) const {
    offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
    const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    const auto line = static_cast<std::uint32_t>(next - line_starts_.begin() - 1);
    Place place{line, 0};
    for (std::uint32_t i = line_starts_[line]; i < offset; ++i) {
        place.character += units(text_[i], encoding_);
    }
    return place;
}

std::uint32_t Positions::offset(Place place) const {
    if (place.line >= line_starts_.size()) {
        return static_cast<std::uint32_t>(text_.size());
    }
    std::uint32_t at = line_starts_[place.line];
    std::uint32_t character = 0;
    while (at < text_.size() && text_[at] != '\n' && text_[at] != '\r') {
        const std::uint32_t next = character + units(text_[at], encoding_);
        if (character >= place.character && !continues_character(text_[at])) {
            break;
        }
        if (next > place.character && encoding_ == Encoding::utf16) { // within a surrogate pair
            break;
        }
        character = next;
        ++at;
    }
    return at;
}

} // namespace scc::lang::lsp
