#pragma once

#include "lang/colorimetry.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Spectral distributions under the CIE 1931 2-degree observer (L16).
namespace scc::lang {

inline constexpr std::size_t spectrum_size = 81;
inline constexpr double first_wavelength = 380; ///< nm
inline constexpr double wavelength_step = 5;

/// What a light sends, or the part of it that a surface sends back, at 380, 385, ... 780 nm.
using Spectrum = std::array<double, spectrum_size>;

constexpr double wavelength(std::size_t i) {
    return first_wavelength + wavelength_step * static_cast<double>(i);
}

/// Straight lines between the points (wavelength in nm, ascending, and value; at least one), level beyond the
/// first and the last. Where points lie closer than the samples, a sample is the mean under the hat that
/// reaches to its neighbours, so that no line, however narrow, is lost.
Spectrum sampled(std::span<const std::array<double, 2>> points);

/// The weights by which a light's spectrum gives X, Y and Z: those of equal energy, 1 everywhere, has Y = 1.
const std::array<Spectrum, 3>& xyz_weights();
Triple xyz_of_light(const Spectrum& light);

/// CIE standard illuminants "a", "d65" (CIE 15:2004) and "e", scaled to Y = 1; null for another name.
const Spectrum* find_illuminant(std::string_view name);
std::vector<std::string_view> illuminant_names();

/// What a polished metal mirrors of light that falls on it straight, from its refractive index n + ik.
std::optional<Spectrum> metal_reflectance(std::string_view name);
std::vector<std::string_view> metal_names();

/// The reflectances of Rec.709's red, green and blue: under D65 their sum with weights r, g, b has the colour
/// (r, g, b). None is below 0, and together they are 1 within 3e-4 (the smoothest reflectance that looks
/// exactly white); among all such, those with the least sum of squared steps from sample to sample. The
/// problem is that of I. Mallett and C. Yuksel, Spectral primary decomposition for rendering with sRGB
/// reflectance, EGSR 2019.
const std::array<Spectrum, 3>& rec709_reflectances();

} // namespace scc::lang
