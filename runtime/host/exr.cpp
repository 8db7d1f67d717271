#include "runtime/host/exr.h"

#include "runtime/host/deflate.h"
#include "runtime/host/parallel.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

static_assert(std::endian::native == std::endian::little,
              "the file's numbers are written as they lie in memory");

namespace scc::host {

namespace {

using runtime::Image;

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void attribute(std::string& bytes, std::string_view name, std::string_view type, const std::string& value) {
    bytes += name;
    bytes += '\0';
    bytes += type;
    bytes += '\0';
    append(bytes, static_cast<std::int32_t>(value.size()));
    bytes += value;
}

std::string channel_list(const ExrContent& content) {
    std::string list;
    for (const ExrChannel& channel : content.channels) {
        list += channel.name;
        list += '\0';
        append(list, std::int32_t{channel.is_whole ? 0 : 2}); // else 32-bit float
        append(list, std::int32_t{0});                        // not perceptually linear
        append(list, std::int32_t{1});                        // every column
        append(list, std::int32_t{1});                        // and row
    }
    return list + '\0';
}

template <class... T>
std::string values(T... value) {
    std::string bytes;
    (append(bytes, value), ...);
    return bytes;
}

std::string header(const ExrContent& content, bool compact) {
    std::string bytes = values(std::uint32_t{20000630}, std::uint32_t{2});
    const std::string window = values(0, 0, content.width - 1, content.height - 1);
    attribute(bytes, "channels", "chlist", channel_list(content));
    attribute(bytes, "compression", "compression", std::string(1, compact ? char{3} : char{0}));
    attribute(bytes, "dataWindow", "box2i", window);
    attribute(bytes, "displayWindow", "box2i", window);
    attribute(bytes, "lineOrder", "lineOrder", std::string(1, char{0}));
    attribute(bytes, "pixelAspectRatio", "float", values(1.0F));
    attribute(bytes, "screenWindowCenter", "v2f", values(0.0F, 0.0F));
    attribute(bytes, "screenWindowWidth", "float", values(1.0F));
    for (const auto& [name, text] : content.texts) {
        attribute(bytes, name, "string", text);
    }
    return bytes + '\0';
}

/// Channel after channel in each row.
std::string planar_rows(const ExrContent& content, int first, int end) {
    constexpr std::size_t size = sizeof(float);
    static_assert(size == sizeof(std::uint32_t));
    const auto width = static_cast<std::size_t>(content.width);
    std::string bytes;
    bytes.resize(static_cast<std::size_t>(end - first) * width * content.channels.size() * size);
    char* to = bytes.data();
    for (int y = first; y < end; ++y) {
        for (const ExrChannel& channel : content.channels) {
            const char* from = static_cast<const char*>(channel.values) +
                               static_cast<std::size_t>(y) * width * channel.step * size;
            for (std::size_t x = 0; x < width; ++x, to += size, from += channel.step * size) {
                std::memcpy(to, from, size);
            }
        }
    }
    return bytes;
}

/// As its ZIP method wants them: first the bytes of even, then those of odd place, each as the difference
/// from the one before.
std::string zip(const std::string& rows) {
    std::string halves(rows.size(), '\0');
    const std::size_t middle = (rows.size() + 1) / 2;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        halves[i / 2 + (i % 2 == 0 ? 0 : middle)] = rows[i];
    }
    for (std::size_t i = rows.size() - 1; i > 0; --i) {
        halves[i] = static_cast<char>(halves[i] - halves[i - 1] + 128);
    }
    std::string packed = zlib_compress(halves);
    return packed.size() < rows.size() ? packed : rows; // a chunk of full size counts as not compressed
}

} // namespace

ExrContent exr_content(const Image& image) {
    const auto channels = static_cast<std::size_t>(image.channels);
    ExrContent content{image.width, image.height, {}, {}};
    for (std::size_t c = 0; c < channels; ++c) {
        content.channels.push_back(
            {channels == 1 ? "Y" : std::string(1, "RGB"[c]), image.pixels.data() + c, channels});
    }
    return content;
}

std::string encode_exr(ExrContent content, bool compact, int threads) {
    // As the format wants it.
    std::sort(content.channels.begin(), content.channels.end(),
              [](const ExrChannel& a, const ExrChannel& b) { return a.name < b.name; });
    const int rows = compact ? 16 : 1;
    const int count = (content.height + rows - 1) / rows;
    std::vector<std::string> chunks(static_cast<std::size_t>(count));
    parallel_for(count, threads, [&](int i) {
        const std::string plain = planar_rows(content, i * rows, std::min(content.height, (i + 1) * rows));
        const std::string data = compact ? zip(plain) : plain;
        chunks[static_cast<std::size_t>(i)] = values(i * rows, static_cast<std::int32_t>(data.size())) + data;
    });

    std::string file = header(content, compact);
    std::uint64_t offset = file.size() + chunks.size() * sizeof(std::uint64_t);
    for (const std::string& chunk : chunks) {
        append(file, offset);
        offset += chunk.size();
    }
    file.reserve(offset);
    for (const std::string& chunk : chunks) {
        file += chunk;
    }
    return file;
}

} // namespace scc::host
