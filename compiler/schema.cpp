#include "compiler/schema.h"

#include "lang/spectrum.h"
#include "runtime/field.h"
#include "runtime/render_settings.h"
#include "runtime/shapes/list.h"

#include <array>
#include <numbers>
#include <tuple>
#include <utility>

namespace scc::compiler {

namespace {

using lang::Constructor;
using lang::Field;
using lang::Limits;
using lang::Type;
using lang::TypeKind;
using lang::Value;

constexpr double pi = std::numbers::pi;

// ---- values and limits ---------------------------------------------------------------------------------

Value number(double v) {
    return {lang::NumberValue{{v}}};
}
Value angle_degrees(double v) {
    return {lang::AngleValue{{v * pi / 180}}};
}
Value boolean(bool v) {
    return {lang::BoolValue{{v ? 1.0 : 0.0}}};
}
Value text(std::string v) {
    return {std::move(v)};
}
Value vec2(double x, double y) {
    return {lang::Vec2Value{{{{x}, {y}}}}};
}
Value vec3(double x, double y, double z) {
    return {lang::Vec3Value{{{{x}, {y}, {z}}}}};
}
Value grey(double v) {
    return {lang::ColorValue{{{{v}, {v}, {v}}}}};
}

template <std::size_t n>
std::vector<std::string_view> choices(const std::array<std::string_view, n>& names) {
    return {names.begin(), names.end()};
}

Limits positive(std::string_view rule) {
    return {.min = 0, .min_excluded = true, .rule = rule};
}
Limits at_least(double min, std::string_view rule) {
    return {.min = min, .rule = rule};
}
const Limits non_negative = at_least(0, "it is at least 0");
const Limits refractive = positive("an index of refraction is greater than 0");

Limits limits_of(runtime::Rule rule) {
    switch (rule) {
    case runtime::Rule::any:
        return {};
    case runtime::Rule::positive:
        return positive("a radius is greater than 0");
    case runtime::Rule::non_negative:
        return non_negative;
    case runtime::Rule::nonzero_vector:
    case runtime::Rule::direction:
        return {.nonzero_vector = true, .rule = "a direction has a length"};
    }
    return {};
}

// ---- shapes, from their own descriptions ---------------------------------------------------------------

Type type_of(double) {
    return TypeKind::number;
}
Type type_of(bool) {
    return TypeKind::boolean;
}
Type type_of(const runtime::Vec3<double>&) {
    return TypeKind::vec3;
}
template <std::size_t N>
Type type_of(const std::array<runtime::Vec2<double>, N>&) {
    return Type::list_of(TypeKind::vec2);
}
template <std::size_t N>
Type type_of(const std::array<runtime::Vec3<double>, N>&) {
    return Type::list_of(TypeKind::vec3);
}

Value value_of(double v) {
    return number(v);
}
Value value_of(bool v) {
    return boolean(v);
}
Value value_of(const runtime::Vec3<double>& v) {
    return vec3(v.x, v.y, v.z);
}

template <class Owner, class T>
Field schema_field(const Owner& defaults, const runtime::Field<Owner, T>& f) {
    Field result{.name = f.name,
                 .type = type_of(T{}),
                 .required = f.required,
                 .limits = limits_of(f.rule),
                 .doc = f.doc};
    if constexpr (requires { value_of(T{}); }) {
        if (!f.required && f.present == nullptr) {
            result.default_value = value_of(defaults.*f.member);
        }
    }
    return result;
}

void add_shape_fields(Constructor& row) {
    row.fields.push_back(
        {.name = "material", .type = TypeKind::material, .doc = "else that of the nearest enclosing thing"});
    row.fields.push_back(
        {.name = "transform", .type = TypeKind::transform, .doc = "from the shape's own space outwards"});
    row.fields.push_back({.name = "name", .type = TypeKind::string, .doc = "its part of the object's path"});
}

template <class Shape>
void add_shape(std::vector<Constructor>& rows) {
    if constexpr (requires { Shape::fields(); }) {
        Constructor row{.name = Shape::name, .type = TypeKind::shape};
        std::apply([&](const auto&... f) { (row.fields.push_back(schema_field(Shape{}, f)), ...); },
                   Shape::fields());
        if constexpr (std::is_same_v<Shape, runtime::Quadric<double>>) {
            row.fields.push_back({.name = "within",
                                  .type = TypeKind::shape,
                                  .doc =
                                      "a sphere, box, cylinder or cone: only what is inside of it, and its "
                                      "own surface closes the solid; else the quadric is unbounded"});
        }
        add_shape_fields(row);
        rows.push_back(std::move(row));
    }
}

template <class... All>
void add_shapes(std::vector<Constructor>& rows, runtime::TypeList<All...>) {
    (add_shape<All>(rows), ...);
}

// ---- everything else ------------------------------------------------------------------------------------

Constructor mesh() {
    Constructor row{.name = "mesh", .type = TypeKind::shape, .doc = "the triangles of a Wavefront OBJ file"};
    row.fields = {
        {.name = "file", .type = TypeKind::string, .required = true, .asset = true, .doc = "Wavefront OBJ"},
        {.name = "part",
         .type = TypeKind::string,
         .default_value = text(""),
         .doc = "only the faces after `usemtl` and this name; `none`: before the first; empty: all of them"},
        {.name = "normals",
         .type = TypeKind::string,
         .default_value = text("file"),
         .choices = {"file", "smooth", "flat"},
         .doc = "the file's (flat where it has none), averaged at the vertices, or one per face"},
        {.name = "uv",
         .type = TypeKind::boolean,
         .default_value = boolean(true),
         .doc = "whether the file's texture coordinates are kept for `s.uv`"},
    };
    add_shape_fields(row);
    return row;
}

Constructor implicit() {
    Constructor row{.name = "implicit",
                    .type = TypeKind::shape,
                    .doc = "the solid of the points in a container where a function is negative"};
    row.fields = {{.name = "field",
                   .type = Type::function({TypeKind::vec3}, TypeKind::number),
                   .required = true,
                   .doc = "of a point; negative inside"},
                  {.name = "within",
                   .type = TypeKind::shape,
                   .required = true,
                   .doc = "a sphere, box, cylinder or cone; its surface closes the solid"}};
    add_shape_fields(row);
    return row;
}

Constructor heightfield() {
    Constructor row{.name = "heightfield",
                    .type = TypeKind::shape,
                    .doc = "a landscape over a rectangle in the plane y = 0 about the origin, of triangles "
                           "with normals at their corners"};
    row.fields = {{.name = "field",
                   .type = Type::function({TypeKind::vec2}, TypeKind::number),
                   .required = true,
                   .doc = "of (u, v), which run from 0 to 1 along x and z"},
                  {.name = "size",
                   .type = TypeKind::vec2,
                   .default_value = vec2(1, 1),
                   .limits = positive("a size is greater than 0"),
                   .doc = "in x and z"},
                  {.name = "height",
                   .type = TypeKind::number,
                   .default_value = number(1),
                   .doc = "y is this times the field"},
                  {.name = "cells",
                   .type = TypeKind::vec2,
                   .default_value = vec2(256, 256),
                   .limits = {.min = 1,
                              .max = 2048,
                              .integer = true,
                              .rule = "cells along a side are a whole number from 1 to 2048"},
                   .doc = "along x and z; each is two triangles"}};
    add_shape_fields(row);
    return row;
}

Constructor with_children(std::string_view name, std::string_view doc) {
    Constructor row{.name = name, .type = TypeKind::shape, .takes_children = true, .doc = doc};
    add_shape_fields(row);
    return row;
}
Constructor group() {
    return with_children("group", "shapes that share a transform and a material");
}
Constructor unite() {
    return with_children("union", "a solid: what is in one of the closed shapes");
}
Constructor intersection() {
    return with_children("intersection", "a solid: what is in all of the closed shapes");
}
Constructor difference() {
    return with_children("difference", "a solid: what is in the first closed shape and in no other");
}

Field color(std::string_view name, std::optional<Value> value, std::string_view doc, bool per_point = false) {
    return {.name = name,
            .type = TypeKind::color,
            .default_value = std::move(value),
            .per_point = per_point,
            .limits = non_negative,
            .doc = doc};
}

Constructor polyline() {
    Constructor row{.name = "polyline", .type = TypeKind::shape, .doc = "a line from point to point"};
    row.fields = {
        {.name = "points", .type = Type::list_of(TypeKind::vec3), .required = true, .doc = "two or more"},
        color("color", std::nullopt, "diffuse colour; else that of `material`"),
        {.name = "width",
         .type = TypeKind::number,
         .default_value = number(1),
         .limits = positive("a width is greater than 0"),
         .doc = "in pixels (raster)"},
        {.name = "radius",
         .type = TypeKind::number,
         .limits = positive("a radius is greater than 0"),
         .doc = "makes it a chain of capsules, which rays can meet; needed by ray { }"}};
    add_shape_fields(row);
    return row;
}

Constructor phong() {
    return {.name = "phong",
            .type = TypeKind::material,
            .fields = {color("diffuse", grey(0.8), "part of the light that is scattered", true),
                       color("ambient", std::nullopt, "of the ambient light; else the diffuse value", true),
                       color("specular", grey(0), "of the highlight", true),
                       {.name = "shininess",
                        .type = TypeKind::number,
                        .default_value = number(32),
                        .per_point = true,
                        .limits = non_negative,
                        .doc = "exponent of the highlight"},
                       color("emission", grey(0), "light that the surface gives off", true),
                       color("reflect", grey(0), "of the mirrored ray", true),
                       color("transmit", grey(0),
                             "of what is seen through the surface; each surface on the way to a light "
                             "dims it so, and the shadow of coloured glass is coloured",
                             true),
                       {.name = "ior",
                        .type = TypeKind::number,
                        .default_value = number(1),
                        .limits = refractive,
                        .doc = "index of refraction of what the surface encloses: where it differs from that "
                               "of what is around it, rays bend and take a bounce, and are mirrored beyond "
                               "the critical angle; else they go straight on and take none. Feelers to "
                               "lights do not bend"},
                       {.name = "opacity",
                        .type = TypeKind::number,
                        .default_value = number(1),
                        .per_point = true,
                        .limits = {.min = 0, .max = 1, .rule = "it lies between 0 and 1"},
                        .doc = "alpha, by which ambient, diffuse, specular and emission are multiplied; "
                               "1 - opacity is added to transmit"},
                       {.name = "bump",
                        .type = Type::function({TypeKind::surface}, TypeKind::number),
                        .doc = "a height, in world units, by which the surface seems to be displaced along "
                               "its normal, outwards: its slope, to first order, tilts the normal that "
                               "light, mirrors and refraction go by; outlines and shadows stay. What is "
                               "turned away from a light without the bump stays dark. It may read `s.p`, "
                               "`s.world` and `s.uv`"}},
            .doc = "Phong illumination with the halfway vector"};
}

Constructor glass() {
    return {.name = "glass",
            .type = TypeKind::material,
            .fields = {{.name = "ior",
                        .type = TypeKind::number,
                        .default_value = number(1.5),
                        .limits = refractive,
                        .doc = "index of refraction of what the surface encloses"},
                       color("tint", grey(1), "of what is seen through the surface; of shadows too", true),
                       color("specular", grey(0), "of the highlight", true),
                       {.name = "shininess",
                        .type = TypeKind::number,
                        .default_value = number(32),
                        .per_point = true,
                        .limits = non_negative,
                        .doc = "exponent of the highlight"}},
            .doc = "mirrors by the reflectance F of Fresnel's equations, and shows what is behind it times "
                   "(1 - F) tint"};
}

Constructor two_sided() {
    return {.name = "two_sided",
            .type = TypeKind::material,
            .fields = {{.name = "front",
                        .type = TypeKind::material,
                        .required = true,
                        .doc = "seen from the side that the normal points to"},
                       {.name = "back",
                        .type = TypeKind::material,
                        .required = true,
                        .doc = "seen from the other side"}},
            .doc = "a material for each side"};
}

Constructor image() {
    return {
        .name = "image",
        .type = TypeKind::image,
        .fields = {{.name = "file",
                    .type = TypeKind::string,
                    .required = true,
                    .asset = true,
                    .doc =
                        "any type that OpenImageIO reads, at most 16384 texels to a side; grey stands in all "
                        "channels, alpha is left out"},
                   {.name = "encoding",
                    .type = TypeKind::string,
                    .default_value = text("srgb"),
                    .choices = {"srgb", "linear"},
                    .doc = "of whole numbers; a file of floats holds linear light"},
                   {.name = "wrap",
                    .type = TypeKind::string,
                    .default_value = text("repeat"),
                    .choices = {"repeat", "clamp"},
                    .doc = "beyond 0 to 1: again and again, or as at the edge"},
                   {.name = "filter",
                    .type = TypeKind::string,
                    .default_value = text("bilinear"),
                    .choices = {"bilinear", "nearest"},
                    .doc = "between the texels' centres: blended, or the nearest one"}},
        .doc = "a function of a vec2 that gives a colour: `wood(s.uv)`. Over (0, 0) to (1, 1), v upwards"};
}

void add_light_fields(Constructor& row) {
    row.fields.push_back(color("color", grey(1), "intensity, for the diffuse and the specular term"));
    row.fields.push_back(
        color("specular", std::nullopt, "intensity for the specular term, where it differs"));
    row.fields.push_back({.name = "enabled",
                          .type = TypeKind::boolean,
                          .default_value = boolean(true),
                          .doc = "off: left out"});
}

/// Of lights that shine from points.
void add_source_fields(Constructor& row) {
    row.fields.push_back({.name = "attenuation",
                          .type = TypeKind::vec3,
                          .default_value = vec3(1, 0, 0),
                          .limits = non_negative,
                          .doc = "(kc, kl, kq): at distance d the light is divided by kc + kl d + kq d^2"});
    add_light_fields(row);
    row.fields.push_back(
        {.name = "power",
         .type = TypeKind::number,
         .limits = positive("a power is greater than 0"),
         .doc = "in watts, instead of `attenuation`: the radiant flux of a lamp that shines alike "
                "in all directions, as Blender has it. `color` is multiplied by power / (4 pi^2), "
                "what a white surface sends on, and divided by d^2; lengths count as metres"});
}

Constructor point_light() {
    Constructor row{
        .name = "point_light",
        .type = TypeKind::light,
        .fields = {
            {.name = "position", .type = TypeKind::vec3, .default_value = vec3(0, 0, 0), .doc = "place"}}};
    add_source_fields(row);
    return row;
}

Constructor spot_light() {
    const auto half_angle = [](std::string_view name, double degrees, bool zero, std::string_view doc) {
        return Field{.name = name,
                     .type = TypeKind::angle,
                     .default_value = angle_degrees(degrees),
                     .limits = {.min = 0,
                                .max = pi / 2,
                                .min_excluded = !zero,
                                .rule = "a half angle of a cone of light lies between 0 and 90deg"},
                     .doc = doc};
    };
    Constructor row{
        .name = "spot_light",
        .type = TypeKind::light,
        .fields = {{.name = "position", .type = TypeKind::vec3, .required = true, .doc = "place"},
                   {.name = "target", .type = TypeKind::vec3, .required = true, .doc = "point shone at"},
                   half_angle("inner", 20, true, "from the axis; up to here the light is whole"),
                   half_angle("outer", 25, false,
                              "from the axis; from here on it is dark, and in between it is multiplied by "
                              "a smooth step of the angle's cosine"),
                   {.name = "exponent",
                    .type = TypeKind::number,
                    .default_value = number(0),
                    .limits = non_negative,
                    .doc = "of the cosine of the angle from the axis, by which the light is multiplied"}}};
    add_source_fields(row);
    return row;
}

Constructor rectangle_light() {
    const Limits edge = {.nonzero_vector = true, .rule = "an edge has a length"};
    Constructor row{
        .name = "rectangle_light",
        .type = TypeKind::light,
        .fields = {
            {.name = "corner", .type = TypeKind::vec3, .required = true, .doc = "one corner"},
            {.name = "edge_u",
             .type = TypeKind::vec3,
             .required = true,
             .limits = edge,
             .doc = "the way from there to the next corner"},
            {.name = "edge_v",
             .type = TypeKind::vec3,
             .required = true,
             .limits = edge,
             .doc = "the way from there to the corner on the other side"},
            {.name = "samples",
             .type = TypeKind::vec2,
             .default_value = vec2(4, 4),
             .limits = {.min = 1,
                        .max = 64,
                        .integer = true,
                        .rule = "samples along an edge are a whole number from 1 to 64"},
             .doc =
                 "points of light along `edge_u` and `edge_v`, in the middle of equal cells; each gives an "
                 "equal part of `color`, to all sides"}}};
    add_source_fields(row);
    return row;
}

Constructor directional_light() {
    const Limits direction = limits_of(runtime::Rule::nonzero_vector);
    Constructor row{.name = "directional_light",
                    .type = TypeKind::light,
                    .fields = {{.name = "direction",
                                .type = TypeKind::vec3,
                                .limits = direction,
                                .doc = "the way the light travels"},
                               {.name = "towards",
                                .type = TypeKind::vec3,
                                .limits = direction,
                                .doc = "or: the way to the source"}}};
    add_light_fields(row);
    return row;
}

void add_viewpoint(Constructor& row) {
    row.fields.push_back(
        {.name = "eye", .type = TypeKind::vec3, .default_value = vec3(0, 0, 5), .doc = "place"});
    row.fields.push_back(
        {.name = "target", .type = TypeKind::vec3, .default_value = vec3(0, 0, 0), .doc = "point looked at"});
    row.fields.push_back({.name = "up",
                          .type = TypeKind::vec3,
                          .default_value = vec3(0, 1, 0),
                          .limits = limits_of(runtime::Rule::nonzero_vector),
                          .doc = "drawn upwards"});
}

void add_window(Constructor& row) {
    row.fields.push_back({.name = "near",
                          .type = TypeKind::number,
                          .default_value = number(0.1),
                          .limits = positive("it is greater than 0"),
                          .doc = "nearest distance (raster)"});
    row.fields.push_back({.name = "far",
                          .type = TypeKind::number,
                          .default_value = number(1000),
                          .limits = positive("it is greater than 0"),
                          .doc = "farthest distance (raster)"});
    row.fields.push_back({.name = "shift",
                          .type = TypeKind::vec2,
                          .default_value = vec2(0, 0),
                          .doc = "of the window, in window heights"});
}

Constructor perspective_camera() {
    Constructor row{.name = "perspective_camera", .type = TypeKind::camera};
    row.fields.push_back(
        {.name = "fov_y",
         .type = TypeKind::angle,
         .default_value = angle_degrees(45),
         .limits = {.min = 0, .max = pi, .min_excluded = true, .rule = "it lies between 0 and 180deg"},
         .doc = "angle between the picture's lower and upper edge"});
    add_viewpoint(row);
    add_window(row);
    row.fields.push_back({.name = "aperture",
                          .type = TypeKind::number,
                          .default_value = number(0),
                          .limits = non_negative,
                          .doc = "diameter of the lens; 0: a pinhole, which shows everything sharp"});
    row.fields.push_back({.name = "focus",
                          .type = TypeKind::number,
                          .limits = positive("a distance in focus is greater than 0"),
                          .doc = "along the view axis, to the plane that the lens shows sharp; else that of "
                                 "`target`"});
    return row;
}

Constructor orthographic_camera() {
    Constructor row{.name = "orthographic_camera", .type = TypeKind::camera};
    row.fields.push_back({.name = "height",
                          .type = TypeKind::number,
                          .default_value = number(2),
                          .limits = positive("a height is greater than 0"),
                          .doc = "full height of the window"});
    add_viewpoint(row);
    add_window(row);
    return row;
}

Constructor spherical_camera() {
    Constructor row{.name = "spherical_camera", .type = TypeKind::camera};
    add_viewpoint(row);
    row.fields.push_back({.name = "fov_x",
                          .type = TypeKind::angle,
                          .default_value = angle_degrees(360),
                          .limits = {.min = 0,
                                     .max = 2 * pi,
                                     .min_excluded = true,
                                     .rule = "it is greater than 0 and at most 360deg"},
                          .doc = "longitudes that the picture's width shows"});
    row.fields.push_back({.name = "fov_y",
                          .type = TypeKind::angle,
                          .default_value = angle_degrees(180),
                          .limits = {.min = 0,
                                     .max = pi,
                                     .min_excluded = true,
                                     .rule = "it is greater than 0 and at most 180deg"},
                          .doc = "latitudes that its height shows"});
    return row;
}

Constructor world() {
    return {.name = "world",
            .type = TypeKind::setting,
            .fields = {color("ambient", grey(0.1), "light that comes from everywhere (Ia)"),
                       color("background", grey(0), "where a ray meets nothing"),
                       {.name = "unit",
                        .type = TypeKind::string,
                        .default_value = text("m"),
                        .choices = {"mm", "cm", "m", "km", "inch"},
                        .doc = "what 1 stands for, for lengths with a suffix"},
                       {.name = "observer",
                        .type = TypeKind::string,
                        .default_value = text("cie1931"),
                        .choices = {"cie1931"},
                        .doc = "whose eye turns spectra into colours: the standard one of 2 degrees"},
                       {.name = "illuminant",
                        .type = TypeKind::string,
                        .default_value = text("d65"),
                        .choices = lang::illuminant_names(),
                        .doc = "the spectrum of light whose colour is rgb(1, 1, 1)"}}};
}

Constructor render() {
    return {
        .name = "render",
        .type = TypeKind::setting,
        .fields = {{.name = "file",
                    .type = TypeKind::string,
                    .doc = "a name for the picture; `-o` decides where it goes"},
                   {.name = "size",
                    .type = TypeKind::vec2,
                    .default_value = vec2(800, 600),
                    .limits = {.min = 1,
                               .max = 65536,
                               .integer = true,
                               .rule = "a size is a whole number from 1 to 65536"},
                    .doc = "(width, height) in pixels"},
                   {.name = "camera", .type = TypeKind::string, .doc = "its name, where there are several"},
                   {.name = "method", .type = TypeKind::method, .doc = "ray { } or raster { }; else ray { }"},
                   {.name = "frames",
                    .type = TypeKind::range,
                    .doc = "of an animation, the last one excluded; `frame` and `time` tell which one it is"},
                   {.name = "frame_rate",
                    .type = TypeKind::number,
                    .default_value = number(24),
                    .limits = positive("a rate is greater than 0"),
                    .doc = "frames per second: `time` is `frame / frame_rate`"},
                   {.name = "sampling",
                    .type = TypeKind::string,
                    .default_value = text("center"),
                    .choices = choices(runtime::pixel_point_names),
                    .doc = "the point of a pixel around which it is sampled: its centre, or its lower left "
                           "corner as in the lecture's formula"}}};
}

Limits samples_of(bool square, std::string_view rule) {
    return {.min = 1, .max = runtime::most_samples, .integer = true, .square = square, .rule = rule};
}

std::vector<Field> sampling() {
    return {{.name = "samples",
             .type = TypeKind::number,
             .default_value = number(1),
             .limits = samples_of(false, "samples per pixel are a whole number from 1 to 4096"),
             .doc = "per pixel, of a grid a square number; with `adaptive` at most"},
            {.name = "sampler",
             .type = TypeKind::string,
             .choices = choices(runtime::sampler_names),
             .doc = "where a pixel's samples lie: at the centres of n x n parts of it (the default), or "
                    "scattered evenly, at scrambled Sobol points (the default with `adaptive`)"},
            {.name = "filter",
             .type = TypeKind::string,
             .default_value = text("box"),
             .choices = choices(runtime::filter_names),
             .doc =
                 "how samples are weighted by their distance from the pixel's centre: all of the pixel's own "
                 "alike, or those within 2 pixels (`mitchell`) or 1.5 along each axis"},
            {.name = "adaptive",
             .type = TypeKind::number,
             .limits = positive("a tolerance is greater than 0"),
             .doc = "a pixel gets samples, 16 at a time, until the standard error of their mean is no more "
                    "than this in any channel (linear light)"}};
}

Constructor ray() {
    Constructor row{.name = "ray",
                    .type = TypeKind::method,
                    .fields = {{.name = "depth",
                                .type = TypeKind::number,
                                .default_value = number(5),
                                .limits = {.min = 0,
                                           .max = runtime::most_bounces,
                                           .integer = true,
                                           .rule = "a depth is a whole number from 0 to 256"},
                                .doc = "mirrors and refractions one after the other; 0: none"},
                               {.name = "shadows",
                                .type = TypeKind::boolean,
                                .default_value = boolean(true),
                                .doc = "shadow feelers"}}};
    const std::vector<Field> more = sampling();
    row.fields.insert(row.fields.begin() + 1, more.begin(), more.end());
    return row;
}

Constructor raster() {
    return {.name = "raster",
            .type = TypeKind::method,
            .fields = {{.name = "shading",
                        .type = TypeKind::string,
                        .default_value = text("phong"),
                        .choices = {"flat", "gouraud", "phong", "wireframe", "hidden_line"},
                        .doc = "where colours are computed"},
                       {.name = "samples",
                        .type = TypeKind::number,
                        .default_value = number(1),
                        .limits = samples_of(true, "samples per pixel are a square number from 1 to 4096"),
                        .doc = "per pixel, on a regular grid"},
                       {.name = "clip",
                        .type = TypeKind::boolean,
                        .default_value = boolean(true),
                        .doc = "at the near and the far plane; the sides of the window always cut"},
                       {.name = "cull",
                        .type = TypeKind::string,
                        .default_value = text("none"),
                        .choices = {"none", "back"},
                        .doc = "faces left out"},
                       {.name = "tessellation",
                        .type = TypeKind::number,
                        .default_value = number(0.001),
                        .limits = positive("it is greater than 0"),
                        .doc = "tolerance, of the picture's height"}}};
}

// The language's other words: known, so that a scene that uses one is told the truth.
void add_unsupported(std::vector<Constructor>& rows) {
    const std::pair<std::string_view, TypeKind> words[] = {
        {"sky_light", TypeKind::light},
        {"pbr", TypeKind::material},
    };
    for (const auto& [name, type] : words) {
        rows.push_back({.name = name, .type = type, .supported = false, .doc = "not supported yet"});
    }
}

/// Of what has no text beside its fields.
constexpr std::pair<std::string_view, std::string_view> docs[] = {
    {"sphere", "a ball's surface"},
    {"box", "with faces along the axes, between two corners"},
    {"plane", "without end, the points p with dot(normalize(normal), p) = offset"},
    {"cylinder", "around the line between two points, open or closed by caps"},
    {"cone", "around the line between two points, with a radius at each"},
    {"torus", "a ring, whose tube has a circle in its middle"},
    {"quadric",
     "the points where a polynomial of the second degree is 0, such as ellipsoids, paraboloids and "
     "hyperboloids"},
    {"disc", "flat and round, with or without a hole"},
    {"triangle", "three points; with normals at them it looks smooth"},
    {"point_light", "shines from a point to all sides"},
    {"spot_light", "shines from a point into a cone"},
    {"rectangle_light", "a grid of points that shine together, for soft shadows"},
    {"directional_light", "shines from one direction everywhere, as the sun does"},
    {"perspective_camera", "central projection"},
    {"orthographic_camera", "parallel projection"},
    {"spherical_camera", "a panorama: columns are longitudes around the `up` axis, rows are latitudes"},
    {"world", "what surrounds the scene"},
    {"render", "a picture of the scene"},
    {"ray", "a picture by casting rays"},
    {"raster", "a picture by projecting surfaces"},
};

void add_docs(std::vector<Constructor>& rows) {
    for (const auto& [name, doc] : docs) {
        for (Constructor& row : rows) {
            row.doc = row.name == name ? doc : row.doc;
        }
    }
}

lang::Schema make_schema() {
    lang::Schema schema;
    add_shapes(schema.constructors, runtime::Shapes<double>{});
    for (auto make : {mesh,
                      implicit,
                      heightfield,
                      polyline,
                      group,
                      unite,
                      intersection,
                      difference,
                      phong,
                      glass,
                      two_sided,
                      image,
                      point_light,
                      directional_light,
                      spot_light,
                      rectangle_light,
                      perspective_camera,
                      orthographic_camera,
                      spherical_camera,
                      world,
                      render,
                      ray,
                      raster}) {
        schema.constructors.push_back(make());
    }
    add_docs(schema.constructors);
    add_unsupported(schema.constructors);
    schema.group = "group";
    return schema;
}

} // namespace

const lang::Schema& scene_schema() {
    static const lang::Schema schema = make_schema();
    return schema;
}

} // namespace scc::compiler
