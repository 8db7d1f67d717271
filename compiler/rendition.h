#pragma once

#include "compiler/function_builder.h"
#include "lang/components.h"
#include "lang/spectrum.h"
#include "runtime/math/vec.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace scc::compiler {

enum class ColorRole {
    surface, ///< the part of light that a surface sends back
    light    ///< light itself: a plain colour stands for the world's illuminant, coloured
};

/// By which three numbers colours are drawn: Rec.709's red, green and blue, or the values at three of the
/// wavelengths of a spectrum.
class Rendition {
public:
    /// Exact for plain colours; of a spectrum's surface, how it looks under the illuminant, white being 1.
    static Rendition rec709(const lang::Spectrum& illuminant);
    /// All wavelengths, in groups of three.
    static std::vector<Rendition> bands(const lang::Spectrum& illuminant);

    /// Of a known colour.
    runtime::Rgb<double> rendered(const lang::Value& color, ColorRole role) const;
    std::array<lang::Scalar, 3> rendered(lang::ScalarMath& math, const lang::Components& color,
                                         ColorRole role) const;

    const std::string& name() const { return name_; }
    /// Rows: what red, green and blue get of each of the three.
    const std::array<lang::Triple, 3>& to_rec709() const { return to_rec709_; }

private:
    struct Weights {
        std::optional<std::array<lang::Triple, 3>>
            plain; ///< rows, for a plain colour; nothing: taken as it is
        std::array<lang::Spectrum, 3> spectrum{};
    };

    Weights surface_, light_;
    std::array<lang::Triple, 3> to_rec709_{};
    std::string name_;
};

} // namespace scc::compiler
