#include "compiler/resolve_bumps.h"

#include "compiler/bounds.h"
#include "compiler/derivative.h"
#include "compiler/function_term.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <array>
#include <set>
#include <type_traits>
#include <utility>

namespace scc::compiler {

namespace {

using runtime::Vec3;

// ---- F, part by part --------------------------------------------------------------------------------------

std::vector<Term> residuals_of(const runtime::Sphere<double>& sphere, const Point& p) {
    const Point d = p.relative_to(sphere.center);
    return {d.x * d.x + d.y * d.y + d.z * d.z - sphere.radius * sphere.radius};
}
std::vector<Term> residuals_of(const runtime::Box<double>& box, const Point& p) {
    return {p.x - box.min.x, p.x - box.max.x, p.y - box.min.y,
            p.y - box.max.y, p.z - box.min.z, p.z - box.max.z};
}
std::vector<Term> residuals_of(const runtime::Plane<double>& plane, const Point& p) {
    return {p.along(plane.normal) - plane.offset};
}
std::vector<Term> residuals_of(const runtime::Disc<double>& disc, const Point& p) {
    return {p.relative_to(disc.center).along(disc.normal)};
}
std::vector<Term> residuals_of(const runtime::Triangle<double>& triangle, const Point& p) {
    const auto& [a, b, c] = triangle.points;
    return {p.relative_to(a).along(normalize(cross(b - a, c - a)))};
}
/// Those of the ends, which are discs where there are caps.
std::vector<Term> about_axis(const Vec3<double>& from, const Vec3<double>& to, double radius_from,
                             double radius_to, bool caps, const Point& p) {
    const double height = length(to - from);
    const Vec3<double> up = (to - from) * (1 / height);
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(up);
    const Point d = p.relative_to(from);
    const Term x = d.along(axes.u), z = d.along(axes.v), along = d.along(up);
    std::vector<Term> parts{along * ((radius_to - radius_from) / height) + radius_from - root(x * x + z * z)};
    if (caps) {
        parts.push_back(along);
        parts.push_back(along - height);
    }
    return parts;
}
std::vector<Term> residuals_of(const runtime::Cylinder<double>& c, const Point& p) {
    return about_axis(c.from, c.to, c.radius, c.radius, c.caps, p);
}
std::vector<Term> residuals_of(const runtime::Cone<double>& c, const Point& p) {
    return about_axis(c.from, c.to, c.radius_from, c.radius_to, c.caps, p);
}
std::vector<Term> residuals_of(const runtime::Torus<double>& torus, const Point& p) {
    const runtime::PlanarAxes<double> axes = runtime::planar_axes(torus.axis);
    const Point d = p.relative_to(torus.center);
    const Term x = d.along(axes.u), z = d.along(axes.v), y = d.along(torus.axis);
    const Term from_circle = root(x * x + z * z) - torus.major;
    return {from_circle * from_circle + y * y - torus.minor * torus.minor};
}
std::vector<Term> residuals_of(const runtime::Quadric<double>& q, const Point& p) {
    const std::pair<Term, double> summands[] = {
        {p.x * p.x, q.squares.x},  {p.y * p.y, q.squares.y},  {p.z * p.z, q.squares.z},
        {p.x * p.y, q.products.x}, {p.y * p.z, q.products.y}, {p.z * p.x, q.products.z},
        {p.x, q.linear.x},         {p.y, q.linear.y},         {p.z, q.linear.z}};
    Term sum = p.x.constant(q.constant);
    for (const auto& [term, factor] : summands) {
        if (factor != 0) {
            sum = sum + term * factor;
        }
    }
    return {sum};
}
std::vector<Term> residuals_of(const runtime::Implicit<double>& implicit, const Point& p,
                               const ir::Scene& scene) {
    std::vector<Term> parts =
        implicit.within.visit([&](const auto& container) { return residuals_of(container, p); });
    FunctionBuilder& builder = *p.x.builder;
    const ir::Function& field = scene.functions[static_cast<std::size_t>(implicit.field)];
    const std::vector<std::uint32_t> nodes =
        builder.include(field, [&](ir::Input which) { return builder.input(name(which)); });
    parts.push_back({&builder, nodes[field.results[0]]});
    return parts;
}

Point object_point(FunctionBuilder& builder) {
    const auto input = [&](std::string_view name) { return Term{&builder, builder.input(name)}; };
    return {input("p.x"), input("p.y"), input("p.z")};
}

/// F and its gradient.
std::optional<ir::Function> residual(const ir::Shape& shape, const ir::Scene& scene) {
    FunctionBuilder builder;
    const Point p = object_point(builder);
    const std::vector<Term> parts = std::visit(
        [&](const auto& s) -> std::vector<Term> {
            if constexpr (requires { residuals_of(s, p); }) {
                return residuals_of(s, p);
            } else if constexpr (requires { residuals_of(s, p, scene); }) {
                return residuals_of(s, p, scene);
            } else {
                return {};
            }
        },
        shape);
    if (parts.empty()) {
        return std::nullopt;
    }
    // A point of the surface is on the part whose equation it fulfils best.
    Term nearest = parts[0];
    for (std::size_t i = 1; i < parts.size(); ++i) {
        nearest = choose(absolute(nearest) <= absolute(parts[i]), nearest, parts[i]);
    }
    return with_gradient(builder.finish({{0, nearest.node}}));
}

// ---- the height -------------------------------------------------------------------------------------------

using Terms3 = std::array<Term, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

Matrix linear_part(const runtime::Affine<double>& a) {
    Matrix m{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            m[i][k] = a.m[i][k];
        }
    }
    return m;
}
/// m m^T.
Matrix with_transposed(const Matrix& m) {
    Matrix product{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            product[i][k] = m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2];
        }
    }
    return product;
}
Terms3 multiplied(const Matrix& m, const Terms3& v) {
    const Point p{v[0], v[1], v[2]};
    const auto row = [&](std::size_t i) { return p.along({m[i][0], m[i][1], m[i][2]}); };
    return {row(0), row(1), row(2)};
}

/// On the surface, if p is near it.
Terms3 foot_of(const Terms3& p, const Term& f, const Terms3& gradient, const Matrix& a,
               const std::optional<runtime::Bounds<double>>& bounds) {
    const Terms3 way = multiplied(a, gradient);
    const Term step = f / (gradient[0] * way[0] + gradient[1] * way[1] + gradient[2] * way[2]);
    Terms3 foot{p[0] - step * way[0], p[1] - step * way[1], p[2] - step * way[2]};
    if (bounds) { // which the range of values in the export follows from
        const Vec3<double> slack = (bounds->max - bounds->min) * 0.001 + Vec3<double>{1e-3, 1e-3, 1e-3};
        const Vec3<double> min = bounds->min - slack, max = bounds->max + slack;
        const auto within = [](const Term& x, double low, double high) {
            return smaller(larger(x, x.constant(low)), x.constant(high));
        };
        foot = {within(foot[0], min.x, max.x), within(foot[1], min.y, max.y), within(foot[2], min.z, max.z)};
    }
    return foot;
}

/// Records the height at a point of the object's space.
Term height_at(FunctionBuilder& builder, const ir::Function& height, const Terms3& p,
               const runtime::Affine<double>& place) {
    const Terms3 world = multiplied(linear_part(place), p);
    const std::vector<std::uint32_t> nodes = builder.include(height, [&](ir::Input which) {
        const auto i = static_cast<std::size_t>(which);
        return i < 3 ? p[i].node : (world[i - 3] + place.m[i - 3][3]).node;
    });
    return {&builder, nodes[height.results[0]]};
}

class BumpResolver {
public:
    BumpResolver(const ir::Scene& scene, BumpForm form) : resolved_{scene, {}}, form_(form) {
        for (const ir::Material& material : scene.materials) {
            names_.insert(material.name);
        }
    }

    ResolvedBumps run() {
        for (auto* objects : {&resolved_.scene.objects, &resolved_.scene.members}) {
            for (ir::Object& object : *objects) {
                object.sides = of(object);
            }
        }
        for (ir::ObjectArray& array : resolved_.scene.arrays) {
            for (ir::ObjectColumn& column : array.columns) {
                resolve(column, array.rounds);
            }
        }
        return std::move(resolved_);
    }

private:
    bool is_bumped(std::uint32_t material) const {
        return resolved_.scene.materials[material].phong.bump != runtime::no_function;
    }

    void resolve(ir::ObjectColumn& column, std::size_t rounds) {
        bool bumped = false;
        for (const runtime::Sides& sides : column.sides) {
            bumped = bumped || is_bumped(sides.front) || is_bumped(sides.back);
        }
        if (!bumped) {
            return;
        }
        std::vector<runtime::Sides> sides;
        for (std::size_t round = 0; round < rounds; ++round) {
            sides.push_back(of(ir::object_of(column, round)));
        }
        column.sides = std::move(sides);
    }

    runtime::Sides of(const ir::Object& object) {
        const std::uint32_t front = material_on(object, object.sides.front);
        return {front,
                object.sides.back == object.sides.front ? front : material_on(object, object.sides.back)};
    }

    std::uint32_t material_on(const ir::Object& object, std::uint32_t material) {
        if (!is_bumped(material) || std::holds_alternative<runtime::Csg<double>>(object.shape)) {
            return material; // the members of a solid are seen
        }
        ir::Scene& scene = resolved_.scene;
        ir::Material made = scene.materials[material];
        const auto index = static_cast<std::uint32_t>(scene.materials.size());
        const ir::Function& given = scene.functions[static_cast<std::size_t>(made.phong.bump)];
        auto height = form_ == BumpForm::world_slope ? world_slope(given, object.world_from_object)
                                                     : height_along_surface(given, object, scene);
        if (height) {
            made.phong.bump = static_cast<std::int32_t>(scene.functions.size());
            scene.functions.push_back(*std::move(height));
        } else {
            made.phong.bump = runtime::no_function;
            resolved_.flat.push_back(index);
        }
        made.name = unique_name(fmt::format("{} of {}", made.name, object.path));
        scene.materials.push_back(std::move(made));
        return index;
    }

    std::string unique_name(const std::string& wanted) {
        std::string name = wanted;
        for (int i = 2; !names_.insert(name).second; ++i) {
            name = fmt::format("{} {}", wanted, i);
        }
        return name;
    }

    ResolvedBumps resolved_;
    BumpForm form_;
    std::set<std::string> names_;
};

} // namespace

std::optional<ir::Function> height_along_surface(const ir::Function& height, const ir::Object& object,
                                                 const ir::Scene& scene) {
    const std::optional<ir::Function> surface = residual(object.shape, scene);
    if (!surface || height.reads(ir::Input::uv_x, ir::Input::uv_y)) {
        return std::nullopt;
    }
    FunctionBuilder builder;
    const Point point = object_point(builder);
    const std::vector<std::uint32_t> on_surface =
        builder.include(*surface, [&](ir::Input which) { return builder.input(name(which)); });
    const auto result = [&](std::size_t i) { return Term{&builder, on_surface[surface->results[i]]}; };
    const runtime::Affine<double>& place = object.world_from_object;
    const Terms3 foot =
        foot_of({point.x, point.y, point.z}, result(0), {result(1), result(2), result(3)},
                with_transposed(linear_part(inverse(place))), object_bounds(object.shape, scene));
    ir::Function made = builder.finish({{0, height_at(builder, height, foot, place).node}});
    made.name = height.name;
    return made;
}

std::optional<ir::Function> world_slope(const ir::Function& height, const runtime::Affine<double>& place) {
    if (height.reads(ir::Input::uv_x, ir::Input::uv_y)) {
        return std::nullopt;
    }
    FunctionBuilder builder;
    const Point p = object_point(builder);
    const Term value = height_at(builder, height, {p.x, p.y, p.z}, place);
    const std::optional<ir::Function> derived = with_gradient(builder.finish({{0, value.node}}));
    if (!derived) {
        return std::nullopt;
    }
    FunctionBuilder slope_builder;
    const std::vector<std::uint32_t> nodes =
        slope_builder.include(*derived, [&](ir::Input which) { return slope_builder.input(name(which)); });
    const auto by = [&](std::size_t i) { return Term{&slope_builder, nodes[derived->results[i]]}; };
    const Matrix inverted = linear_part(inverse(place));
    Matrix transposed{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            transposed[i][k] = inverted[k][i];
        }
    }
    const Terms3 slope = multiplied(transposed, {by(1), by(2), by(3)});
    ir::Function made = slope_builder.finish({{0, slope[0].node}, {0, slope[1].node}, {0, slope[2].node}});
    made.name = height.name + " slope";
    return made;
}

ResolvedBumps resolve_bumps(const ir::Scene& scene, BumpForm form) {
    return BumpResolver(scene, form).run();
}

} // namespace scc::compiler
