#include "runtime/host/image_file.h"

#include "runtime/host/exr.h"
#include "runtime/host/png.h"

#include <bit>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace scc::host {
namespace {

using runtime::Image;

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

/// Rows from the bottom; a negative scale says little-endian.
std::string encode_pfm(const Image& image) {
    const char* scale = std::endian::native == std::endian::little ? "-1.0" : "1.0";
    std::string bytes = std::string(image.channels == 1 ? "Pf" : "PF") + "\n" + std::to_string(image.width) +
                        " " + std::to_string(image.height) + "\n" + scale + "\n";
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    bytes.reserve(bytes.size() + image.pixels.size() * sizeof(float));
    for (int y = image.height - 1; y >= 0; --y)
        bytes.append(reinterpret_cast<const char*>(image.at(0, y)), row * sizeof(float));
    return bytes;
}

void check_writable(const Image& image) {
    const std::size_t values = static_cast<std::size_t>(image.width) *
                               static_cast<std::size_t>(image.height) *
                               static_cast<std::size_t>(image.channels);
    if (image.width < 1 || image.height < 1 || image.pixels.size() != values)
        throw std::invalid_argument("an image of " + std::to_string(image.width) + " x " +
                                    std::to_string(image.height) + " pixels with " +
                                    std::to_string(image.pixels.size()) + " values cannot be written");
    if (image.channels != 1 && image.channels != 3)
        throw std::invalid_argument("an image file has 1 or 3 channels, this image has " +
                                    std::to_string(image.channels));
}

} // namespace

bool is_image_type_known(const std::string& path) {
    return type_of(path) != FileType::unknown;
}

bool keeps_8_bits(const std::string& path, int bits) {
    return type_of(path) == FileType::png && bits == 8;
}

bool has_layers(const std::string& path) {
    return type_of(path) == FileType::exr;
}

void write_image(const std::string& path, const Image& image, const ImageFileOptions& options) {
    check_writable(image);
    switch (type_of(path)) {
    case FileType::exr:
        return replace_file(path, encode_exr(image, options.compact, options.threads));
    case FileType::png:
        return replace_file(path, encode_png(image, options.bits, options.threads));
    case FileType::pfm:
        return replace_file(path, encode_pfm(image));
    case FileType::unknown:
        break;
    }
    throw std::invalid_argument("image type of `" + path +
                                "` is unknown; the choices are .exr, .png and .pfm");
}

} // namespace scc::host
