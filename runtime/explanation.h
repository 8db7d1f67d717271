#pragma once

#include "runtime/math/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

/// How a sample of a pixel came about, as told by explain_pixel.h: the numbers that the renderer calculated
/// with, without loss, whatever its precision.
namespace scc::runtime {

/// How well a point solves a shape's own equation.
struct Residual {
    std::string_view terms; ///< the equation's left side; right of it is 0
    double value = 0;
};

/// A place where a ray passes through a surface.
struct Candidate {
    enum class Verdict {
        met,     ///< what is seen
        farther, ///< behind that, or as far and later in the source
        inside,  ///< of a member: the solid is on both sides
        outside  ///< of a member: the solid is on neither side
    };
    double t = 0;
    Vec3<double> point;               ///< org + t dir, world
    std::uint32_t id = 0, member = 0; ///< Tag::id of the object, and of a solid's member, else the same
    std::string_view shape;
    bool enters = false;              ///< the surface's outside is where the ray comes from
    std::optional<Residual> residual; ///< in the shape's space
    Verdict verdict = Verdict::farther;
};

/// A step of a shadow feeler: to the light, or to the first surface on the way.
struct Feeler {
    Vec3<double> org, dir;
    bool is_blocked = false;
    double t = 0;                      ///< of what blocks or filters it; a point light is at 1
    std::uint32_t id = 0;              ///< of that
    std::optional<Rgb<double>> filter; ///< what is left after it; nothing: all is held up
};

struct LightTerms {
    enum class Kind { point, directional, spot, rectangle };
    Kind kind = Kind::point;
    std::uint32_t index = 0, part = 0; ///< in the table of its kind; of a rectangle's points, row by row
    Vec3<double> to_light;             ///< s, unit
    double distance = 0;               ///< infinite for a directional light
    double cosine = 0;                 ///< s.m
    bool is_in_cone = true;            ///< of a spot light
    double attenuation = 1, cone_share = 1;
    std::vector<Feeler> feelers;
    bool reaches = false; ///< the light adds something: it is in front, and not shadowed
    Rgb<double> diffuse{};
    double highlight = 0; ///< ((h.m)/|h|)^a
    Rgb<double> specular{};
    Rgb<double> adds{}; ///< both, after attenuation, cone and filters
};

struct RayTerms {
    enum class Way { primary, mirrored, through };
    Way way = Way::primary;
    int parent = -1; ///< index of the ray at whose end it starts
    int bounces = 0;
    Vec3<double> org, dir;
    Rgb<double> weight{};
    std::vector<Candidate> candidates; ///< by t
    // Where it meets something:
    bool has_met = false;
    double t = 0;
    std::uint32_t id = 0, member = 0;
    Vec3<double> point, error, normal, shading_normal;
    bool is_front = true; ///< the side that the geometric normal points to
    std::uint32_t material = 0;
    bool is_bumped = false;
    Rgb<double> ambient, diffuse, specular, emission, reflect, transmit;
    double shininess = 0;
    std::vector<LightTerms> lights;
    Rgb<double> light{}; ///< ambient, emission and what the lights add
    /// The indices of refraction on both sides, where light goes through or Fresnel's equations decide.
    struct Refraction {
        double from = 1, to = 1;
        double reflectance = 0; ///< F; 0 where from = to
        bool is_total = false;
    };
    std::optional<Refraction> refraction;
    Rgb<double> reflected{}, transmitted{}; ///< what the weights of the rays that go on are multiplied by
    bool goes_back = false, goes_through = false; ///< whether they are followed
};

struct Explanation {
    double column = 0, row = 0; ///< in pixels from the top left corner
    std::vector<RayTerms> rays; ///< in the order in which they are followed
    Rgb<double> sample{};
};

/// A triangle or line that a sample of a raster picture lies on.
struct DrawnTerms {
    enum class Verdict {
        seen,    ///< the nearest that lets no light through
        through, ///< before that, and lets light through
        farther  ///< behind that, or as far and later in the source
    };
    bool is_line = false;
    std::uint32_t id = 0;            ///< Tag::id of the object; of a line, the segment's number
    std::uint32_t triangle = 0;      ///< number among those of its object in the source
    double pseudodepth = 0;          ///< z* at the sample (L4)
    double w = 0;                    ///< distance along the view axis there, by which was divided (L3)
    std::array<double, 3> weights{}; ///< of its corners at the sample, in perspective
    std::array<Vec3<double>, 3>
        corners{}; ///< in the world; not of planes, which have but one at a finite place
    bool has_corners = false;
    bool is_front = true;
    Verdict verdict = Verdict::farther;
    /// Where it was lit: at its corners, at the last of them, or at the sample (L10).
    std::vector<RayTerms> points;
    Rgb<double> light{}, transmit{}; ///< at the sample
};

struct RasterExplanation {
    double column = 0, row = 0;    ///< in pixels from the top left corner
    std::vector<DrawnTerms> drawn; ///< the nearest first
    Rgb<double> sample{};
};

} // namespace scc::runtime
