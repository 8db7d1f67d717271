#pragma once

#include "runtime/shapes/box.h"
#include "runtime/shapes/cone.h"
#include "runtime/shapes/cylinder.h"
#include "runtime/shapes/disc.h"
#include "runtime/shapes/implicit.h"
#include "runtime/shapes/mesh.h"
#include "runtime/shapes/plane.h"
#include "runtime/shapes/sphere.h"
#include "runtime/shapes/triangle.h"

namespace scc::runtime {

template <class... Ts>
struct TypeList {};

/// The one list of shapes. A new shape is its header and a row here.
template <class R>
using Shapes =
    TypeList<Sphere<R>, Box<R>, Plane<R>, Cylinder<R>, Cone<R>, Disc<R>, Triangle<R>, Mesh<R>, Implicit<R>>;

} // namespace scc::runtime
