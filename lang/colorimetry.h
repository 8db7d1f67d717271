#pragma once

#include <array>

/// Colours by measurement: CIE 1931 2-degree observer, linear light with the primaries and white of Rec.709.
namespace scc::lang {

using Triple = std::array<double, 3>;

/// Row by row, from the primaries (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) and the white (0.3127, 0.3290) of
/// ITU-R BT.709.
inline constexpr std::array<Triple, 3> xyz_from_rec709{{
    {0.4123907992659595, 0.35758433938387796, 0.1804807884018343},
    {0.21263900587151036, 0.7151686787677559, 0.07219231536073371},
    {0.01933081871559185, 0.11919477979462599, 0.9505321522496606},
}};
/// Its inverse.
inline constexpr std::array<Triple, 3> rec709_from_xyz{{
    {3.2409699419045213, -1.5373831775700935, -0.4986107602930033},
    {-0.9692436362808798, 1.8759675015077206, 0.04155505740717561},
    {0.05563007969699361, -0.20397695888897657, 1.0569715142428786},
}};

/// CIE XYZ of a black body of this temperature, in kelvin and greater than 0, scaled to Y = 1: Planck's law
/// under the observer, summed over 380 to 780 nm in steps of 5 nm.
Triple blackbody_xyz(double kelvin);

} // namespace scc::lang
