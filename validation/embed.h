#pragma once

#include "runtime/image.h"

#include <string>
#include <string_view>

/// What a self-contained HTML page is made of.
namespace scc::validation {

/// Text for element content and quoted attributes.
std::string escape_html(std::string_view text);

std::string base64(std::string_view bytes);

enum class Shrink {
    average,
    maximum, ///< keeps single pixels of a difference visible
};

/// At most `max_width` pixels wide, by a whole factor; smaller images are unchanged. Values that are not
/// finite are 1.
runtime::Image shrunk(const runtime::Image& image, int max_width, Shrink how);

/// "data:image/png;base64,..." of the image shrunk to 800 pixels.
std::string data_uri(const runtime::Image& image, Shrink how);

/// The values times `scale` as base64 of 16-bit floats, little-endian, rows from the top; what is too large
/// or not finite is infinite.
std::string half_floats(const runtime::Image& image, double scale);

} // namespace scc::validation
