#pragma once

#include "runtime/image.h"

#include <array>

/// Measures that follow the eye rather than the numbers. Colours are linear Rec.709, clamped to 0..1 (NaN:
/// 0).
namespace scc::validation {

using Lab = std::array<double, 3>;

/// The sRGB curve (IEC 61966-2-1) of one linear value in 0..1.
double encode_srgb(double linear);

/// CIE L*a*b* under D65.
Lab lab_from_linear(const float* rgb);

/// The CIEDE2000 colour difference with k_L = k_C = k_H = 1; 1 is about what can just be seen.
/// G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 color-difference formula", Color Research & Application 30
/// (2005).
double delta_e_2000(const Lab& a, const Lab& b);

/// Mean structural similarity of the sRGB-encoded luminance: 11 x 11 Gaussian window of sigma 1.5, K1 = 0.01,
/// K2 = 0.03, L = 1, the window renormalised at the border. Same sizes, three channels. 1 for identical
/// images. Z. Wang et al., "Image quality assessment: from error visibility to structural similarity", IEEE
/// TIP 13 (2004).
double ssim(const runtime::Image& a, const runtime::Image& b);

} // namespace scc::validation
