#include "compiler/image_file.h"

#include "runtime/host/cache.h"
#include "runtime/host/read_image.h"
#include "runtime/host/srgb.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace scc::compiler {

namespace {

struct Texels {
    host::Texels file;
    std::array<float, 256> decoded{};
};

/// Of every channel, those of a grey image being equal.
void find_range(runtime::ImageData& data) {
    data.min.fill(data.texel(0, 0, 0));
    data.max = data.min;
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
        data.min[channel] = data.max[channel] = data.texel(0, 0, channel);
        for (std::uint32_t y = 0; y < data.height; ++y) {
            for (std::uint32_t x = 0; x < data.width; ++x) {
                const float value = data.texel(x, y, channel);
                data.min[channel] = std::min(data.min[channel], value);
                data.max[channel] = std::max(data.max[channel], value);
            }
        }
    }
}

template <class T>
std::string_view bytes_of(const T& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data())};
}

} // namespace

LoadedImage load_image(const std::filesystem::path& path, ImageEncoding encoding, runtime::Wrap wrap,
                       runtime::Filter filter) {
    const auto texels = std::make_shared<Texels>();
    const bool is_srgb = encoding == ImageEncoding::srgb;
    const std::string wrong = host::read_texels(path.string(), !is_srgb, largest_image, texels->file);
    if (!wrong.empty()) {
        throw ImageError(wrong);
    }
    const host::Texels& file = texels->file;
    const auto is_number = [](float value) { return std::isfinite(value); };
    if (!std::all_of(file.values.begin(), file.values.end(), is_number)) {
        throw ImageError("it has a value that is not a finite number");
    }
    for (std::size_t code = 0; code < texels->decoded.size(); ++code) {
        const double value = static_cast<double>(code) / 255;
        texels->decoded[code] = static_cast<float>(is_srgb ? host::decode_srgb(value) : value);
    }
    LoadedImage loaded;
    loaded.holds_floats = file.holds_floats;
    ir::Image& image = loaded.image;
    image.name = path.stem().string();
    image.is_srgb = is_srgb;
    runtime::ImageData& data = image.data;
    data.codes = file.codes.empty() ? nullptr : file.codes.data();
    data.values = file.values.empty() ? nullptr : file.values.data();
    data.decoded = texels->decoded.data();
    data.width = static_cast<std::uint32_t>(file.width);
    data.height = static_cast<std::uint32_t>(file.height);
    data.channels = static_cast<std::uint32_t>(file.channels);
    data.wrap = wrap;
    data.filter = filter;
    find_range(data);
    image.key = host::cache_key({bytes_of(file.codes), bytes_of(file.values),
                                 fmt::format("{} {} {} {} {}", data.width, data.channels, is_srgb,
                                             static_cast<int>(wrap), static_cast<int>(filter))});
    image.owner = texels;
    return loaded;
}

} // namespace scc::compiler
