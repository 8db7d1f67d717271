#include "validation/bench/holes.h"

#include "validation/renderers.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace scc::bench {

namespace {

constexpr std::string_view keyword = "max_gradient ";

/// Where the bound's digits begin.
std::size_t place_of_bound(const std::string& pov) {
    const std::size_t at = pov.find(keyword);
    if (at == std::string::npos) {
        throw std::runtime_error("the export has no isosurface");
    }
    return at + keyword.size();
}

} // namespace

double max_gradient_of(const std::string& pov) {
    return std::stod(pov.substr(place_of_bound(pov)));
}

std::string with_max_gradient(const std::string& pov, double bound) {
    const std::size_t begin = place_of_bound(pov), end = pov.find('\n', begin);
    return pov.substr(0, begin) + fmt::format("{}", bound) + pov.substr(end);
}

runtime::Image picture_of(const std::filesystem::path& pov, const PictureJob& job, double brightest,
                          std::string& failure) {
    validation::RenderJob one;
    one.scene = pov;
    one.folder = job.folder;
    one.width = job.width;
    one.height = job.height;
    one.threads = job.threads;
    one.brightest = brightest;
    validation::RenderResult result = validation::render_with_povray(one);
    failure = result.reason;
    return std::move(result.image);
}

runtime::Image side_by_side(const std::vector<runtime::Image>& pictures) {
    const runtime::Image& first = pictures.front();
    const auto row = static_cast<std::size_t>(first.width) * static_cast<std::size_t>(first.channels);
    runtime::Image all(first.width * static_cast<int>(pictures.size()), first.height, first.channels);
    auto out = all.pixels.begin();
    for (std::size_t y = 0; y < static_cast<std::size_t>(first.height); ++y) {
        for (const runtime::Image& picture : pictures) {
            const auto begin = picture.pixels.begin() + static_cast<std::ptrdiff_t>(y * row);
            out = std::copy_n(begin, row, out);
        }
    }
    return all;
}

} // namespace scc::bench
