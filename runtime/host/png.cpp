#include "runtime/host/png.h"

#include "runtime/host/deflate.h"
#include "runtime/host/parallel.h"
#include "runtime/host/srgb.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
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
        static const SrgbCodes codes(255, 15);
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
    const int count = image.width * image.channels;
    for (int i = 0; i < count; ++i) {
        const unsigned code = codes(from[i]);
        if (bits == 16) {
            *to++ = static_cast<unsigned char>(code >> 8);
        }
        *to++ = static_cast<unsigned char>(code);
    }
}

/// Rows as PNG filters them: a byte that names the filter, then what it left. Each row is taken as it is, or
/// as the difference from the one above, whichever leaves the smaller sum of sizes.
class Strip {
public:
    Strip(const Image& image, const SrgbCodes& codes, int bits)
        : image_(image), codes_(codes), bits_(bits),
          row_(static_cast<std::size_t>(image.width * image.channels * bits / 8)), above_(row_), here_(row_) {
    }

    std::string filtered(int first, int end) {
        std::string bytes;
        bytes.resize(static_cast<std::size_t>(end - first) * (row_ + 1));
        char* to = bytes.data();
        if (first > 0) {
            encode_row(image_, first - 1, codes_, bits_, here_.data());
        }
        for (int y = first; y < end; ++y) {
            std::swap(above_, here_);
            encode_row(image_, y, codes_, bits_, here_.data());
            to = add_row(to);
        }
        return bytes;
    }

private:
    char* add_row(char* to) const {
        unsigned plain = 0, difference = 0;
        for (std::size_t i = 0; i < row_; ++i) {
            const auto left = static_cast<signed char>(here_[i] - above_[i]);
            plain += static_cast<unsigned>(std::abs(static_cast<int>(static_cast<signed char>(here_[i]))));
            difference += static_cast<unsigned>(std::abs(static_cast<int>(left)));
        }
        const bool up = difference < plain;
        *to++ = up ? 2 : 0;
        for (std::size_t i = 0; i < row_; ++i) {
            to[i] = static_cast<char>(here_[i] - (up ? above_[i] : 0));
        }
        return to + row_;
    }

    const Image& image_;
    const SrgbCodes& codes_;
    int bits_;
    std::size_t row_;
    std::vector<unsigned char> above_, here_;
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
