#include "validation/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace scc::validation {
namespace {

using runtime::Image;

constexpr double normal_edge_contrast = 0.05;

/// Pixels whose surroundings are one surface, in our layers: neighbours are of the same object and their
/// normals follow each other.
std::vector<unsigned char> insides(const Layers& layers) {
    std::vector<unsigned char> mask = edge_mask(layers.normal, normal_edge_contrast);
    const std::vector<unsigned char> borders = layers.object.pixels.empty()
                                                   ? std::vector<unsigned char>(mask.size())
                                                   : edge_mask(layers.object, 0.25);
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask[i] = mask[i] == 0 && borders[i] == 0 ? 1 : 0;
    return mask;
}

bool meets(const Layers& layers, int x, int y) {
    return layers.object.pixels.empty() || layers.object.at(x, y)[0] != 0.0F;
}

double distance(const float* a, const float* b) {
    double squares = 0;
    for (int i = 0; i < 3; ++i)
        squares += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
    return std::sqrt(squares);
}

double depth_of(const float* position, const std::array<double, 3>& eye) {
    return std::hypot(static_cast<double>(position[0]) - eye[0], static_cast<double>(position[1]) - eye[1],
                      static_cast<double>(position[2]) - eye[2]);
}

/// The diagonal of the box around what is seen.
double extent(const Layers& layers) {
    std::array<double, 3> low{INFINITY, INFINITY, INFINITY};
    std::array<double, 3> high{-INFINITY, -INFINITY, -INFINITY};
    for (int y = 0; y < layers.position.height; ++y)
        for (int x = 0; x < layers.position.width; ++x)
            for (std::size_t i = 0; meets(layers, x, y) && i < 3; ++i) {
                const auto value = static_cast<double>(layers.position.at(x, y)[i]);
                low[i] = std::min(low[i], value);
                high[i] = std::max(high[i], value);
            }
    const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    return std::isfinite(diagonal) ? diagonal : 0;
}

LayerDifference compare_objects(const Layers& ours, const Layers& theirs) {
    LayerDifference result{.layer = "object", .unit = "pixels"};
    for (int y = 0; y < ours.object.height; ++y)
        for (int x = 0; x < ours.object.width; ++x) {
            ++result.compared;
            if (ours.object.at(x, y)[0] == theirs.object.at(x, y)[0])
                continue;
            if (result.pixels++ == 0) {
                result.x = x;
                result.y = y;
            }
        }
    result.largest = static_cast<double>(result.pixels);
    return result;
}

using PixelError = std::function<double(int x, int y)>;

LayerDifference compare_inside(LayerDifference result, const Layers& ours, const Layers& theirs,
                               const std::vector<unsigned char>& inside, const PixelError& error_at) {
    std::size_t pixel = 0;
    for (int y = 0; y < ours.position.height; ++y)
        for (int x = 0; x < ours.position.width; ++x, ++pixel) {
            const bool same = meets(ours, x, y) && (ours.object.pixels.empty() ||
                                                    ours.object.at(x, y)[0] == theirs.object.at(x, y)[0]);
            if (inside[pixel] == 0 || !same)
                continue;
            ++result.compared;
            const double error = error_at(x, y);
            result.pixels += !(error <= result.tolerance);
            if (error > result.largest) {
                result.largest = error;
                result.x = x;
                result.y = y;
            }
        }
    return result;
}

} // namespace

LayerTolerances layer_tolerances(const std::string& renderer) {
    return renderer == "pov" ? LayerTolerances{4e-5, 2e-4} : LayerTolerances{5e-4, 5e-3};
}

std::vector<LayerDifference> compare_layers(const Layers& ours, const Layers& theirs,
                                            const std::array<double, 3>& eye,
                                            const LayerTolerances& tolerances) {
    const std::vector<unsigned char> inside = insides(ours);
    const double length = tolerances.position * extent(ours);
    std::vector<LayerDifference> result;
    if (!ours.object.pixels.empty())
        result.push_back(compare_objects(ours, theirs));
    result.push_back(compare_inside({.layer = "depth", .unit = "world units", .tolerance = length}, ours,
                                    theirs, inside, [&](int x, int y) {
                                        return std::abs(depth_of(ours.position.at(x, y), eye) -
                                                        depth_of(theirs.position.at(x, y), eye));
                                    }));
    result.push_back(compare_inside(
        {.layer = "position", .unit = "world units", .tolerance = length}, ours, theirs, inside,
        [&](int x, int y) { return distance(ours.position.at(x, y), theirs.position.at(x, y)); }));
    result.push_back(
        compare_inside({.layer = "normal", .unit = "1", .tolerance = tolerances.normal}, ours, theirs, inside,
                       [&](int x, int y) { return distance(ours.normal.at(x, y), theirs.normal.at(x, y)); }));
    return result;
}

bool differs(const LayerDifference& difference) {
    constexpr double share = 1e-3;
    constexpr std::size_t few = 5;
    return difference.pixels >
           few + static_cast<std::size_t>(share * static_cast<double>(difference.compared));
}

nlohmann::ordered_json to_json(const LayerDifference& d) {
    return {{"layer", d.layer}, {"unit", d.unit},     {"tolerance", d.tolerance}, {"largest", d.largest},
            {"at", {d.x, d.y}}, {"pixels", d.pixels}, {"compared", d.compared},   {"differs", differs(d)}};
}

} // namespace scc::validation
