#pragma once

#include "compiler/backends/pov_function.h"
#include "compiler/writer.h"

#include <string>
#include <vector>

namespace scc::compiler {

/// L7, L9, L15 and transparency with every field constant or a paint.
struct PaintedPhong {
    Paint ambient, diffuse, specular, emission, reflect, transmit, shininess;
    std::string normal;   ///< the block that tilts it; empty: none does
    bool fresnel = false; ///< of glass, which is without a colour of its own
};

/// Whether the highlight of a transparent surface can be written: POV-Ray colours one by a layer that filters
/// what is seen through the surface as well, which the layer below can make up for if it is constant.
bool has_writable_highlight(const PaintedPhong& phong);

/// Declares textures that are exactly a Phong material, with the fewest layers that can be.
class PovTextures {
public:
    explicit PovTextures(Writer& out) : out_(out) {}

    /// Returns the identifier of the texture. What has to be said of a varying shininess goes to `shininess`.
    std::string declare(const std::string& name, const PaintedPhong& phong, Outcome& shininess);

private:
    struct Stops {
        double low, high;
        int steps;
    };
    std::string declare_varying(const std::string& name, const PaintedPhong& phong,
                                Paint PaintedPhong::*field, Outcome& shininess);
    std::string declare_varying_shininess(const std::string& name, const PaintedPhong& phong,
                                          Outcome& shininess);
    std::string declare_stops(const std::string& name, const PaintedPhong& phong, const Stops& stops);
    std::string declare_blend(const std::string& name, const std::string& t,
                              const std::vector<std::string>& textures);
    std::string declare_layers(const std::string& name, const PaintedPhong& phong);

    Writer& out_;
    Identifiers names_{"m_"};
};

} // namespace scc::compiler
