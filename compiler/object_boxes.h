#pragma once

#include "compiler/bounds.h"
#include "compiler/ir/objects.h"

#include <cstddef>
#include <optional>
#include <variant>

namespace scc::compiler {

using Box = runtime::Bounds<double>;

/// f(box, span, path) for every object, the box in world space and none for an unbounded shape; span() and
/// path() are made where they are asked for, since of millions few are.
template <class F>
void for_each_box(const ir::Scene& scene, F f) {
    const auto box = [&](const auto& shape, const runtime::Affine<double>& place) {
        const std::optional<Box> own = object_bounds(shape, scene);
        return own && place != runtime::Affine<double>{} ? transform_bounds(place, *own) : own;
    };
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            f(
                box(object.shape, object.world_from_object), [&] { return object.span; },
                [&] { return object.path; });
        },
        [&](const ir::ObjectArray& array) {
            for (const ir::ObjectColumn& column : array.columns) {
                std::visit(
                    [&](const auto& shapes) {
                        for (std::size_t round = 0; round < array.rounds; ++round) {
                            f(
                                box(shapes[round], column.world_from_object),
                                [&] { return column.span_of(round); }, [&] { return column.path_of(round); });
                        }
                    },
                    column.shapes);
            }
        });
}

} // namespace scc::compiler
