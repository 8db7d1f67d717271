#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Compression as PNG and OpenEXR files have it (RFC 1950, 1951), made for pictures: one look at where the
/// same six bytes stood before, and Huffman codes of each part's own. Written here and not taken from zlib
/// because parts are compressed by several threads, several times as fast, and a program has no library to
/// bring along.
namespace scc::host {

/// A stretch of a deflate stream that is whole bytes, so that parts may be joined. It refers to nothing
/// before it. `last`: ends the stream. Less than 2 GiB.
std::string deflate_part(std::string_view bytes, bool last);

inline constexpr std::string_view zlib_head{"\x78\x01", 2};

/// RFC 1950's sum. `adler32_joined`: that of two stretches from their own, the second of `length` bytes.
std::uint32_t adler32(std::string_view bytes);
std::uint32_t adler32_joined(std::uint32_t first, std::uint32_t second, std::uint64_t length);

/// A whole zlib stream.
std::string zlib_compress(std::string_view bytes);

/// The sum of PNG's chunks (ISO 3309).
std::uint32_t crc32(std::string_view bytes);

/// Most significant byte first.
void append_big_endian(std::string& bytes, std::uint32_t value);

} // namespace scc::host
