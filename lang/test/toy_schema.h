#pragma once

#include "lang/check.h"
#include "lang/components.h"
#include "lang/schema.h"
#include "lang/test/front.h"
#include "lang/test/memory_importer.h"

#include <numbers>

namespace scc::lang::test {

/// A little language of balls: what the checker needs to know is in its schema, whatever the things are.
inline const Schema& toy_schema() {
    static const Schema schema = [] {
        const auto field = [](std::string_view name, Type type) {
            Field row;
            row.name = name;
            row.type = std::move(type);
            return row;
        };
        const auto limited = [&field](std::string_view name, Type type, Limits limits) {
            Field row = field(name, std::move(type));
            row.limits = limits;
            return row;
        };
        const auto choice = [&field](std::string_view name, std::vector<std::string_view> choices) {
            Field row = field(name, TypeKind::string);
            row.choices = std::move(choices);
            return row;
        };
        const auto per_point = [&field](std::string_view name, Type type) {
            Field row = field(name, std::move(type));
            row.per_point = true;
            return row;
        };
        const auto required = [&field](std::string_view name, Type type) {
            Field row = field(name, std::move(type));
            row.required = true;
            return row;
        };
        const auto unsupported = [&field](std::string_view name, Type type) {
            Field row = field(name, std::move(type));
            row.supported = false;
            return row;
        };
        const auto thing = [](std::string_view name, TypeKind type, std::vector<Field> fields) {
            Constructor row;
            row.name = name;
            row.type = type;
            row.fields = std::move(fields);
            return row;
        };
        Limits positive;
        positive.min = 0;
        positive.min_excluded = true;
        positive.rule = "a radius is greater than 0";
        Limits direction;
        direction.nonzero_vector = true;
        Limits whole;
        whole.min = 1;
        whole.integer = true;
        Limits square = whole;
        square.square = true;
        Limits half_turn;
        half_turn.min = 0;
        half_turn.max = std::numbers::pi;

        Field radius = limited("radius", TypeKind::number, positive);
        radius.default_value = number(1);
        Schema s;
        s.constructors = {
            thing("ball", TypeKind::shape,
                  {field("center", TypeKind::vec3), radius, field("material", TypeKind::material),
                   field("transform", TypeKind::transform), field("name", TypeKind::string),
                   unsupported("squeeze", TypeKind::number)}),
            thing("wall", TypeKind::shape, {limited("normal", TypeKind::vec3, direction)}),
            thing("chain", TypeKind::shape, {required("points", Type::list_of(TypeKind::vec3))}),
            thing("pile", TypeKind::shape, {field("transform", TypeKind::transform)}),
            thing("knot", TypeKind::shape, {}),
            thing("paint", TypeKind::material,
                  {per_point("tone", TypeKind::color), per_point("gloss", TypeKind::number)}),
            thing("lamp", TypeKind::light,
                  {field("position", TypeKind::vec3), field("tone", TypeKind::color),
                   field("enabled", TypeKind::boolean)}),
            thing("eye", TypeKind::camera, {limited("fov_y", TypeKind::angle, half_turn)}),
            thing("world", TypeKind::setting,
                  {choice("unit", {"mm", "cm", "m", "km", "inch"}), field("background", TypeKind::color)}),
            thing("picture", TypeKind::image, {}),
            thing("output", TypeKind::setting,
                  {limited("size", TypeKind::vec2, whole), limited("samples", TypeKind::number, square),
                   choice("shading", {"flat", "smooth"})}),
        };
        s.constructors[3].takes_children = true;
        s.group = "pile";
        s.constructors[4].supported = false;
        return s;
    }();
    return schema;
}

/// A scene that has been checked and, if it was right, evaluated.
struct Scene : Front {
    Module module;

    explicit Scene(std::string_view text, const std::vector<Definition>& definitions = {},
                   const EvaluationLimits& limits = {}, bool in_tables = false,
                   const MemoryImporter::Files& files = {})
        : Front(text) {
        MemoryImporter importer(files);
        const auto tree = in_tables ? read_file(sources, file, diagnostics) : parse();
        module = check(tree, toy_schema(), definitions, sources, diagnostics, limits,
                       files.empty() ? nullptr : &importer);
    }
};

inline std::string messages_of(std::string_view text, const std::vector<Definition>& definitions = {}) {
    return Scene(text, definitions).messages();
}

/// What `print(expression)` says, after some definitions; the messages if there are errors.
inline std::string value_of(std::string_view expression, std::string_view definitions = "") {
    const Scene scene(fmt::format("{}\nprint({})", definitions, expression));
    return scene.diagnostics.has_errors() || scene.module.prints.empty() ? scene.messages()
                                                                         : scene.module.prints.front();
}

} // namespace scc::lang::test
