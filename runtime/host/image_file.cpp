#include "runtime/host/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace scc::host {
namespace {

using runtime::Image;
using Bytes = std::vector<unsigned char>;

/// Linear light of an encoded value (IEC 61966-2-1).
double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Correctly rounded sRGB codes without a power per value: a code is the number of thresholds that a value
/// reaches, and the upper bits of the float say where to start counting.
class SrgbCodes {
public:
    /// `shift`: lower bits of a float that are ignored at first; chosen so that few thresholds differ only in
    /// them.
    SrgbCodes(std::uint16_t max, int shift) : max_(max), shift_(shift) {
        for (int code = 1; code <= max; ++code)
            thresholds_.push_back(float_not_below(decode_srgb((code - 0.5) / max)));
        thresholds_.push_back(2); // reached by none of the values that are looked up
        const std::uint32_t buckets = (std::bit_cast<std::uint32_t>(1.0F) >> shift) + 1;
        std::uint16_t code = 0;
        for (std::uint32_t bucket = 0; bucket < buckets; ++bucket)
            first_code_.push_back(code = count_reached(std::bit_cast<float>(bucket << shift), code));
    }

    std::uint16_t operator()(float linear) const {
        if (!(linear > 0)) // NaN too
            return 0;
        if (linear >= 1)
            return max_;
        return count_reached(linear, first_code_[std::bit_cast<std::uint32_t>(linear) >> shift_]);
    }

private:
    static float float_not_below(double value) {
        const auto nearest = static_cast<float>(value);
        return static_cast<double>(nearest) < value ? std::nextafter(nearest, 2.0F) : nearest;
    }
    std::uint16_t count_reached(float linear, std::uint16_t from) const {
        while (linear >= thresholds_[from])
            ++from;
        return from;
    }

    std::uint16_t max_;
    int shift_;
    std::vector<float> thresholds_;
    std::vector<std::uint16_t> first_code_;
};

enum class FileType { exr, png, pfm, unknown };

FileType type_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos)
        return FileType::unknown;
    std::string extension = path.substr(dot + 1);
    for (char& c : extension)
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (extension == "exr")
        return FileType::exr;
    if (extension == "png")
        return FileType::png;
    return extension == "pfm" ? FileType::pfm : FileType::unknown;
}

/// Encoded in memory, so that the writing and its errors are ours alone.
Bytes encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels) {
    Bytes bytes;
    bytes.reserve(spec.image_bytes() + spec.image_bytes() / 64); // an uncompressed file and its row headers
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output)
        throw FileError(fmt::format("cannot write {} images: {}", format, OIIO::geterror()));
    output->set_ioproxy(&memory);
    if (!output->open(fmt::format("image.{}", format), spec) || !output->write_image(spec.format, pixels) ||
        !output->close())
        throw FileError(fmt::format("cannot encode a {} image: {}", format, output->geterror()));
    return bytes;
}

OIIO::ImageSpec spec_of(const Image& image, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
    if (image.channels == 1)
        spec.channelnames = {"Y"};
    return spec;
}

constexpr int png_filter_none = 8;

template <class Code>
Bytes encode_png_codes(const Image& image, const SrgbCodes& codes, OIIO::TypeDesc type) {
    std::vector<Code> pixels(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), pixels.begin(),
                   [&](float linear) { return static_cast<Code>(codes(linear)); });
    OIIO::ImageSpec spec = spec_of(image, type);
    spec.attribute("oiio:ColorSpace", "sRGB");
    // 1920 x 1080 rendered, ms and kB: no filter 33 and 417, libpng's choice of filters 106 and 402; at its
    // default level of 6 these are 58 and 202, 233 and 261.
    spec.attribute("png:compressionLevel", 2);
    spec.attribute("png:filter", png_filter_none);
    return encode("png", spec, pixels.data());
}

Bytes encode_exr(const Image& image, bool compact) {
    OIIO::ImageSpec spec = spec_of(image, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", compact ? "zip" : "none");
    spec.attribute("oiio:ColorSpace", "Linear");
    return encode("exr", spec, image.pixels.data());
}

/// Rows from the bottom; a negative scale says little-endian.
std::string encode_pfm(const Image& image) {
    const char* scale = std::endian::native == std::endian::little ? "-1.0" : "1.0";
    std::string bytes =
        fmt::format("{}\n{} {}\n{}\n", image.channels == 1 ? "Pf" : "PF", image.width, image.height, scale);
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    bytes.reserve(bytes.size() + image.pixels.size() * sizeof(float));
    for (int y = image.height - 1; y >= 0; --y)
        bytes.append(reinterpret_cast<const char*>(image.at(0, y)), row * sizeof(float));
    return bytes;
}

std::string_view text_of(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void check_writable(const Image& image) {
    const std::size_t values = static_cast<std::size_t>(image.width) *
                               static_cast<std::size_t>(image.height) *
                               static_cast<std::size_t>(image.channels);
    if (image.width < 1 || image.height < 1 || image.pixels.size() != values)
        throw std::invalid_argument(fmt::format("an image of {} x {} pixels with {} values cannot be written",
                                                image.width, image.height, image.pixels.size()));
    if (image.channels != 1 && image.channels != 3)
        throw std::invalid_argument(
            fmt::format("an image file has 1 or 3 channels, this image has {}", image.channels));
}

[[noreturn]] void fail_reading(const std::string& path, const std::string& reason) {
    throw FileError(fmt::format("cannot read `{}`: {}", path, reason));
}

/// How many of the file's channels are colour.
int color_channels(const OIIO::ImageSpec& spec) {
    const int before_alpha = spec.alpha_channel >= 1 ? spec.alpha_channel : spec.nchannels;
    return std::min({before_alpha, spec.nchannels, 3});
}

template <class Code>
void read_codes(OIIO::ImageInput& input, OIIO::TypeDesc type, bool linear, Image& image,
                const std::string& path) {
    constexpr int max = (1 << (8 * sizeof(Code))) - 1;
    std::vector<float> value_of_code(static_cast<std::size_t>(max) + 1);
    for (std::size_t code = 0; code < value_of_code.size(); ++code) {
        const double value = static_cast<double>(code) / max;
        value_of_code[code] = static_cast<float>(linear ? value : decode_srgb(value));
    }
    std::vector<Code> codes(image.pixels.size());
    if (!input.read_image(0, 0, 0, image.channels, type, codes.data()))
        fail_reading(path, input.geterror());
    std::transform(codes.begin(), codes.end(), image.pixels.begin(),
                   [&](Code code) { return value_of_code[code]; });
}

} // namespace

bool is_image_type_known(const std::string& path) {
    return type_of(path) != FileType::unknown;
}

Bytes encode_png(const Image& image, int bits) {
    check_writable(image);
    if (bits == 8) {
        static const SrgbCodes codes(255, 15);
        return encode_png_codes<std::uint8_t>(image, codes, OIIO::TypeDesc::UINT8);
    }
    if (bits == 16) {
        static const SrgbCodes codes(65535, 12);
        return encode_png_codes<std::uint16_t>(image, codes, OIIO::TypeDesc::UINT16);
    }
    throw std::invalid_argument(fmt::format("a PNG file has 8 or 16 bits, not {}", bits));
}

void write_image(const std::string& path, const Image& image, const ImageFileOptions& options) {
    check_writable(image);
    switch (type_of(path)) {
    case FileType::exr:
        return replace_file(path, text_of(encode_exr(image, options.compact)));
    case FileType::png:
        return replace_file(path, text_of(encode_png(image, options.bits)));
    case FileType::pfm:
        return replace_file(path, encode_pfm(image));
    case FileType::unknown:
        break;
    }
    throw std::invalid_argument(
        fmt::format("image type of `{}` is unknown; the choices are .exr, .png and .pfm", path));
}

Image read_image(const std::string& path, bool linear_integers) {
    if (::access(path.c_str(), R_OK) != 0)
        fail_reading(path, std::strerror(errno));
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha",
                     1); // colours as stored, not multiplied by an alpha that is dropped
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input)
        fail_reading(path, OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    Image image(spec.width, spec.height, color_channels(spec));
    if (spec.format == OIIO::TypeDesc::UINT8)
        read_codes<std::uint8_t>(*input, OIIO::TypeDesc::UINT8, linear_integers, image, path);
    else if (!spec.format.is_floating_point())
        read_codes<std::uint16_t>(*input, OIIO::TypeDesc::UINT16, linear_integers, image, path);
    else if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        fail_reading(path, input->geterror());
    return image;
}

} // namespace scc::host
