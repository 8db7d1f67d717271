#pragma once

#include "runtime/image.h"
#include "runtime/math/vec.h"
#include "runtime/render_request.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

/// Scenes with spectra (L16): three wavelengths at a time are drawn as if they were red, green and blue. Rays
/// go the same way for all of them.
namespace scc::runtime {

/// What three wavelengths have of their own, beside the colours of materials and lights.
template <class R>
struct BandGroup {
    Rgb<R> ambient{};
    Rgb<R> background{};
    Rgb<double> red{}, green{}, blue{}; ///< what each wavelength adds to them (Rec.709)

    friend constexpr bool operator==(const BandGroup&, const BandGroup&) = default;
};

/// A group's rows of a table that holds those of all groups.
template <class T, class Rows>
void take_rows(std::span<const T> all, std::size_t group, std::size_t groups, Rows& rows) {
    const std::span<const T> own = all.subspan(group * (all.size() / groups), all.size() / groups);
    if constexpr (requires { rows = own; }) {
        rows = own;
    } else {
        std::copy(own.begin(), own.end(), rows.begin());
    }
}

/// The sum of the groups' pictures in Rec.709. `render_group(group's index, request, image)` draws one.
template <class R, class RenderGroup>
RenderResult render_bands(const std::span<const BandGroup<R>>& groups, const RenderRequest& request, Image& image,
                          RenderGroup&& render_group) {
    std::vector<double> sum(image.pixels.size());
    Image part(image.width, image.height);
    RenderResult total;
    for (std::size_t g = 0; g < groups.size() && total.complete; ++g) {
        RenderRequest one = request;
        if (request.progress) {
            one.progress = [&](double done) {
                return request.progress((static_cast<double>(g) + done) / static_cast<double>(groups.size()));
            };
        }
        const RenderResult result = render_group(g, one, part);
        total.rays += result.rays;
        total.complete = result.complete;
        const BandGroup<R>& to = groups[g];
        for (std::size_t i = 0; i < sum.size(); i += 3) {
            const Rgb<double> seen{part.pixels[i], part.pixels[i + 1], part.pixels[i + 2]};
            const auto add = [&](std::size_t k, const Rgb<double>& weights) {
                sum[i + k] += weights.r * seen.r + weights.g * seen.g + weights.b * seen.b;
            };
            add(0, to.red);
            add(1, to.green);
            add(2, to.blue);
        }
    }
    std::transform(sum.begin(), sum.end(), image.pixels.begin(),
                   [](double v) { return static_cast<float>(v); });
    return total;
}

} // namespace scc::runtime
