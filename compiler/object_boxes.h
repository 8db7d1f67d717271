#pragma once

#include "compiler/bounds.h"
#include "compiler/ir/objects.h"

#include <cstddef>
#include <optional>
#include <variant>

namespace scc::compiler {

using Box = runtime::Bounds<double>;

/// f(shape, world_from_object, span, path) for every object; span() and path() are made where they are asked
/// for, since of millions few are.
template <class F>
void for_each_placed(const ir::Scene& scene, F f) {
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            std::visit(
                [&](const auto& shape) {
                    f(
                        shape, object.world_from_object, [&] { return object.span; },
                        [&] { return object.path; });
                },
                object.shape);
        },
        [&](const ir::ObjectArray& array) {
            for (const ir::ObjectColumn& column : array.columns) {
                std::visit(
                    [&](const auto& shapes) {
                        for (std::size_t round = 0; round < array.rounds; ++round) {
                            f(
                                shapes[round], column.world_from_object,
                                [&] { return column.span_of(round); }, [&] { return column.path_of(round); });
                        }
                    },
                    column.shapes);
            }
        });
}

/// In world space; none for an unbounded shape.
template <class Shape>
std::optional<Box> box_in_world(const Shape& shape, const runtime::Affine<double>& place,
                                const ir::Scene& scene) {
    const std::optional<Box> own = object_bounds(shape, scene);
    return own && place != runtime::Affine<double>{} ? transform_bounds(place, *own) : own;
}

/// f(box, span, path) for every object, as above.
template <class F>
void for_each_box(const ir::Scene& scene, F f) {
    for_each_placed(scene, [&](const auto& shape, const auto& place, const auto& span, const auto& path) {
        f(box_in_world(shape, place, scene), span, path);
    });
}

} // namespace scc::compiler
