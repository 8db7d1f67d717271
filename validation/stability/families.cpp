#include "validation/stability/families.h"

#include "validation/stability/case_texts.h"

#include <algorithm>

namespace scc::validation {

namespace {

constexpr auto neutral = Reference::neutral;
constexpr auto formula = Reference::formula;
constexpr std::string_view none;
constexpr std::string_view rounding = "the rounding of coordinates";
constexpr std::string_view everyone = "pov,blender";

constexpr Family table[] = {
    {"offset", "offset", "distance from the origin", 0, 12, neutral, everyone, 12, none},
    {"scale_down", "scale", "size of the scene, down", 0, -12, neutral, everyone, -12, none},
    {"scale_up", "scale", "size of the scene, up", 0, 12, neutral, everyone, 12, none},
    {"distance", "distance", "distance of the camera, parallel projection", 1, 15, neutral, everyone, 11,
     rounding},
    {"cylinder_afar", "cylinder_afar", "distance from cylinders and cones", 1, 15, neutral, everyone, 11,
     rounding},
    {"shininess", "shininess", "shininess", 0, 8, formula, everyone, 8, none},
    {"gap", "gap", "gap between two faces", -1, -15, formula, everyone, -15, none},
    {"film", "film", "thickness of what a cut leaves of a box", -1, -15, formula, "pov", -13,
     "the ends of the two boxes are told apart along the ray, whose rounding is 1e-15 times its length"},
    {"stretch", "stretch", "condition of a transform, along the view", 0, 14, neutral, everyone, 14, none},
    {"squash", "stretch", "condition of a transform, the other way", 0, -14, neutral, everyone, -14, none},
    {"sliver", "sliver", "height of a sliver of 4", -1, -15, formula, everyone, -15, none},
    {"torus", "torus", "minor to major radius of a torus", 0, -6, formula, everyone, -6, none},
    {"implicit_flat", "implicit_gradient", "gradient of an implicit surface, down", 0, -12, neutral, "pov",
     -12, none},
    {"implicit_steep", "implicit_gradient", "gradient of an implicit surface, up", 0, 12, neutral, "pov", 12,
     none},
    {"grazing", "grazing", "angle between view and surface", 0, -9, neutral, everyone, -9, none},
    {"huge", "huge", "radius of a ball that casts shadows and mirrors", 6, 15, formula, everyone, 11,
     rounding},
    {"near", "near", "near plane of a raster picture", -1, -15, formula, none, -13,
     "the depth buffer keeps the digits of double for 1 / depth"},
    {"depth_gap", "depth_gap", "gap between two plates in a raster picture", -3, -15, neutral, none, -13,
     "the depth buffer keeps the digits of double for 1 / depth"},
    {"attenuation_down", "attenuation", "factor of a light's attenuation, down", 0, -12, neutral, everyone,
     -12, none},
    {"attenuation_up", "attenuation", "factor of a light's attenuation, up", 0, 12, neutral, everyone, 12,
     none},
    {"up", "up", "angle between up and view", 0, -15, neutral, everyone, -12,
     "below, the front end takes the camera for one without a frame"},
    {"contact", "contact", "distance of the eye from surfaces behind it", 0, -15, neutral, everyone, -15,
     none},
    {"quadric", "quadric", "curvature of a quadric that becomes a cylinder", -6, -18, formula, "pov", -18,
     none},
    {"cone_apex", "cone_apex", "difference of a cone's radii", -6, -16, formula, everyone, -16, none},
    {"tunnel", "tunnel", "reflections in a mirror tunnel, over 2.56", 0, 2, formula, everyone, 2, none},
    {"size_ratio", "size_ratio", "how much larger a ball behind is", 1, 15, neutral, everyone, 15, none},
    {"shear", "shear", "condition of a shear", 0, 14, neutral, everyone, 14, none},
    {"torus_afar", "torus_afar", "distance from tori", 1, 15, neutral, everyone, 11, rounding},
    {"bricks", "bricks", "length of needles in a wall of T-junctions", 0, 15, formula, everyone, 12,
     "beyond, what is seen of a needle's area is less than the rounding of its edges' products"},
    {"tiny", "tiny", "size of mirrors in a hall of 1e6", -1, -15, neutral, everyone, -15, none},
    {"concave", "concave", "distance of a light from the wall of a ball, within", -1, -15, formula, everyone,
     -15, none},
    {"implicit_order", "implicit_order", "10^((n - 1) / 2), n the order of a field's zeros", 0, 8, formula,
     none, 8, none},
    {"implicit_pole", "implicit_pole", "distance of a field's pole from the real numbers", 0, -12, formula,
     none, -12, none},
    {"spectral_line", "spectral_line", "width of a spectral line in nm", -1, -12, neutral, none, -9,
     "at 589.5 nm double tells wavelengths 1e-13 apart"},
    {"inside", "inside", "distance of the eye from a wall that it looks along, within a ball", -8, -16,
     neutral, everyone, -16, none},
    {"outside", "outside", "distance of the eye from a ball that it looks along", -8, -16, formula, everyone,
     -15, "the eye's distance from the ball's centre is 1 and a little"},
    {"instances", "instances", "number of balls", 0, 7, formula, none, 7, none},
    {"nested", "nested", "bodies of glass in each other", 0, 2, neutral, "pov", 2, none},
};

} // namespace

std::span<const Family> families() {
    return table;
}

const Family* find_family(std::string_view name) {
    const auto* const found =
        std::find_if(std::begin(table), std::end(table), [&](const Family& row) { return row.name == name; });
    return found == std::end(table) ? nullptr : found;
}

std::string_view scene_text(std::string_view scene) {
    for (const CaseText& one : case_texts) {
        if (one.scene == scene) {
            return one.text;
        }
    }
    return {};
}

} // namespace scc::validation
