#include "lang/colorimetry.h"

#include "lang/spectrum.h"

#include <cmath>
#include <cstddef>

namespace scc::lang {
namespace {

/// Colour-matching functions of the CIE 1931 standard colorimetric observer, 380 to 780 nm, as tabulated in
/// CIE 15:2004, table T.4.
constexpr std::array<Triple, spectrum_size> observer{{
    {0.001368, 3.9e-05, 0.00645}, {0.002236, 6.4e-05, 0.01055}, {0.004243, 0.00012, 0.02005},
    {0.00765, 0.000217, 0.03621}, {0.01431, 0.000396, 0.06785}, {0.02319, 0.00064, 0.1102},
    {0.04351, 0.00121, 0.2074},   {0.07763, 0.00218, 0.3713},   {0.13438, 0.004, 0.6456},
    {0.21477, 0.0073, 1.03905},   {0.2839, 0.0116, 1.3856},     {0.3285, 0.01684, 1.62296},
    {0.34828, 0.023, 1.74706},    {0.34806, 0.0298, 1.7826},    {0.3362, 0.038, 1.77211},
    {0.3187, 0.048, 1.7441},      {0.2908, 0.06, 1.6692},       {0.2511, 0.0739, 1.5281},
    {0.19536, 0.09098, 1.28764},  {0.1421, 0.1126, 1.0419},     {0.09564, 0.13902, 0.81295},
    {0.05795, 0.1693, 0.6162},    {0.03201, 0.20802, 0.46518},  {0.0147, 0.2586, 0.3533},
    {0.0049, 0.323, 0.272},       {0.0024, 0.4073, 0.2123},     {0.0093, 0.503, 0.1582},
    {0.0291, 0.6082, 0.1117},     {0.06327, 0.71, 0.07825},     {0.1096, 0.7932, 0.05725},
    {0.1655, 0.862, 0.04216},     {0.22575, 0.91485, 0.02984},  {0.2904, 0.954, 0.0203},
    {0.3597, 0.9803, 0.0134},     {0.43345, 0.99495, 0.00875},  {0.51205, 1.0, 0.00575},
    {0.5945, 0.995, 0.0039},      {0.6784, 0.9786, 0.00275},    {0.7621, 0.952, 0.0021},
    {0.8425, 0.9154, 0.0018},     {0.9163, 0.87, 0.00165},      {0.9786, 0.8163, 0.0014},
    {1.0263, 0.757, 0.0011},      {1.0567, 0.6949, 0.001},      {1.0622, 0.631, 0.0008},
    {1.0456, 0.5668, 0.0006},     {1.0026, 0.503, 0.00034},     {0.9384, 0.4412, 0.00024},
    {0.85445, 0.381, 0.00019},    {0.7514, 0.321, 0.0001},      {0.6424, 0.265, 5e-05},
    {0.5419, 0.217, 3e-05},       {0.4479, 0.175, 2e-05},       {0.3608, 0.1382, 1e-05},
    {0.2835, 0.107, 0.0},         {0.2187, 0.0816, 0.0},        {0.1649, 0.061, 0.0},
    {0.1212, 0.04458, 0.0},       {0.0874, 0.032, 0.0},         {0.0636, 0.0232, 0.0},
    {0.04677, 0.017, 0.0},        {0.0329, 0.01192, 0.0},       {0.0227, 0.00821, 0.0},
    {0.01584, 0.005723, 0.0},     {0.011359, 0.004102, 0.0},    {0.008111, 0.002929, 0.0},
    {0.00579, 0.002091, 0.0},     {0.004109, 0.001484, 0.0},    {0.002899, 0.001047, 0.0},
    {0.002049, 0.00074, 0.0},     {0.00144, 0.00052, 0.0},      {0.001, 0.000361, 0.0},
    {0.00069, 0.000249, 0.0},     {0.000476, 0.000172, 0.0},    {0.000332, 0.00012, 0.0},
    {0.000235, 8.5e-05, 0.0},     {0.000166, 6e-05, 0.0},       {0.000117, 4.2e-05, 0.0},
    {8.3e-05, 3e-05, 0.0},        {5.9e-05, 2.1e-05, 0.0},      {4.2e-05, 1.5e-05, 0.0},
}};

/// Spectral radiance by Planck's law, relative to that at the longest wavelength: so it neither overflows nor
/// vanishes, however cold or hot the body is.
double relative_radiance(double nm, double kelvin) {
    constexpr double c2 = 1.438776877e7; // h c / k, in nm K (SI 2019)
    constexpr double longest = wavelength(observer.size() - 1);
    const double x = c2 / (nm * kelvin);
    const double x_longest = c2 / (longest * kelvin);
    const double ratio = longest / nm;
    return std::pow(ratio, 5) * std::exp(x_longest - x) * std::expm1(-x_longest) / std::expm1(-x);
}

} // namespace

Triple blackbody_xyz(double kelvin) {
    Triple sum{};
    for (std::size_t i = 0; i < observer.size(); ++i) {
        const double radiance = relative_radiance(wavelength(i), kelvin);
        for (std::size_t k = 0; k < 3; ++k) {
            sum[k] += radiance * observer[i][k];
        }
    }
    return {sum[0] / sum[1], 1, sum[2] / sum[1]};
}

const std::array<Spectrum, 3>& xyz_weights() {
    static const std::array<Spectrum, 3> weights = [] {
        double sum = 0;
        for (const Triple& row : observer) {
            sum += row[1];
        }
        std::array<Spectrum, 3> columns{};
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                columns[k][i] = observer[i][k] / sum;
            }
        }
        return columns;
    }();
    return weights;
}

} // namespace scc::lang
