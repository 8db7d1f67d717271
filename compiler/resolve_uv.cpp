#include "compiler/resolve_uv.h"

#include "compiler/function_term.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace scc::compiler {

namespace {

using runtime::Vec2;
using runtime::Vec3;

constexpr double inverse_pi = std::numbers::inv_pi;

/// As runtime::around.
Term around(const Term& x, const Term& z) {
    return angle(x, z) * (inverse_pi / 2) + 0.5;
}

/// As runtime::on_square.
Terms on_square(const Point& from_center, const Vec3<double>& normal, double radius) {
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(normal);
    return {from_center.along(axes.u) * (0.5 / radius) + 0.5,
            from_center.along(axes.v) * (0.5 / radius) + 0.5};
}

Terms uv_of(const runtime::Sphere<double>& sphere, const Point& p) {
    const Point d = p.relative_to(sphere.center);
    return {around(d.x, d.z), angle(d.y, root(d.x * d.x + d.z * d.z)) * inverse_pi + 0.5};
}

/// The face is that of the coordinate that is farthest out.
Terms uv_of(const runtime::Box<double>& box, const Point& p) {
    const Vec3<double> size = box.max - box.min;
    const auto fraction = [](const Term& x, double min, double extent) { return (x - min) * (1 / extent); };
    const Term x = fraction(p.x, box.min.x, size.x), y = fraction(p.y, box.min.y, size.y);
    const Term z = fraction(p.z, box.min.z, size.z);
    const auto out = [](const Term& t) { return absolute(t - 0.5); };
    const auto flipped = [](const Term& t) { return t.constant(1) - t; };
    const auto is_high = [](const Term& t) { return t.constant(0.5) <= t; };
    const Term on_x = (out(y) <= out(x)) * (out(z) <= out(x)), on_y = out(z) <= out(y);
    const Term u =
        choose(on_x, choose(is_high(x), flipped(z), z), choose(on_y, x, choose(is_high(z), x, flipped(x))));
    const Term v_on_y = choose(is_high(y), flipped(z), z);
    return {u, choose(on_x, y, choose(on_y, v_on_y, y))};
}

Terms uv_of(const runtime::Plane<double>& plane, const Point& p) {
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(plane.normal);
    return {p.along(axes.u), p.along(axes.v)};
}

Terms uv_of(const runtime::Disc<double>& disc, const Point& p) {
    return on_square(p.relative_to(disc.center), disc.normal, disc.radius);
}

/// The part is the nearest one.
Terms uv_about_axis(const Vec3<double>& from, const Vec3<double>& to, double radius_from, double radius_to,
                    bool caps, const Point& p) {
    const double height = length(to - from);
    const Vec3<double> up = (to - from) * (1 / height);
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(up);
    const Point d = p.relative_to(from);
    const Term x = d.along(axes.u), z = negative(d.along(axes.v)), along = d.along(up);
    const Terms side{around(x, z), along * (1 / height)};
    if (!caps) {
        return side;
    }
    const Term to_side =
        absolute(along * ((radius_to - radius_from) / height) + radius_from - root(x * x + z * z));
    const Term to_first = absolute(along), to_second = absolute(along - height);
    const Term on_side = to_side <= smaller(to_first, to_second), is_first = to_first <= to_second;
    // A cap without extent is a tip, which is on the side as well.
    const auto cap = [](double radius) { return radius > 0 ? radius : 1; };
    const Terms first = on_square(d, -up, cap(radius_from));
    const Terms second = on_square(p.relative_to(to), up, cap(radius_to));
    return {choose(on_side, side.x, choose(is_first, first.x, second.x)),
            choose(on_side, side.y, choose(is_first, first.y, second.y))};
}
Terms uv_of(const runtime::Cylinder<double>& c, const Point& p) {
    return uv_about_axis(c.from, c.to, c.radius, c.radius, c.caps, p);
}
Terms uv_of(const runtime::Cone<double>& c, const Point& p) {
    return uv_about_axis(c.from, c.to, c.radius_from, c.radius_to, c.caps, p);
}

/// The barycentric weights are linear in p: those of b and c have the gradients e2 x n / |n|^2 and
/// n x e1 / |n|^2, with the edges e1, e2 from a and n = e1 x e2.
Terms uv_of(const runtime::Triangle<double>& t, const Point& p) {
    const auto& [a, b, c] = t.points;
    const Vec3<double> e1 = b - a, e2 = c - a, n = cross(e1, e2);
    const Vec3<double> by_b = cross(e2, n) / dot(n, n), by_c = cross(n, e1) / dot(n, n);
    const Point d = p.relative_to(a);
    const auto linear = [&](double at_a, double at_b, double at_c) {
        return d.along(by_b * (at_b - at_a) + by_c * (at_c - at_a)) + at_a;
    };
    return {linear(t.uvs[0].x, t.uvs[1].x, t.uvs[2].x), linear(t.uvs[0].y, t.uvs[1].y, t.uvs[2].y)};
}

Terms uv_of(const runtime::Torus<double>& torus, const Point& p) {
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(torus.axis);
    const Point d = p.relative_to(torus.center);
    const Term x = d.along(axes.u), z = negative(d.along(axes.v));
    return {around(x, z), around(d.along(torus.axis), root(x * x + z * z) - torus.major)};
}

Terms uv_of(const runtime::Implicit<double>&, const Point& p) {
    return {p.x, p.y};
}

Terms uv_of(const runtime::Quadric<double>&, const Point& p) {
    return {p.x, p.y};
}

template <class Shape>
concept ComputesUv = requires(const Shape& shape, const Point& p) {
    uv_of(shape, p);
};

// ---- in a scene ------------------------------------------------------------------------------------------

std::string key_of(double v) {
    return fmt::format("{} ", v);
}
std::string key_of(bool v) {
    return v ? "1 " : "0 ";
}
std::string key_of(const Vec2<double>& v) {
    return key_of(v.x) + key_of(v.y);
}
std::string key_of(const Vec3<double>& v) {
    return key_of(v.x) + key_of(v.y) + key_of(v.z);
}
template <class T, std::size_t n>
std::string key_of(const std::array<T, n>& list) {
    std::string key;
    for (const T& element : list) {
        key += key_of(element);
    }
    return key;
}
/// The same for shapes with the same coordinates on their surfaces.
template <class Shape>
std::string shape_key(const Shape& shape) {
    std::string key(Shape::name);
    if constexpr (requires { Shape::fields(); }) {
        std::apply([&](const auto&... field) { ((key += " " + key_of(shape.*field.member)), ...); },
                   Shape::fields());
    }
    return key;
}

class UvResolver {
public:
    explicit UvResolver(const ir::Scene& scene) : scene_(scene) {
        for (const ir::Material& material : scene.materials) {
            names_.insert(material.name);
        }
    }

    ir::Scene run() {
        for (ir::Object& object : scene_.objects) {
            resolve(object);
        }
        for (ir::Object& member : scene_.members) {
            resolve(member);
        }
        for (ir::ObjectArray& array : scene_.arrays) {
            for (ir::ObjectColumn& column : array.columns) {
                resolve(column, array.rounds);
            }
        }
        return std::move(scene_);
    }

private:
    bool reads_uv(const runtime::Sides& sides) const {
        return ir::material_reads(scene_, sides.front, ir::Input::uv_x, ir::Input::uv_y) ||
               ir::material_reads(scene_, sides.back, ir::Input::uv_x, ir::Input::uv_y);
    }

    void resolve(ir::Object& object) {
        std::visit([&](const auto& shape) { object.sides = on(shape, object.sides, object.path); },
                   object.shape);
    }

    void resolve(ir::ObjectColumn& column, std::size_t rounds) {
        bool reads = false;
        for (const runtime::Sides& sides : column.sides) {
            reads = reads || reads_uv(sides);
        }
        if (!reads) {
            return;
        }
        std::vector<runtime::Sides> resolved;
        for (std::size_t round = 0; round < rounds; ++round) {
            std::visit(
                [&](const auto& shapes) {
                    resolved.push_back(on(shapes[round], column.sides_of(round), column.path_of(round)));
                },
                column.shapes);
        }
        column.sides = std::move(resolved);
    }

    template <class Shape>
    runtime::Sides on(const Shape& shape, const runtime::Sides& sides, const std::string& path) {
        if constexpr (ComputesUv<Shape>) {
            if (reads_uv(sides)) {
                return {material_on(shape, sides.front, path), material_on(shape, sides.back, path)};
            }
        }
        return sides;
    }

    template <class Shape>
    std::uint32_t material_on(const Shape& shape, std::uint32_t material, const std::string& path) {
        if (!ir::material_reads(scene_, material, ir::Input::uv_x, ir::Input::uv_y)) {
            return material;
        }
        const auto [place, is_new] = materials_.try_emplace(
            {material, shape_key(shape)}, static_cast<std::uint32_t>(scene_.materials.size()));
        if (!is_new) {
            return place->second;
        }
        ir::Material made = scene_.materials[material];
        made.name = unique_name(fmt::format("{} of {}", made.name, path));
        std::map<std::int32_t, std::int32_t> functions;
        runtime::Phong<double>& p = made.phong;
        for (std::int32_t* index :
             {&p.ambient.function, &p.diffuse.function, &p.specular.function, &p.emission.function,
              &p.reflect.function, &p.transmit.function, &p.shininess.function, &p.bump}) {
            if (*index == runtime::no_function) {
                continue;
            }
            const auto [known, is_first] = functions.try_emplace(*index, *index);
            const ir::Function& function = scene_.functions[static_cast<std::size_t>(*index)];
            if (is_first && function.reads(ir::Input::uv_x, ir::Input::uv_y)) {
                known->second = static_cast<std::int32_t>(scene_.functions.size());
                scene_.functions.push_back(with_uv_of(shape, function));
            }
            *index = known->second;
        }
        scene_.materials.push_back(std::move(made));
        return place->second;
    }

    std::string unique_name(const std::string& wanted) {
        std::string name = wanted;
        for (int i = 2; !names_.insert(name).second; ++i) {
            name = fmt::format("{} {}", wanted, i);
        }
        return name;
    }

    ir::Scene scene_;
    std::set<std::string> names_;
    std::map<std::pair<std::uint32_t, std::string>, std::uint32_t> materials_;
};

} // namespace

ir::Function with_uv_of(const ir::Shape& shape, const ir::Function& function) {
    FunctionBuilder builder;
    const auto input = [&](std::string_view name) { return Term{&builder, builder.input(name)}; };
    const Terms uv = std::visit(
        [&](const auto& s) -> Terms {
            if constexpr (requires { uv_of(s, std::declval<Point>()); }) {
                return uv_of(s, Point{input("p.x"), input("p.y"), input("p.z")});
            } else {
                return {input("uv.x"), input("uv.y")};
            }
        },
        shape);
    const std::vector<std::uint32_t> moved = builder.include(function, [&](ir::Input which) {
        return which == ir::Input::uv_x   ? uv.x.node
               : which == ir::Input::uv_y ? uv.y.node
                                          : builder.input(name(which));
    });
    std::vector<lang::Scalar> results;
    for (const std::uint32_t result : function.results) {
        results.push_back({0, moved[result]});
    }
    ir::Function made = builder.finish(results);
    made.name = function.name;
    return made;
}

ir::Scene resolve_uv(const ir::Scene& scene) {
    return UvResolver(scene).run();
}

} // namespace scc::compiler
