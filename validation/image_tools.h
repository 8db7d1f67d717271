#pragma once

#include "runtime/image.h"

#include <stdexcept>
#include <vector>

namespace scc::validation {

/// The pictures cannot be compared: different sizes, no pixels.
struct CompareError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// True (1) for the pixels whose 3x3 neighbourhood departs from a plane by more than `contrast` (largest
/// minus smallest residual of the least-squares plane, in any channel), and for the eight neighbours of
/// these. A step of height h between two pixels departs by h/2, an even slope, however steep, by nothing, a
/// shading of curvature k per pixel^2 by about k/2. Pixels that are not finite are edges.
std::vector<unsigned char> edge_mask(const runtime::Image& image, double contrast);

/// A grey image as three equal channels, a colour image as it is. Throws CompareError for other numbers of
/// channels.
runtime::Image in_color(const runtime::Image& image);

/// |other - reference| * amplification, per channel.
runtime::Image difference_image(const runtime::Image& reference, const runtime::Image& other,
                                double amplification);

/// Each pixel the average of n x n: what a regular grid of n x n samples with a box filter gives, made from
/// an image drawn n times larger. Throws CompareError if n does not divide the size.
runtime::Image box_average(const runtime::Image& image, int n);

} // namespace scc::validation
