#pragma once

#include "runtime/math/vec.h"

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Eric Haines' Neutral File Format 3.1, the format of the Standard Procedural Databases.
namespace scc::compiler::nff {

/// Where something begins; both count from 1.
struct Place {
    std::uint32_t line = 0, column = 0;
};

/// What is wrong with a file.
struct Error : std::runtime_error {
    Error(Place at, const std::string& text) : std::runtime_error(text), place(at) {}
    Place place;
};

/// Something that the file says and the scene cannot.
struct Warning {
    Place place;
    std::string text;
};

using Vec3 = runtime::Vec3<double>;
using Rgb = runtime::Rgb<double>;

struct View {
    Place place;
    Vec3 from, at, up;
    double angle = 0; ///< in degrees
    double hither = 0;
    Place hither_place;
    int width = 0, height = 0;
};
struct Light {
    Vec3 position;
    std::optional<Rgb> color;
};

struct Comment {
    std::string_view text;
    bool ends_a_line = false; ///< that an item begins
};
struct Fill {
    Place place;
    Rgb color;
    double kd = 0, ks = 0, shine = 0, t = 0, ior = 0;
};
struct Sphere {
    Vec3 center;
    double radius = 0;
};
/// Without end caps; equal radii: a cylinder.
struct Cone {
    Vec3 base;
    double base_radius = 0;
    Vec3 apex;
    double apex_radius = 0;
};
/// Its corners are in the file's points from `first` on; those of a patch alternate with their normals.
struct Polygon {
    Place place;
    std::size_t first = 0;
    std::uint32_t count = 0;
    bool is_patch = false;
};
using Item = std::variant<Comment, Fill, Sphere, Cone, Polygon>;

/// A file's content, checked: every item can be written as a shape. Comments refer to the text that was read.
struct File {
    View view;
    std::optional<Rgb> background;
    std::vector<Light> lights;
    std::vector<Item> items; ///< in the file's order; there is a fill before the first shape
    std::size_t heading = 0; ///< how many of them are comments before everything else
    std::vector<Vec3> points;
};

/// Throws Error at the first mistake.
File parse(std::string_view text);

/// The scene as text; `name`: the file's, for the header. What the scene cannot say is a comment at its place
/// and a warning.
std::string scene_text(const File& file, std::string_view name, std::vector<Warning>& warnings);

} // namespace scc::compiler::nff
