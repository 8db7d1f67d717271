#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace scc::lang::lsp {

/// Cuts a stream into messages: a header with `Content-Length: bytes`, an empty line, the message. What is no
/// header is passed over, so that after a wrong length the stream is understood again from the next header.
class Framing {
public:
    /// A longer message is passed over with the rest of what is no header.
    static constexpr std::size_t longest_message = std::size_t{1} << 28;

    void add(std::string_view bytes);
    /// The next message that has arrived whole.
    std::optional<std::string> next();

    static std::string framed(std::string_view message);

private:
    std::optional<std::size_t> find_header();

    std::string buffer_;
    std::size_t pos_ = 0;                      ///< of what has not been looked at
    std::optional<std::size_t> message_bytes_; ///< of the message whose header was read
};

} // namespace scc::lang::lsp
