#pragma once

#include "runtime/test/tracing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

namespace scc::runtime::test {

/// How many of its rays a property test casts: so many times `count` as the environment's SCC_PROPERTY_SCALE
/// says, 250 for 10^6 rays and more in each.
inline int property_count(int count) {
    const char* const scale = std::getenv("SCC_PROPERTY_SCALE");
    return count * (scale != nullptr ? std::max(std::atoi(scale), 1) : 1);
}

/// Random numbers, shapes and maps. The seed is fixed, so every run is the same.
template <class R>
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    R number(double low, double high) {
        return static_cast<R>(std::uniform_real_distribution<double>(low, high)(engine_));
    }
    Vec3<R> vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    Vec3<R> direction() {
        while (true) {
            const Vec3<R> v = vector(1);
            const R squared = dot(v, v);
            if (squared > R(0.01) && squared < 1) {
                return normalize(v);
            }
        }
    }

    /// Rotation, non-uniform scale, shear and, every other time, a mirror, then a translation.
    Affine<double> map(double distance) {
        Affine<double> result;
        for (auto& row : result.m) {
            for (int column = 0; column < 3; ++column) {
                row[column] = double(number(-1, 1));
            }
        }
        for (int i = 0; i < 3; ++i) {
            result.m[i][i] += result.m[i][i] < 0 ? -1 : 1;
            result.m[i][3] = double(number(-distance, distance));
        }
        const double d = determinant(result);
        return std::abs(d) > 0.3 && std::abs(d) < 6 ? result : map(distance);
    }

    std::mt19937& engine() { return engine_; }

private:
    std::mt19937 engine_;
};

template <class R>
void randomize(Sphere<R>& s, Random<R>& random, double distance) {
    s = {random.vector(distance), random.number(0.3, 2)};
}
template <class R>
void randomize(Box<R>& s, Random<R>& random, double distance) {
    s.min = random.vector(distance);
    s.max = s.min + Vec3<R>{random.number(0.5, 2), random.number(0.5, 2), random.number(0.5, 2)};
}
template <class R>
void randomize(Plane<R>& s, Random<R>& random, double distance) {
    s = {random.direction(), random.number(-distance, distance)};
}
template <class R>
void randomize(Cylinder<R>& s, Random<R>& random, double distance) {
    const Vec3<R> from = random.vector(distance);
    s = {from, from + random.direction() * random.number(0.5, 3), random.number(0.2, 1.5),
         random.number(0, 1) < 0.5};
}
template <class R>
void randomize(Cone<R>& s, Random<R>& random, double distance) {
    const Vec3<R> from = random.vector(distance);
    const R wide = random.number(0.2, 1.5), kind = random.number(0, 1);
    const R narrow = kind < R(0.3) ? R(0) : kind < R(0.4) ? wide : wide * random.number(0.01, 1.01);
    const bool upwards = random.number(0, 1) < 0.5;
    s = {from, from + random.direction() * random.number(0.2, 3), upwards ? narrow : wide,
         upwards ? wide : narrow, random.number(0, 1) < 0.5};
}
template <class R>
void randomize(Disc<R>& s, Random<R>& random, double distance) {
    const R radius = random.number(0.5, 2);
    s = {random.vector(distance), random.direction(), radius, radius * random.number(0, 0.7)};
}
template <class R>
void randomize(Torus<R>& s, Random<R>& random, double distance) {
    const R major = random.number(0.4, 1.5);
    s = {random.vector(distance), random.direction(), major, major * random.number(0.05, 1)};
}
/// Of any kind, but not far from the origin.
template <class R>
void randomize(Quadric<R>& s, Random<R>& random, double) {
    s = {random.vector(1.5), random.vector(1), random.vector(0.5), random.number(-1.5, 1)};
    s.squares.x = random.number(0, 1) < 0.2 ? R(0) : s.squares.x;
    s.products = random.number(0, 1) < 0.3 ? Vec3<R>{} : s.products;
}
template <class R>
void randomize(Triangle<R>& s, Random<R>& random, double distance) {
    const Vec3<R> corner = random.vector(distance);
    do {
        s.points = {corner, corner + random.vector(2), corner + random.vector(2)};
    } while (length(cross(s.points[1] - s.points[0], s.points[2] - s.points[0])) < R(0.5));
}

template <class R>
void randomize(Implicit<R>& s, Random<R>& random, double distance) {
    s.within = Container<R>::of(Sphere<R>{random.vector(distance), random.number(0.3, 2)});
}
/// Gives an implicit surface a ball in its container as its field; of other shapes nothing.
template <class Shape, class R>
void add_field(Shape& shape, DynamicScene<R>& scene) {
    if constexpr (is_implicit<Shape>) {
        const Container<R>& within = shape.within;
        const auto constant = [](R value) { return Instruction<R>{Opcode::constant, {}, value}; };
        shape.field = static_cast<std::int32_t>(scene.functions.size());
        scene.functions.push_back({{{Opcode::p_x},
                                    {Opcode::p_y},
                                    {Opcode::p_z},
                                    constant(within.first.x),
                                    constant(within.first.y),
                                    constant(within.first.z),
                                    {Opcode::sub, {0, 3}},
                                    {Opcode::sub, {1, 4}},
                                    {Opcode::sub, {2, 5}},
                                    {Opcode::square, {6}},
                                    {Opcode::square, {7}},
                                    {Opcode::square, {8}},
                                    {Opcode::add, {9, 10}},
                                    {Opcode::add, {12, 11}},
                                    constant(within.radius * within.radius * R(0.75)),
                                    {Opcode::sub, {13, 14}}},
                                   {15}});
    }
}

/// A sphere of 20 4^level triangles, counter-clockwise from outside.
inline MeshStorage ball_mesh(int level, double radius, const Vec3<double>& center) {
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec3<double>> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                     {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                     {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<std::uint32_t> indices{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                       4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                       6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int step = 0; step < level; ++step) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (fresh) {
                points.push_back((points[a] + points[b]) * 0.5);
            }
            return it->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        indices = std::move(finer);
    }
    std::vector<float> positions, normals;
    for (const Vec3<double>& p : points) {
        const Vec3<double> n = normalize(p), q = center + n * radius;
        positions.insert(positions.end(), {float(q.x), float(q.y), float(q.z)});
        normals.insert(normals.end(), {float(n.x), float(n.y), float(n.z)});
    }
    return build_mesh(positions, indices, std::move(normals), indices);
}

inline std::vector<TrianglePlace> places_of(const MeshStorage& mesh) {
    std::vector<TrianglePlace> places;
    for (const BvhNode& node : mesh.nodes) {
        for (const std::uint32_t child : node.child) {
            for (std::uint32_t i = 0; is_leaf(child) && i < leaf_of(child).count; ++i) {
                places.push_back({leaf_of(child).first, leaf_of(child).count, i});
            }
        }
    }
    return places;
}

/// A random shape, bare or placed, alone in a scene.
template <class Shape, class R>
struct SingleShape {
    DynamicScene<R> scene;
    MeshStorage mesh;
    Shape shape{};
    Affine<R> world_from_object{};
    bool placed = false;

    SingleShape(Random<R>& random, bool is_placed, double distance) : placed(is_placed) {
        if constexpr (is_mesh<Shape>) {
            mesh = ball_mesh(1, 1.5, lanes<double>(random.vector(placed ? 1 : distance)));
            scene.meshes.push_back(mesh.data());
        } else {
            randomize(shape, random, placed ? 1 : distance);
            add_field(shape, scene);
        }
        if (placed) {
            const Affine<long double> map = affine_cast<long double>(random.map(distance));
            world_from_object = affine_cast<R>(map);
            scene.add(Placed<Shape, R>{shape, world_from_object, affine_cast<R>(inverse(map)), {}});
        } else {
            scene.add(Bare<Shape>{shape, {}});
        }
    }

    /// In world space, of the shape or of a part of an unbounded one.
    Bounds<R> bounds() const {
        if constexpr (is_bounded<Shape>) {
            return placed ? bounds_of(scene, scene.primitives(Of<Placed<Shape, R>>{})[0])
                          : bounds_of(scene, scene.primitives(Of<Bare<Shape>>{})[0]);
        } else if constexpr (requires { shape.squares; }) {
            const Bounds<R> b{{-2, -2, -2}, {2, 2, 2}};
            return placed ? transform_bounds(world_from_object, b) : b;
        } else {
            const Vec3<R> p = normalize(shape.normal) * shape.offset;
            const Bounds<R> b{p - Vec3<R>{1, 1, 1}, p + Vec3<R>{1, 1, 1}};
            return placed ? transform_bounds(world_from_object, b) : b;
        }
    }

    Ray<R> ray_towards(Random<R>& random) const {
        const Bounds<R> b = bounds();
        const Vec3<R> d = b.max - b.min;
        const Vec3<R> target =
            b.min + Vec3<R>{d.x * random.number(0, 1), d.y * random.number(0, 1), d.z * random.number(0, 1)};
        const Vec3<R> org = b.center() + random.direction() * (length(d) * random.number(0.6, 3));
        return {org, (target - org) * random.number(0.3, 3)};
    }

    struct Place {
        Surface<R> surface;
        Vec3<R> object_point;
    };
    Place surface(const Ray<R>& ray, const Hit<R>& hit) const {
        Place result;
        for_each_primitive(scene, hit, true, [&](const auto& primitive, bool here, bool, std::uint32_t) {
            result.surface = surface_of(scene, primitive, ray, hit.shape, here, result.object_point);
        });
        return result;
    }
};

template <class R>
bool is_hit(const Hit<R>& hit) {
    return hit.kind != no_kind;
}

template <class L>
void set_ray(Ray<L>& rays, int i, const Ray<RealOf<L>>& ray) {
    const auto put = [&](Vec3<L>& to, const Vec3<RealOf<L>>& from) {
        set_lane(to.x, i, from.x);
        set_lane(to.y, i, from.y);
        set_lane(to.z, i, from.z);
    };
    put(rays.org, ray.org);
    put(rays.dir, ray.dir);
    set_lane(rays.t_min, i, ray.t_min);
    set_lane(rays.t_max, i, ray.t_max);
}

} // namespace scc::runtime::test
