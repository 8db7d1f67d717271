#pragma once

#include "compiler/ir/scene.h"

namespace scc::compiler {

double nearest_power_of_two(double x);

/// The part of the world that matters to the picture: the eye and what it can see the size of.
struct Extent {
    double size = 0; ///< its diagonal; where there are but planes, down to the farthest
    runtime::Vec3<double> center{};
    bool has_planes_alone = false;

    /// Not of an empty scene, nor of an infinite one.
    bool is_usable() const;
    /// The centre to about the size, so that differences to it stay exact.
    runtime::Vec3<double> round_center() const;
};

/// Around the eye, all bounded objects but giants and the origins of other unbounded ones.
Extent extent_of(const ir::Scene& scene);

} // namespace scc::compiler
