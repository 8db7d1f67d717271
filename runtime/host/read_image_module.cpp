#include "runtime/host/srgb.h"
#include "runtime/image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
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

template <class Code>
void read_codes(OIIO::ImageInput& input, OIIO::TypeDesc type, bool linear, Image& image) {
    constexpr int max = (1 << (8 * sizeof(Code))) - 1;
    std::vector<float> value_of_code(static_cast<std::size_t>(max) + 1);
    for (std::size_t code = 0; code < value_of_code.size(); ++code) {
        const double value = static_cast<double>(code) / max;
        value_of_code[code] = static_cast<float>(linear ? value : decode_srgb(value));
    }
    std::vector<Code> codes(image.pixels.size());
    if (!input.read_image(0, 0, 0, image.channels, type, codes.data()))
        throw ReadError{input.geterror()};
    std::transform(codes.begin(), codes.end(), image.pixels.begin(),
                   [&](Code code) { return value_of_code[code]; });
}

Image read(const std::string& path, bool linear_integers) {
    if (::access(path.c_str(), R_OK) != 0)
        throw ReadError{std::strerror(errno)};
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha",
                     1); // colours as stored, not multiplied by an alpha that is dropped
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input)
        throw ReadError{OIIO::geterror()};
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

} // namespace

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
