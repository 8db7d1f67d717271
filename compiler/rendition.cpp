#include "compiler/rendition.h"

#include <fmt/core.h>

#include <utility>

namespace scc::compiler {

using lang::Scalar;
using lang::ScalarOp;
using lang::Spectrum;
using lang::spectrum_size;
using lang::Triple;

namespace {

/// Of a light's spectrum, its red, green and blue.
std::array<Spectrum, 3> rec709_weights() {
    std::array<Spectrum, 3> weights{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                weights[row][i] += lang::rec709_from_xyz[row][k] * lang::xyz_weights()[k][i];
            }
        }
    }
    return weights;
}

double dot(const Spectrum& a, const Spectrum& b) {
    double sum = 0;
    for (std::size_t i = 0; i < spectrum_size; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

} // namespace

Rendition Rendition::rec709(const Spectrum& illuminant) {
    Rendition result;
    result.light_.spectrum = rec709_weights();
    const bool is_daylight = illuminant == *lang::find_illuminant("d65");
    if (!is_daylight) {
        result.light_.plain.emplace();
    }
    for (std::size_t row = 0; row < 3; ++row) {
        Spectrum& seen = result.surface_.spectrum[row];
        const double white = dot(result.light_.spectrum[row], illuminant);
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            seen[i] = result.light_.spectrum[row][i] * illuminant[i] / white;
        }
        for (std::size_t k = 0; k < 3 && !is_daylight; ++k) {
            (*result.light_.plain)[row][k] = white * dot(seen, lang::rec709_reflectances()[k]);
        }
        result.to_rec709_[row][row] = 1;
    }
    return result;
}

std::vector<Rendition> Rendition::bands(const Spectrum& illuminant) {
    static_assert(spectrum_size % 3 == 0);
    const std::array<Spectrum, 3> weights = rec709_weights();
    const std::array<Spectrum, 3>& basis = lang::rec709_reflectances();
    std::vector<Rendition> groups;
    for (std::size_t first = 0; first < spectrum_size; first += 3) {
        Rendition& group = groups.emplace_back();
        group.name_ = fmt::format("{} to {} nm", lang::wavelength(first), lang::wavelength(first + 2));
        group.surface_.plain.emplace();
        group.light_.plain.emplace();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = first + k;
            group.surface_.spectrum[k][i] = group.light_.spectrum[k][i] = 1;
            for (std::size_t c = 0; c < 3; ++c) {
                (*group.surface_.plain)[k][c] = basis[c][i];
                (*group.light_.plain)[k][c] = basis[c][i] * illuminant[i];
                group.to_rec709_[c][k] = weights[c][i];
            }
        }
    }
    return groups;
}

std::array<Scalar, 3> Rendition::rendered(lang::ScalarMath& math, const lang::Components& color,
                                          ColorRole role) const {
    const Weights& weights = role == ColorRole::surface ? surface_ : light_;
    std::array<Scalar, 3> result = weights.plain ? lang::transformed(math, *weights.plain, color).v : color.v;
    if (color.spectral) {
        for (const lang::SpectralTerm& term : *color.spectral) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Scalar part =
                    math.apply(ScalarOp::mul, term.factor, {dot(weights.spectrum[k], *term.spectrum)});
                result[k] = math.apply(ScalarOp::add, result[k], part);
            }
        }
    }
    return result;
}

runtime::Rgb<double> Rendition::rendered(const lang::Value& color, ColorRole role) const {
    lang::ScalarMath math;
    const auto v = rendered(math, lang::components(color), role);
    return {v[0].value, v[1].value, v[2].value};
}

} // namespace scc::compiler
