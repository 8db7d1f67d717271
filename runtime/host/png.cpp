#include "runtime/host/png.h"

#include "runtime/host/deflate.h"
#include "runtime/host/parallel.h"
#include "runtime/host/srgb.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace scc::host {

namespace {

using runtime::Image;

/// Bytes per strip before compression: enough that codes of its own and no look back cost a strip little.
constexpr std::size_t strip_bytes = std::size_t{1} << 17;

const SrgbCodes& codes_of(int bits) {
    if (bits == 8) {
        static const SrgbCodes codes(255, 16);
        return codes;
    }
    if (bits == 16) {
        static const SrgbCodes codes(65535, 12);
        return codes;
    }
    throw std::invalid_argument("a PNG file has 8 or 16 bits, not " + std::to_string(bits));
}

void encode_row(const Image& image, int y, const SrgbCodes& codes, int bits, unsigned char* to) {
    const float* from = image.at(0, y);
    const auto count = static_cast<std::size_t>(image.width * image.channels);
    if (bits == 8) {
        codes.encode(from, count, to);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const unsigned code = codes(from[i]);
        *to++ = static_cast<unsigned char>(code >> 8);
        *to++ = static_cast<unsigned char>(code);
    }
}

/// Which of the three neighbours is nearest to left + up - corner, as PNG defines it. In 16 bits, of which a
/// vector holds more.
unsigned char paeth(unsigned char left, unsigned char up, unsigned char corner) {
    const auto size = [](std::int16_t x) { return static_cast<std::int16_t>(x < 0 ? -x : x); };
    const auto along = static_cast<std::int16_t>(up - corner),
               down = static_cast<std::int16_t>(left - corner);
    const std::int16_t to_left = size(along), to_up = size(down);
    const std::int16_t to_corner = size(static_cast<std::int16_t>(along + down));
    const unsigned char other = to_up <= to_corner ? up : corner;
    return to_left <= std::min(to_up, to_corner) ? left : other;
}

// One loop each, so that the compiler makes vectors of them.

void subtract(const unsigned char* __restrict here, const unsigned char* other, std::size_t count,
              unsigned char* __restrict result) {
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = static_cast<unsigned char>(here[i] - other[i]);
    }
}

void subtract_nearest(const unsigned char* __restrict here, const unsigned char* __restrict above,
                      std::size_t pixel, std::size_t count, unsigned char* __restrict result) {
    for (std::size_t i = 0; i < count; ++i) {
        result[i] =
            static_cast<unsigned char>(here[i] - paeth((here - pixel)[i], above[i], (above - pixel)[i]));
    }
}

/// Rows as PNG filters them: a byte that names the filter, then what it left. Each row is taken as the
/// difference from its neighbours to the left, above, or Paeth's choice of them, whichever leaves the
/// smallest sum of sizes; taken as they are, or from a mean, rendered rows are hardly ever smaller.
class Strip {
public:
    Strip(const Image& image, const SrgbCodes& codes, int bits)
        : image_(image), codes_(codes), bits_(bits),
          pixel_(static_cast<std::size_t>(image.channels * bits / 8)),
          row_(static_cast<std::size_t>(image.width) * pixel_), above_(pixel_ + row_), here_(pixel_ + row_),
          from_left_(row_), from_above_(row_), from_nearest_(row_) {}

    std::string filtered(int first, int end) {
        std::string bytes;
        bytes.resize(static_cast<std::size_t>(end - first) * (row_ + 1));
        char* to = bytes.data();
        if (first > 0) {
            encode_row(image_, first - 1, codes_, bits_, here_.data() + pixel_);
        }
        for (int y = first; y < end; ++y) {
            std::swap(above_, here_);
            encode_row(image_, y, codes_, bits_, here_.data() + pixel_);
            to = add_row(to);
        }
        return bytes;
    }

private:
    using Bytes = std::vector<unsigned char>;

    char* add_row(char* to) {
        const unsigned char* const here = here_.data() + pixel_;
        const unsigned char* const above = above_.data() + pixel_;
        subtract(here, above, row_, from_above_.data());
        const Bytes* best = &from_above_;
        char filter = 2;
        std::size_t least = sum_of_sizes(from_above_);
        const auto consider = [&](const Bytes& row, char its_filter) {
            if (const std::size_t sum = sum_of_sizes(row); sum < least) {
                least = sum;
                best = &row;
                filter = its_filter;
            }
        };
        if (least > row_ / 32) { // else it cannot get much smaller
            subtract(here, here_.data(), row_, from_left_.data());
            consider(from_left_, 1);
            subtract_nearest(here, above, pixel_, row_, from_nearest_.data());
            consider(from_nearest_, 4);
        }
        *to++ = filter;
        std::memcpy(to, best->data(), row_);
        return to + row_;
    }
    /// Of signed differences.
    static std::size_t sum_of_sizes(const Bytes& row) {
        unsigned sum = 0;
        for (const unsigned char byte : row) {
            const auto negative = static_cast<unsigned char>(-byte);
            sum += byte < negative ? byte : negative;
        }
        return sum;
    }

    const Image& image_;
    const SrgbCodes& codes_;
    int bits_;
    std::size_t pixel_, row_; ///< in bytes
    Bytes above_, here_;      ///< with a black pixel before the first
    Bytes from_left_, from_above_, from_nearest_;
};

std::string chunk(const char (&type)[5], std::string_view data) {
    std::string bytes;
    bytes.reserve(data.size() + 12);
    append_big_endian(bytes, static_cast<std::uint32_t>(data.size()));
    bytes.append(type, 4);
    bytes += data;
    append_big_endian(bytes, crc32(std::string_view(bytes).substr(4)));
    return bytes;
}

std::string header(const Image& image, int bits) {
    std::string data;
    append_big_endian(data, static_cast<std::uint32_t>(image.width));
    append_big_endian(data, static_cast<std::uint32_t>(image.height));
    data += static_cast<char>(bits);
    data += image.channels == 1 ? char{0} : char{2}; // grey or RGB
    data.append(3, 0);                               // deflate, filters per row, not interlaced
    return chunk("IHDR", data);
}

} // namespace

std::string encode_png(const Image& image, int bits, int threads) {
    const SrgbCodes& codes = codes_of(bits);
    const std::size_t row = static_cast<std::size_t>(image.width * image.channels * bits / 8) + 1;
    const int rows = static_cast<int>(std::max(std::size_t{1}, strip_bytes / row));
    const int strips = (image.height + rows - 1) / rows;
    struct Part {
        std::string chunk;
        std::uint32_t sum = 0;
        std::size_t length = 0;
    };
    std::vector<Part> parts(static_cast<std::size_t>(strips));
    parallel_for(strips, threads, [&](int i) {
        const std::string bytes =
            Strip(image, codes, bits).filtered(i * rows, std::min(image.height, (i + 1) * rows));
        const std::string data = deflate_part(bytes, i + 1 == strips);
        parts[static_cast<std::size_t>(i)] = {chunk("IDAT", i == 0 ? std::string(zlib_head) + data : data),
                                              adler32(bytes), bytes.size()};
    });

    std::string file = "\x89PNG\r\n\x1a\n";
    file += header(image, bits);
    file += chunk("sRGB", std::string_view("\0", 1)); // perceptual
    std::uint32_t sum = 1;
    for (const Part& part : parts) {
        file += part.chunk;
        sum = adler32_joined(sum, part.sum, part.length);
    }
    std::string end;
    append_big_endian(end, sum);
    return file + chunk("IDAT", end) + chunk("IEND", {});
}

} // namespace scc::host
