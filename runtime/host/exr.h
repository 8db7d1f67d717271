#pragma once

#include "runtime/image.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace scc::host {

/// One of a file's channels: 32-bit floats, or whole numbers of 32 bits.
struct ExrChannel {
    std::string name;      ///< `R`, or of a layer: `normal.X`; at most 31 bytes
    const void* values;    ///< of the first pixel; rows from the top
    std::size_t step = 1;  ///< from one pixel's to the next one's, in values
    bool is_whole = false; ///< std::uint32_t
};

struct ExrContent {
    int width = 0, height = 0;
    std::vector<ExrChannel> channels; ///< in any order
    /// Attributes of the file that are text: name (at most 31 bytes) and value.
    std::vector<std::pair<std::string, std::string>> texts;
};

/// Red, green and blue, or brightness alone.
ExrContent exr_content(const runtime::Image& image);

/// An OpenEXR file's bytes (one part, in rows), uncompressed or, `compact`, by its ZIP method. What `content`
/// points to must live.
std::string encode_exr(ExrContent content, bool compact, int threads = 1);
inline std::string encode_exr(const runtime::Image& image, bool compact, int threads = 1) {
    return encode_exr(exr_content(image), compact, threads);
}

} // namespace scc::host
