#pragma once

#include "runtime/mesh_trace.h"
#include "runtime/scene.h"

#include <type_traits>

/// What the kernels ask of a Bare or Placed shape.
namespace scc::runtime {

template <class Shape>
inline constexpr bool is_mesh = requires(const Shape& s) {
    s.mesh;
};
template <class Shape>
inline constexpr bool is_csg = requires(const Shape& s) {
    s.root;
};
template <class Shape>
inline constexpr bool is_bounded = is_mesh<Shape> || is_csg<Shape> || requires(const Shape& s) {
    s.bounds();
};
template <class Shape>
inline constexpr bool is_implicit = requires(const Shape& s) {
    s.field;
};
/// Whether a ray is in it for one stretch at most.
template <class Shape>
inline constexpr bool is_convex = requires(const Shape& s, const Ray<double>& ray) {
    s.stretch(ray);
};
/// Whether it has coordinates on its surface.
template <class Shape>
inline constexpr bool has_uv = is_mesh<Shape> || requires(const Shape& s, const Ray<double>& ray) {
    s.uv(ray, ShapeHit<double>{}, Vec3<double>{});
};
/// Whether it can be a member of solids made of others.
template <class Shape>
inline constexpr bool is_solid = is_convex<Shape> || is_implicit<Shape> || is_mesh<Shape> ||
                                 requires(const Shape& s, const Ray<double>& ray) {
    s.cross(ray);
};

/// f.operator()<kind>() for each kind of primitives that `admits` names, a function of nothing but the kind,
/// until it returns true; whether it did. For the others f is not compiled.
template <class Admits, class F>
bool any_of_kinds_where([[maybe_unused]] Admits admits, F&& f) {
    const auto one = [&]<std::uint32_t kind>(std::integral_constant<std::uint32_t, kind>) {
        if constexpr (Admits{}.template operator()<kind>()) {
            return f.template operator()<kind>();
        } else {
            return false;
        }
    };
    return [&]<std::uint32_t... kind>(std::integer_sequence<std::uint32_t, kind...>) {
        return (one(std::integral_constant<std::uint32_t, kind>{}) || ...);
    }
    (std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
}

/// Whether the scene's solids can have members of a kind.
template <class S, std::uint32_t kind>
inline constexpr bool
    has_members = uses_member_kind(S::traits, kind) && is_solid<ShapeOfKind<typename S::Real, kind>>;

/// f(member) with the one that the reference names.
template <class S, class F>
void visit_member(const S& scene, const PrimitiveRef& ref, F&& f) {
    any_of_kinds_where([]<std::uint32_t kind>() { return has_members<S, kind>; },
                       [&]<std::uint32_t kind>() {
                           if (kind != ref.kind) {
                               return false;
                           }
                           f(scene.members(Of<PrimitiveOfKind<typename S::Real, kind>>{})[ref.index]);
                           return true;
                       });
}

/// A box around a solid from its members' boxes; box_of(node) gives one's. Not finite where the members do
/// not bound the solid, inside out where it is empty.
template <class R, class Nodes, class BoxOf>
Bounds<R> csg_bounds(const Nodes& nodes, std::size_t at, const BoxOf& box_of) {
    const auto& node = nodes[at];
    if (node.op == CsgOp::member) {
        return box_of(node);
    }
    Bounds<R> result;
    for (std::size_t child = at + 1; child < at + node.size; child += nodes[child].size) {
        if (child > at + 1 && node.op == CsgOp::subtract) {
            break;
        }
        const Bounds<R> box = csg_bounds<R>(nodes, child, box_of);
        if (child == at + 1 || node.op == CsgOp::unite) {
            result.add(box);
        } else {
            result = {maximum(result.min, box.min), minimum(result.max, box.max)};
        }
    }
    return result;
}

/// f.operator()<kind>(primitive, its index in the table of its kind) for the bounded ones, kind by kind.
template <class S, class F>
void for_each_bounded(const S& scene, F&& f) {
    using R = typename S::Real;
    any_of_kinds_where(
        []<std::uint32_t kind>() { return uses_kind(S::traits, kind) && is_bounded<ShapeOfKind<R, kind>>; },
        [&]<std::uint32_t kind>() {
            std::uint32_t index = 0;
            for (const auto& primitive : scene.primitives(Of<PrimitiveOfKind<R, kind>>{})) {
                f.template operator()<kind>(primitive, index++);
            }
            return false;
        });
}

template <class R, class L>
constexpr Ray<L> transform_ray(const Affine<R>& a, const Ray<L>& ray) {
    return {transform_point(a, ray.org), transform_vector(a, ray.dir), ray.t_min, ray.t_max};
}

/// A surface in world space. The error bound grows by the rounding of this transform and of the one by which
/// a ray that starts here comes back (8 roundings each, of the terms' magnitudes, where 4 are due to the sums
/// and 1 to 2 to the matrices' entries: both must be rounded true values, see inverse()). A mirroring map
/// keeps the side on which the normal is.
template <class R, class L>
constexpr Surface<L> transform_surface(const Affine<R>& world_from_object, const Affine<R>& object_from_world,
                                       const Surface<L>& object) {
    const L u = 8 * roundoff<L>();
    const Vec3<L> magnitude = transform_magnitude(world_from_object, absolute(object.point)) +
                              absolute(lanes<L>(translation_of(world_from_object)));
    const Vec3<L> way_back = transform_magnitude(object_from_world, magnitude) +
                             absolute(lanes<L>(translation_of(object_from_world)));
    const Vec3<L> error = transform_magnitude(world_from_object, object.error + way_back * u) + magnitude * u;
    return {transform_point(world_from_object, object.point), error,
            normalize(transform_normal(object_from_world, object.normal)),
            normalize(transform_normal(object_from_world, object.shading_normal))};
}

/// An implicit surface's field, over whatever numbers.
template <class S, class Shape>
auto field_of(const S& scene, const Shape& shape) {
    return [&scene, index = shape.field]<class T>(const Vec3<T>& point) {
        return scene.field_function(index, point);
    };
}

/// For what is no mesh, in the shape's space.
template <class S, class Shape, class L>
constexpr ShapeHit<L> intersect_shape([[maybe_unused]] const S& scene, const Shape& shape,
                                      const Ray<L>& ray) {
    if constexpr (is_implicit<Shape>) {
        return intersect_implicit(shape, ray, field_of(scene, shape));
    } else {
        return shape.intersect(ray);
    }
}

/// Where a solid that is not convex next begins or ends, in the shape's space.
template <class S, class Shape, class L>
Crossing<L> cross_shape([[maybe_unused]] const S& scene, const Shape& shape, const Ray<L>& ray) {
    if constexpr (is_implicit<Shape>) {
        return cross_implicit(shape, ray, field_of(scene, shape));
    } else if constexpr (is_mesh<Shape>) {
        return cross_mesh(scene.meshes[shape.mesh], ray);
    } else {
        return shape.cross(ray);
    }
}

namespace detail {

template <class S, class Shape, class L>
Surface<L> shape_surface(const S& scene, const Shape& shape, const Ray<L>& ray, const ShapeHit<L>& hit,
                         [[maybe_unused]] const MaskOf<L>& needed) {
    if constexpr (is_mesh<Shape>) {
        return mesh_surface<S::traits.smooth_normals>(scene.meshes[shape.mesh], ray, hit, needed);
    } else if constexpr (is_implicit<Shape>) {
        return implicit_surface(shape, ray, hit, field_of(scene, shape));
    } else {
        return shape.surface(ray, hit);
    }
}

template <class S, class Shape>
Bounds<typename S::Real> shape_bounds(const S& scene, const Shape& shape) {
    if constexpr (is_mesh<Shape>) {
        const MeshData& mesh = scene.meshes[shape.mesh];
        using R = typename S::Real;
        const Bounds<float> box = mesh.node_count == 0 ? Bounds<float>{} : bounds_of(mesh);
        return {lanes<R>(box.min), lanes<R>(box.max)};
    } else {
        return shape.bounds();
    }
}

/// Of a member.
template <class S, class Shape>
Bounds<typename S::Real> member_bounds(const S& scene, const Bare<Shape>& primitive) {
    if constexpr (requires { primitive.shape.inside_bounds(); }) {
        return primitive.shape.inside_bounds();
    } else {
        return shape_bounds(scene, primitive.shape);
    }
}
template <class S, class Shape, class R>
Bounds<R> member_bounds(const S& scene, const Placed<Shape, R>& primitive) {
    if constexpr (requires { primitive.shape.inside_bounds(); }) {
        return transform_inside(primitive.world_from_object, primitive.shape.inside_bounds());
    } else {
        return transform_bounds(primitive.world_from_object, shape_bounds(scene, primitive.shape));
    }
}

template <class S>
Bounds<typename S::Real> solid_bounds(const S& scene, std::uint32_t root) {
    using R = typename S::Real;
    return csg_bounds<R>(scene.csg_nodes, root, [&](const CsgNode& node) {
        Bounds<R> box;
        visit_member(scene, node.member,
                     [&](const auto& member) { box = member_bounds(scene, member.primitive); });
        return box;
    });
}

} // namespace detail

/// The rays as the primitive's shape sees them.
template <class Shape, class L>
const Ray<L>& to_object(const Bare<Shape>&, const Ray<L>& ray) {
    return ray;
}
template <class Shape, class R, class L>
Ray<L> to_object(const Placed<Shape, R>& primitive, const Ray<L>& ray) {
    return transform_ray(primitive.object_from_world, ray);
}

/// The surface, in world space, where the lanes in `needed` have hit this primitive; the others get anything.
/// `object_point`: the same point as the shape sees it.
template <class S, class Shape, class L>
Surface<L> surface_of(const S& scene, const Bare<Shape>& primitive, const Ray<L>& ray, const ShapeHit<L>& hit,
                      const MaskOf<L>& needed, Vec3<L>& object_point) {
    const Surface<L> surface = detail::shape_surface(scene, primitive.shape, ray, hit, needed);
    object_point = surface.point;
    return surface;
}
template <class S, class Shape, class R, class L>
Surface<L> surface_of(const S& scene, const Placed<Shape, R>& primitive, const Ray<L>& ray,
                      const ShapeHit<L>& hit, const MaskOf<L>& needed, Vec3<L>& object_point) {
    const Surface<L> object = detail::shape_surface(
        scene, primitive.shape, transform_ray(primitive.object_from_world, ray), hit, needed);
    object_point = object.point;
    return transform_surface(primitive.world_from_object, primitive.object_from_world, object);
}

/// The coordinates on the surface where the lanes in `needed` have hit this primitive at what surface_of gave
/// as their object points.
template <class S, class Primitive, class L>
Vec2<L> uv_of([[maybe_unused]] const S& scene, const Primitive& primitive, const Ray<L>& ray,
              const ShapeHit<L>& hit, [[maybe_unused]] const MaskOf<L>& needed,
              [[maybe_unused]] const Vec3<L>& object_point) {
    using Shape = decltype(primitive.shape);
    if constexpr (is_mesh<Shape>) {
        return mesh_uv(scene.meshes[primitive.shape.mesh], to_object(primitive, ray), hit, needed);
    } else if constexpr (has_uv<Shape>) {
        return primitive.shape.uv(to_object(primitive, ray), hit, object_point);
    } else {
        return {};
    }
}

namespace detail {

/// The gradients of the coordinates on the surface by the object's point.
template <class S, class Primitive, class L>
Vec2<Vec3<L>> object_uv_slopes([[maybe_unused]] const S& scene, const Primitive& primitive,
                               [[maybe_unused]] const Ray<L>& ray, const ShapeHit<L>& hit,
                               [[maybe_unused]] const MaskOf<L>& needed, const Vec3<L>& object_point) {
    using Shape = decltype(primitive.shape);
    if constexpr (is_mesh<Shape>) {
        return mesh_uv_slopes(scene.meshes[primitive.shape.mesh], hit, needed);
    } else if constexpr (requires { primitive.shape.template uv_slopes<L>(); }) {
        return primitive.shape.template uv_slopes<L>();
    } else if constexpr (has_uv<Shape>) {
        using Number = Dual<L, 3>;
        const Vec3<Number> point{Number::variable(object_point.x, 0), Number::variable(object_point.y, 1),
                                 Number::variable(object_point.z, 2)};
        const Vec2<Number> uv = primitive.shape.uv(ray, hit, point);
        return {{uv.x.d[0], uv.x.d[1], uv.x.d[2]}, {uv.y.d[0], uv.y.d[1], uv.y.d[2]}};
    } else {
        return {};
    }
}

template <class L>
Vec3<L> row_of(const Affine<RealOf<L>>& map, std::size_t i) {
    return {L(map.m[i][0]), L(map.m[i][1]), L(map.m[i][2])};
}

} // namespace detail

/// Gradients by the point in the world of what per-point functions read.
template <class L>
struct PointSlopes {
    std::array<Vec3<L>, 3> p; ///< of the point in object space
    Vec2<Vec3<L>> uv;
};

template <class Shape, class L>
std::array<Vec3<L>, 3> object_point_slopes(const Bare<Shape>&, const L&) {
    return {{{L(1), L(0), L(0)}, {L(0), L(1), L(0)}, {L(0), L(0), L(1)}}};
}
template <class Shape, class R, class L>
std::array<Vec3<L>, 3> object_point_slopes(const Placed<Shape, R>& primitive, const L&) {
    const Affine<R>& map = primitive.object_from_world;
    return {detail::row_of<L>(map, 0), detail::row_of<L>(map, 1), detail::row_of<L>(map, 2)};
}

/// Of the coordinates on the surface; arguments as of uv_of.
template <class S, class Shape, class L>
Vec2<Vec3<L>> uv_slopes_of(const S& scene, const Bare<Shape>& primitive, const Ray<L>& ray,
                           const ShapeHit<L>& hit, const MaskOf<L>& needed, const Vec3<L>& object_point) {
    return detail::object_uv_slopes(scene, primitive, ray, hit, needed, object_point);
}
template <class S, class Shape, class R, class L>
Vec2<Vec3<L>> uv_slopes_of(const S& scene, const Placed<Shape, R>& primitive, const Ray<L>& ray,
                           const ShapeHit<L>& hit, const MaskOf<L>& needed, const Vec3<L>& object_point) {
    const Vec2<Vec3<L>> slopes =
        detail::object_uv_slopes(scene, primitive, to_object(primitive, ray), hit, needed, object_point);
    return {transform_normal(primitive.object_from_world, slopes.x),
            transform_normal(primitive.object_from_world, slopes.y)};
}

template <class S, class Shape>
Bounds<typename S::Real> bounds_of(const S& scene, const Bare<Shape>& primitive) {
    if constexpr (is_csg<Shape>) {
        return detail::solid_bounds(scene, primitive.shape.root);
    } else {
        return detail::shape_bounds(scene, primitive.shape);
    }
}
template <class S, class Shape, class R>
Bounds<R> bounds_of(const S& scene, const Placed<Shape, R>& primitive) {
    if constexpr (is_csg<Shape>) {
        return detail::solid_bounds(scene, primitive.shape.root); // solids are bare
    } else {
        return transform_bounds(primitive.world_from_object, detail::shape_bounds(scene, primitive.shape));
    }
}

} // namespace scc::runtime
