#include "runtime/host/read_image.h"
#include "runtime/host/srgb.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <unistd.h>
#include <vector>

/// The module behind read_image(), loaded when an image is read: OpenImageIO brings over 250 libraries, which
/// would make every start of scc 0.2 s long.
namespace scc::host {

namespace {

using runtime::Image;

struct ReadError {
    std::string reason;
};

/// How many of the file's channels are colour.
int color_channels(const OIIO::ImageSpec& spec) {
    const int before_alpha = spec.alpha_channel >= 1 ? spec.alpha_channel : spec.nchannels;
    return std::min({before_alpha, spec.nchannels, 3});
}

/// The light of each code.
template <class Code>
std::vector<float> values_of_codes(bool linear) {
    constexpr int max = (1 << (8 * sizeof(Code))) - 1;
    std::vector<float> values(static_cast<std::size_t>(max) + 1);
    for (std::size_t code = 0; code < values.size(); ++code) {
        const double value = static_cast<double>(code) / max;
        values[code] = static_cast<float>(linear ? value : decode_srgb(value));
    }
    return values;
}

template <class Code>
void read_codes(OIIO::ImageInput& input, OIIO::TypeDesc type, bool linear, Image& image) {
    const std::vector<float> value_of_code = values_of_codes<Code>(linear);
    std::vector<Code> codes(image.pixels.size());
    if (!input.read_image(0, 0, 0, image.channels, type, codes.data()))
        throw ReadError{input.geterror()};
    std::transform(codes.begin(), codes.end(), image.pixels.begin(),
                   [&](Code code) { return value_of_code[code]; });
}

std::unique_ptr<OIIO::ImageInput> open(const std::string& path) {
    if (::access(path.c_str(), R_OK) != 0)
        throw ReadError{std::strerror(errno)};
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha",
                     1); // colours as stored, not multiplied by an alpha that is dropped
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input)
        throw ReadError{OIIO::geterror()};
    return input;
}

Image read(const std::string& path, bool linear_integers) {
    const std::unique_ptr<OIIO::ImageInput> input = open(path);
    const OIIO::ImageSpec& spec = input->spec();
    Image image(spec.width, spec.height, color_channels(spec));
    if (spec.format == OIIO::TypeDesc::UINT8)
        read_codes<std::uint8_t>(*input, OIIO::TypeDesc::UINT8, linear_integers, image);
    else if (!spec.format.is_floating_point())
        read_codes<std::uint16_t>(*input, OIIO::TypeDesc::UINT16, linear_integers, image);
    else if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        throw ReadError{input->geterror()};
    return image;
}

/// The rows from the bottom.
template <class T>
std::vector<T> read_upwards(OIIO::ImageInput& input, OIIO::TypeDesc type, const Texels& texels) {
    const auto row = static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.channels);
    std::vector<T> values(row * static_cast<std::size_t>(texels.height));
    if (!input.read_image(0, 0, 0, texels.channels, type, values.data()))
        throw ReadError{input.geterror()};
    for (std::size_t low = 0, high = values.size(); high > low + row; low += row) {
        high -= row;
        std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(low),
                         values.begin() + static_cast<std::ptrdiff_t>(low + row),
                         values.begin() + static_cast<std::ptrdiff_t>(high));
    }
    return values;
}

Texels read_texels(const std::string& path, bool linear_integers, int largest) {
    const std::unique_ptr<OIIO::ImageInput> input = open(path);
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width > largest || spec.height > largest)
        throw ReadError{"it has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                        " texels, more than " + std::to_string(largest) + " to a side"};
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        throw ReadError{"it is no flat picture"};
    Texels texels;
    texels.width = spec.width;
    texels.height = spec.height;
    texels.channels = color_channels(spec) == 3 ? 3 : 1;
    texels.holds_floats = spec.format.is_floating_point();
    if (texels.holds_floats) {
        texels.values = read_upwards<float>(*input, OIIO::TypeDesc::FLOAT, texels);
    } else if (spec.format == OIIO::TypeDesc::UINT8) {
        texels.codes = read_upwards<std::uint8_t>(*input, OIIO::TypeDesc::UINT8, texels);
    } else {
        const std::vector<float> value_of_code = values_of_codes<std::uint16_t>(linear_integers);
        const auto codes = read_upwards<std::uint16_t>(*input, OIIO::TypeDesc::UINT16, texels);
        for (const std::uint16_t code : codes)
            texels.values.push_back(value_of_code[code]);
    }
    return texels;
}

} // namespace

/// Whether it was read; else `error` says why not.
extern "C" bool scc_read_texels(const std::string& path, bool linear_integers, int largest, Texels& texels,
                                std::string& error) {
    try {
        texels = read_texels(path, linear_integers, largest);
        return true;
    } catch (const ReadError& failure) {
        error = failure.reason;
    } catch (const std::bad_alloc&) {
        error = "it does not fit into memory";
    }
    if (error.empty())
        error = "it is damaged";
    return false;
}

/// Whether it was read; else `error` says why not.
extern "C" bool scc_read_image(const std::string& path, bool linear_integers, Image& image,
                               std::string& error) {
    try {
        image = read(path, linear_integers);
        return true;
    } catch (const ReadError& failure) {
        error = failure.reason;
    }
    return false;
}

} // namespace scc::host
