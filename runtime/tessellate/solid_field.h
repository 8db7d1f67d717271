#pragma once

#include "runtime/math/dual.h"
#include "runtime/math/interval.h"
#include "runtime/primitive.h"
#include "runtime/tessellate/triangles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

/// A solid as a function of the point, negative inside: the largest or smallest of smooth functions, one for
/// each face of its members.
namespace scc::runtime {

/// A smooth function of the point, given in the world or in a space of its own.
template <class R>
struct SmoothSurface {
    enum class Kind : std::uint8_t {
        plane,   ///< w . p - radius
        ball,    ///< about origin
        tube,    ///< about the line through origin along w
        cone,    ///< the same, of radius + slope * height
        torus,   ///< about the circle of `radius` around the line, with a tube of radius `slope`
        quadric, ///< u . (x^2, y^2, z^2) + v . (x y, y z, z x) + w . p + radius
        field    ///< the scene's field_function
    };
    Kind kind = Kind::plane;
    Vec3<R> origin{};
    Vec3<R> u{}, v{}, w{}; ///< right-handed frame, w along the axis
    R radius = 0;
    R slope = 0;
    std::int32_t field = 0;
    bool placed = false;
    Affine<R> own_from_world{};

    friend bool operator==(const SmoothSurface&, const SmoothSurface&) = default;
};

/// A part of a solid's surface: where its function is 0, and the function times `sign` negative inside.
template <class R>
struct SolidFace {
    std::uint32_t surface = 0;
    R sign = 1;
    PrimitiveRef member{};  ///< among the scene's members, if the solid is made of others
    std::uint32_t part = 0; ///< as ShapeHit::part
};

/// A node of a solid's function; those of its operands follow it.
struct SolidNode {
    bool is_max = false;
    std::uint32_t size = 1; ///< nodes in this subtree, this one among them; 1: a face
    std::uint32_t face = 0;
};
using SolidProgram = std::vector<SolidNode>;

enum class Side : std::int8_t { inside = -1, open = 0, outside = 1 };

template <class R>
struct FieldValue {
    R value = 0;
    std::uint32_t face = 0; ///< the one that has the value, the first of several in the source
};

/// A surface's function around a point.
template <class R>
struct LocalPlane {
    R distance = 0;   ///< to first order, in world units
    Vec3<R> normal{}; ///< unit; towards larger values
    bool usable = false;
};

template <class S>
class SolidField {
public:
    using R = typename S::Real;
    using Surface = SmoothSurface<R>;
    using Face = SolidFace<R>;

    /// Of a solid made of others. Surfaces of different members that are one within rounding become one.
    static SolidField of_solid(const S& scene, std::uint32_t root) {
        SolidField field(scene, detail::solid_bounds(scene, root));
        field.add_node(root, false);
        return field;
    }
    /// Of an implicit surface or a quadric.
    template <class Primitive>
    static SolidField of_implicit(const S& scene, const Primitive& primitive) {
        SolidField field(scene, detail::member_bounds(scene, primitive));
        field.add_primitive(primitive, {}, false);
        return field;
    }

    const std::vector<Surface>& surfaces() const { return surfaces_; }
    const std::vector<Face>& faces() const { return faces_; }
    const SolidProgram& program() const { return program_; }
    const Bounds<R>& bounds() const { return bounds_; }

    FieldValue<R> value(const SolidNode* program, const Vec3<R>& p) const {
        if (program->size == 1) {
            const Face& face = faces_[program->face];
            return {face.sign * function(surfaces_[face.surface], p), program->face};
        }
        const SolidNode* const end = program + program->size;
        const SolidNode* child = program + 1;
        FieldValue<R> result = value(child, p);
        for (child += child->size; child < end; child += child->size) {
            const FieldValue<R> other = value(child, p);
            const bool further = program->is_max ? other.value > result.value : other.value < result.value;
            const R apart = std::abs(other.value - result.value);
            if (further) {
                result = {other.value, apart > slack_ ? other.face : result.face};
            }
        }
        return result;
    }

    LocalPlane<R> plane_at(std::uint32_t surface, const Vec3<R>& p) const {
        using D = Dual<R, 3>;
        const D d = function(surfaces_[surface],
                             Vec3<D>{D::variable(p.x, 0), D::variable(p.y, 1), D::variable(p.z, 2)});
        const Vec3<R> gradient{d.d[0], d.d[1], d.d[2]};
        const R size = length(gradient);
        const bool usable = size > 0 && size < infinity<R>() && std::isfinite(d.v);
        return usable ? LocalPlane<R>{d.v / size, gradient * (1 / size), true} : LocalPlane<R>{};
    }

    /// Bounds of the function's derivatives by x, y and z in a box.
    std::array<Interval<R>, 3> slopes(std::uint32_t surface, const Bounds<R>& box) const {
        using I = Interval<R>;
        using D = Dual<I, 3>;
        const D d = function(surfaces_[surface], Vec3<D>{D::variable(I(box.min.x, box.max.x), 0),
                                                         D::variable(I(box.min.y, box.max.y), 1),
                                                         D::variable(I(box.min.z, box.max.z), 2)});
        return {d.d[0], d.d[1], d.d[2]};
    }

    /// What is left to know of the function in a box, of which `program` has all: appended to `left`, if it
    /// is open where the solid is. What lies on both sides of one surface only by rounding, as a film between
    /// two solids that touch, is decided by what is around it.
    Side reduce(const SolidNode* program, const Bounds<R>& box, SolidProgram& left) const {
        ++round_;
        const std::size_t begin = left.size();
        Side side = reduced(program, left, [&](std::uint32_t surface) { return side_of(surface, box); });
        if (side == Side::open && left.size() - begin > 1) {
            side = without_irrelevant(left, begin);
        }
        return side;
    }

    /// f(surface) once for each that a program has.
    template <class F>
    void for_each_surface(const SolidNode* program, F&& f) const {
        for (std::uint32_t i = 0; i < program->size; ++i) {
            const SolidNode& node = program[i];
            if (node.size == 1 && is_first(program, i)) {
                f(faces_[node.face]);
            }
        }
    }

private:
    static constexpr int most_tried = 6; ///< surfaces of which all combinations of sides are looked at

    SolidField(const S& scene, const Bounds<R>& bounds) : scene_(scene), bounds_(bounds) {
        size_ = length(bounds.max - bounds.min) +
                largest_component(maximum(absolute(bounds.min), absolute(bounds.max)));
        slack_ = size_ * 64 * std::numeric_limits<R>::epsilon();
    }

    bool is_first(const SolidNode* program, std::uint32_t at) const {
        const std::uint32_t surface = faces_[program[at].face].surface;
        for (std::uint32_t i = 0; i < at; ++i) {
            if (program[i].size == 1 && faces_[program[i].face].surface == surface) {
                return false;
            }
        }
        return true;
    }

    // ---- the functions

    template <class T>
    T function(const Surface& s, const Vec3<T>& world) const {
        const Vec3<T> p = s.placed ? transform_point(s.own_from_world, world) : world;
        const auto along = [](const Vec3<R>& axis, const Vec3<T>& q) {
            return T(axis.x) * q.x + T(axis.y) * q.y + T(axis.z) * q.z;
        };
        const Vec3<T> q{p.x - T(s.origin.x), p.y - T(s.origin.y), p.z - T(s.origin.z)};
        const auto curved = [&](const T& squared) { // of a unit gradient where it is 0
            return (squared - T(s.radius * s.radius)) * T(1 / (2 * s.radius));
        };
        switch (s.kind) {
        case Surface::Kind::plane:
            return along(s.w, p) - T(s.radius);
        case Surface::Kind::ball:
            return curved(square(q.x) + square(q.y) + square(q.z));
        case Surface::Kind::tube:
            return curved(square(along(s.u, q)) + square(along(s.v, q)));
        case Surface::Kind::cone:
            return square_root(square(along(s.u, q)) + square(along(s.v, q))) -
                   (T(s.radius) + T(s.slope) * along(s.w, q));
        case Surface::Kind::torus: {
            const T across = square_root(square(along(s.u, q)) + square(along(s.v, q))) - T(s.radius);
            return (square(across) + square(along(s.w, q)) - T(s.slope * s.slope)) * T(1 / (2 * s.slope));
        }
        case Surface::Kind::quadric:
            return along(s.u, {square(p.x), square(p.y), square(p.z)}) +
                   along(s.v, {p.x * p.y, p.y * p.z, p.z * p.x}) + along(s.w, p) + T(s.radius);
        case Surface::Kind::field:
            break;
        }
        return scene_.field_function(s.field, p);
    }

    Side side_of(std::uint32_t surface, const Bounds<R>& box) const {
        if (sides_.size() < surfaces_.size()) {
            sides_.resize(surfaces_.size());
        }
        KnownSide& known = sides_[surface];
        if (known.round != round_) {
            using I = Interval<R>;
            const I range =
                function(surfaces_[surface],
                         Vec3<I>{I(box.min.x, box.max.x), I(box.min.y, box.max.y), I(box.min.z, box.max.z)});
            known = {round_, range.min > 0 ? Side::outside : range.max < 0 ? Side::inside : Side::open};
        }
        return known.side;
    }

    // ---- programs

    /// Appends what is left of a subtree where side(surface) says on which side of surfaces it is looked at.
    template <class SideOf>
    Side reduced(const SolidNode* node, SolidProgram& left, const SideOf& side_of_surface) const {
        if (node->size == 1) {
            const Face& face = faces_[node->face];
            const Side side = side_of_surface(face.surface);
            if (side == Side::open) {
                left.push_back(*node);
                return side;
            }
            return (side == Side::outside) == (face.sign > 0) ? Side::outside : Side::inside;
        }
        const Side decisive = node->is_max ? Side::outside : Side::inside;
        const std::size_t begin = left.size();
        left.push_back({node->is_max, 0, 0});
        int open = 0;
        const SolidNode* const end = node + node->size;
        for (const SolidNode* child = node + 1; child < end; child += child->size) {
            const Side side = reduced(child, left, side_of_surface);
            if (side == decisive) {
                left.resize(begin);
                return decisive;
            }
            open += side == Side::open ? 1 : 0;
        }
        if (open == 0) {
            left.resize(begin);
            return decisive == Side::outside ? Side::inside : Side::outside;
        }
        if (open == 1) {
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(begin));
        } else {
            left[begin].size = static_cast<std::uint32_t>(left.size() - begin);
        }
        return Side::open;
    }

    /// Drops surfaces on whose sides the result does not depend, as far as that can be tried.
    Side without_irrelevant(SolidProgram& left, std::size_t begin) const {
        std::vector<std::uint32_t> tried;
        for_each_surface(&left[begin], [&](const Face& face) { tried.push_back(face.surface); });
        if (tried.size() > most_tried || tried.size() == left.size() - begin - operators(left, begin)) {
            return Side::open; // too many, or each occurs once: all matter
        }
        const std::uint32_t combinations = 1U << tried.size();
        std::uint32_t relevant = 0;
        std::vector<Side> results(combinations);
        SolidProgram none;
        for (std::uint32_t c = 0; c < combinations; ++c) {
            results[c] = reduced(&left[begin], none, [&](std::uint32_t surface) {
                const auto at = std::find(tried.begin(), tried.end(), surface) - tried.begin();
                return (c >> at & 1U) != 0 ? Side::outside : Side::inside;
            });
        }
        for (std::uint32_t i = 0; i < tried.size(); ++i) {
            for (std::uint32_t c = 0; c < combinations; ++c) {
                relevant |= results[c] != results[c ^ (1U << i)] ? 1U << i : 0U;
            }
        }
        const SolidProgram before(left.begin() + static_cast<std::ptrdiff_t>(begin), left.end());
        left.resize(begin);
        return reduced(before.data(), left, [&](std::uint32_t surface) {
            const auto at = std::find(tried.begin(), tried.end(), surface) - tried.begin();
            return (relevant >> at & 1U) != 0 ? Side::open : Side::inside;
        });
    }
    static std::size_t operators(const SolidProgram& program, std::size_t begin) {
        return static_cast<std::size_t>(std::count_if(program.begin() + static_cast<std::ptrdiff_t>(begin),
                                                      program.end(),
                                                      [](const SolidNode& node) { return node.size > 1; }));
    }

    // ---- from the scene's tree

    void add_node(std::uint32_t at, bool inverted) {
        const CsgNode& node = scene_.csg_nodes[at];
        if (node.op == CsgOp::member) {
            visit_member(scene_, node.member, [&](const auto& member) {
                if constexpr (is_mesh<decltype(member.primitive.shape)>) {
                    throw std::logic_error("a mesh in a solid has no field");
                } else {
                    add_primitive(member.primitive, node.member, inverted);
                }
            });
            return;
        }
        add_group((node.op == CsgOp::unite) == inverted, [&] {
            for (std::uint32_t child = at + 1; child < at + node.size;
                 child += scene_.csg_nodes[child].size) {
                add_node(child, inverted != (node.op == CsgOp::subtract && child > at + 1));
            }
        });
    }

    template <class AddAll>
    void add_group(bool is_max, AddAll&& add_all) {
        const std::size_t begin = program_.size();
        program_.push_back({is_max, 0, 0});
        add_all();
        if (program_.size() == begin + 2) {
            program_.erase(program_.begin() + static_cast<std::ptrdiff_t>(begin));
        } else {
            program_[begin].size = static_cast<std::uint32_t>(program_.size() - begin);
        }
    }

    template <class Shape>
    void add_primitive(const Bare<Shape>& primitive, const PrimitiveRef& ref, bool inverted) {
        place_ = nullptr;
        add_shape(primitive.shape, {0, inverted ? R(-1) : R(1), ref, 0});
    }
    template <class Shape>
    void add_primitive(const Placed<Shape, R>& primitive, const PrimitiveRef& ref, bool inverted) {
        place_ = &primitive.object_from_world;
        add_shape(primitive.shape, {0, inverted ? R(-1) : R(1), ref, 0});
    }

    void add_face(Face face, Surface surface, std::uint32_t part) {
        if (place_ != nullptr) {
            put_in_world(surface);
        }
        face.part = part;
        R sign = 1;
        face.surface = index_of(surface, sign);
        face.sign *= sign;
        program_.push_back({false, 1, static_cast<std::uint32_t>(faces_.size())});
        faces_.push_back(face);
    }
    void put_in_world(Surface& surface) const {
        if (surface.kind != Surface::Kind::plane) {
            surface.placed = true;
            surface.own_from_world = *place_;
            return;
        }
        const R shift = dot(surface.w, translation_of(*place_));
        const Vec3<R> normal = transform_normal(*place_, surface.w);
        const R size = length(normal);
        surface.w = normal * (1 / size);
        surface.radius = (surface.radius - shift) / size;
    }
    /// Of an earlier one that is the same within rounding, turned over where sign becomes -1, or of a new
    /// one.
    std::uint32_t index_of(const Surface& surface, R& sign) {
        constexpr std::size_t most_compared = 4096;
        const std::size_t first = surfaces_.size() > most_compared ? surfaces_.size() - most_compared : 0;
        for (std::size_t i = first; i < surfaces_.size(); ++i) {
            const Surface& other = surfaces_[i];
            if (surface.kind == Surface::Kind::plane && other.kind == surface.kind) {
                const R cosine = dot(surface.w, other.w);
                const R turn = cosine < 0 ? R(-1) : R(1);
                if (length(surface.w * turn - other.w) * size_ <= slack_ * 8 &&
                    std::abs(surface.radius * turn - other.radius) <= slack_ * 8) {
                    sign = turn;
                    return static_cast<std::uint32_t>(i);
                }
            } else if (surface == other) {
                return static_cast<std::uint32_t>(i);
            }
        }
        surfaces_.push_back(surface);
        return static_cast<std::uint32_t>(surfaces_.size() - 1);
    }

    static Surface plane(const Vec3<R>& normal, R offset) {
        Surface s;
        s.w = normal;
        s.radius = offset;
        return s;
    }
    static Surface about_axis(typename Surface::Kind kind, const Vec3<R>& from, const Vec3<R>& axis,
                              R radius) {
        Surface s;
        s.kind = kind;
        s.origin = from;
        s.w = axis;
        const auto [u, v] = frame_around(axis);
        s.u = u;
        s.v = v;
        s.radius = radius;
        return s;
    }
    // One overload per shape with an inside: the faces that it has in common.

    void add_shape(const Sphere<R>& s, const Face& face) {
        add_face(face, about_axis(Surface::Kind::ball, s.center, {0, 0, 1}, s.radius), 0);
    }
    void add_shape(const Plane<R>& s, const Face& face) { add_face(face, plane(s.normal, s.offset), 0); }
    void add_shape(const Box<R>& b, const Face& face) {
        add_group(face.sign > 0, [&] {
            add_face(face, plane({-1, 0, 0}, -b.min.x), 0);
            add_face(face, plane({1, 0, 0}, b.max.x), 1);
            add_face(face, plane({0, -1, 0}, -b.min.y), 2);
            add_face(face, plane({0, 1, 0}, b.max.y), 3);
            add_face(face, plane({0, 0, -1}, -b.min.z), 4);
            add_face(face, plane({0, 0, 1}, b.max.z), 5);
        });
    }
    void add_shape(const Cylinder<R>& c, const Face& face) {
        const Vec3<R> axis = normalize(c.to - c.from);
        add_between(c.from, c.to, face, about_axis(Surface::Kind::tube, c.from, axis, c.radius));
    }
    void add_shape(const Cone<R>& c, const Face& face) {
        const R height = length(c.to - c.from);
        Surface side = about_axis(Surface::Kind::cone, c.from, (c.to - c.from) * (1 / height), c.radius_from);
        side.slope = (c.radius_to - c.radius_from) / height;
        add_between(c.from, c.to, face, side);
    }
    void add_between(const Vec3<R>& from, const Vec3<R>& to, const Face& face, const Surface& side) {
        add_group(face.sign > 0, [&] {
            add_face(face, side, 0);
            add_face(face, plane(-side.w, -dot(side.w, from)), 1);
            add_face(face, plane(side.w, dot(side.w, to)), 2);
        });
    }
    void add_shape(const Torus<R>& t, const Face& face) {
        Surface surface = about_axis(Surface::Kind::torus, t.center, t.axis, t.major);
        surface.slope = t.minor;
        add_face(face, surface, 0);
    }
    void add_shape(const Quadric<R>& q, const Face& face) {
        Surface surface;
        surface.kind = Surface::Kind::quadric;
        surface.u = q.squares;
        surface.v = q.products;
        surface.w = q.linear;
        surface.radius = q.constant;
        add_face(face, surface, 0);
    }
    void add_shape(const Implicit<R>& s, const Face& face) {
        add_group(face.sign > 0, [&] {
            s.within.visit([&](const auto& container) { add_shape(container, face); });
            Surface field;
            field.kind = Surface::Kind::field;
            field.field = s.field;
            add_face(face, field, field_part);
        });
    }

    struct KnownSide {
        std::uint64_t round = 0;
        Side side = Side::open;
    };

    const S& scene_;
    Bounds<R> bounds_;
    R size_ = 1;                       ///< of the largest coordinates
    R slack_ = 0;                      ///< surfaces no farther apart are one
    const Affine<R>* place_ = nullptr; ///< of the member that is being added
    std::vector<Surface> surfaces_;
    std::vector<Face> faces_;
    SolidProgram program_;
    mutable std::uint64_t round_ = 0;      ///< counts boxes that were looked at
    mutable std::vector<KnownSide> sides_; ///< of the surfaces in the last ones
};

} // namespace scc::runtime
