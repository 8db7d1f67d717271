#pragma once

#include "runtime/shapes/box.h"
#include "runtime/shapes/cone.h"
#include "runtime/shapes/csg.h"
#include "runtime/shapes/cylinder.h"
#include "runtime/shapes/disc.h"
#include "runtime/shapes/implicit.h"
#include "runtime/shapes/mesh.h"
#include "runtime/shapes/plane.h"
#include "runtime/shapes/quadric.h"
#include "runtime/shapes/sphere.h"
#include "runtime/shapes/torus.h"
#include "runtime/shapes/triangle.h"

namespace scc::runtime {

template <class... Ts>
struct TypeList {};

/// The one list of shapes. A new shape is its header and a row here.
template <class R>
using Primitives = TypeList<Sphere<R>, Box<R>, Plane<R>, Cylinder<R>, Cone<R>, Disc<R>, Triangle<R>, Mesh<R>,
                            Implicit<R>, Torus<R>, Quadric<R>>;

template <class List, class Last>
struct Appended;
template <class... Ts, class Last>
struct Appended<TypeList<Ts...>, Last> {
    using type = TypeList<Ts..., Last>;
};
/// With what is made of others.
template <class R>
using Shapes = typename Appended<Primitives<R>, Csg<R>>::type;

} // namespace scc::runtime
