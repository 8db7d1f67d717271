#include "compiler/backends/pov_image.h"

#include "runtime/host/png.h"
#include "runtime/host/srgb.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace scc::compiler {

namespace {

/// A PNG file with these codes; `code(x, y, channel)` in 0..most, rows from the bottom.
template <class Code>
std::string png_of(const runtime::ImageData& data, int bits, Code&& code) {
    const double most = std::exp2(bits) - 1;
    runtime::Image picture(static_cast<int>(data.width), static_cast<int>(data.height));
    for (std::uint32_t y = 0; y < data.height; ++y) {
        for (std::uint32_t x = 0; x < data.width; ++x) {
            float* pixel = picture.at(static_cast<int>(x), static_cast<int>(data.height - 1 - y));
            for (std::uint32_t channel = 0; channel < 3; ++channel) {
                pixel[channel] =
                    static_cast<float>(host::decode_srgb(code(x, y, channel) / most)); // the writer encodes
            }
        }
    }
    return host::encode_png(picture, bits);
}

} // namespace

std::string PovImages::Declared::channel(std::uint32_t which, const std::string& u,
                                         const std::string& v) const {
    static constexpr std::string_view channels[] = {"red", "green", "blue"};
    const runtime::ImageData& data = image->data;
    const auto inside = [&](const std::string& x, std::uint32_t size) {
        return data.wrap == runtime::Wrap::repeat
                   ? x
                   : fmt::format("min(max({}, {}), {})", x, number(0.5 / size), number(1 - 0.5 / size));
    };
    const std::string value =
        fmt::format("{}({}, {}, 0).{}", name, inside(u, data.width), inside(v, data.height), channels[which]);
    if (low == 0 && span == 1) {
        return value;
    }
    return fmt::format("({}*{} + ({}))", value, number(span), number(low));
}

const PovImages::Declared& PovImages::declare(const ir::Image& image) {
    const auto [place, is_new] = declared_.try_emplace(&image);
    Declared& declared = place->second;
    if (!is_new) {
        return declared;
    }
    const runtime::ImageData& data = image.data;
    declared.image = &image;
    declared.name = names_.make(image.name);
    const std::string file = fmt::format("{}_{}.png", files_.stem, declared.name);
    const bool keeps_codes = data.codes != nullptr;
    if (keeps_codes) {
        files_.files.push_back(
            {file, png_of(data, 8, [&](auto x, auto y, auto channel) {
                 const std::uint32_t stored = std::min(channel, data.channels - 1);
                 return data.codes[(std::size_t{y} * data.width + x) * data.channels + stored];
             })});
    } else {
        declared.low = *std::min_element(data.min.begin(), data.min.end());
        const double high = *std::max_element(data.max.begin(), data.max.end());
        declared.span = high > declared.low ? high - declared.low : 1;
        declared.error = declared.span / 65535 / 2;
        files_.files.push_back({file, png_of(data, 16, [&](auto x, auto y, auto channel) {
                                    const double value = data.texel(x, y, channel);
                                    return std::round((value - declared.low) / declared.span * 65535);
                                })});
    }
    out_.line("#declare {} = function {{ pigment {{ image_map {{ png {} gamma {}{} }} }} }}", declared.name,
              quote(Language::sdl, file), keeps_codes && image.is_srgb ? "srgb" : "1.0",
              data.filter == runtime::Filter::bilinear ? " interpolate 2" : "");
    return declared;
}

} // namespace scc::compiler
