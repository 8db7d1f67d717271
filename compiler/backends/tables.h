#pragma once

#include "compiler/ir/objects.h"
#include "compiler/ir/scene.h"
#include "runtime/math/affine.h"
#include "runtime/scene.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>

/// The IR's values in the precision that a renderer calculates with. The in-process renderer and the
/// generated program both take their data from here, so that both draw from the same bits.
namespace scc::compiler {

template <class R>
R convert(double v, R) {
    return static_cast<R>(v);
}
template <class R>
runtime::Vec3<R> convert(const runtime::Vec3<double>& v, R) {
    return {static_cast<R>(v.x), static_cast<R>(v.y), static_cast<R>(v.z)};
}
template <class R>
runtime::Rgb<R> convert(const runtime::Rgb<double>& c, R) {
    return {static_cast<R>(c.r), static_cast<R>(c.g), static_cast<R>(c.b)};
}
template <class R>
bool convert(bool v, R) {
    return v;
}
template <class R, std::size_t N>
std::array<runtime::Vec2<R>, N> convert(const std::array<runtime::Vec2<double>, N>& list, R) {
    std::array<runtime::Vec2<R>, N> result;
    for (std::size_t i = 0; i < N; ++i) {
        result[i] = {static_cast<R>(list[i].x), static_cast<R>(list[i].y)};
    }
    return result;
}
template <class R, std::size_t N>
std::array<runtime::Vec3<R>, N> convert(const std::array<runtime::Vec3<double>, N>& list, R real) {
    std::array<runtime::Vec3<R>, N> result;
    for (std::size_t i = 0; i < N; ++i) {
        result[i] = convert(list[i], real);
    }
    return result;
}
template <class T, class R>
auto convert(const runtime::Varying<T>& v, R real) -> runtime::Varying<decltype(convert(v.value, real))> {
    return {convert(v.value, real), v.function};
}

template <class R>
runtime::Phong<R> convert(const runtime::Phong<double>& p, R real) {
    return {convert(p.ambient, real),
            convert(p.diffuse, real),
            convert(p.specular, real),
            convert(p.emission, real),
            convert(p.reflect, real),
            convert(p.transmit, real),
            convert(p.shininess, real),
            convert(p.ior, real),
            p.fresnel,
            p.bump};
}
template <class R>
runtime::PointLight<R> convert(const runtime::PointLight<double>& l, R real) {
    return {convert(l.position, real), convert(l.diffuse, real), convert(l.specular, real),
            convert(l.kc, real),       convert(l.kl, real),      convert(l.kq, real)};
}
template <class R>
runtime::SpotLight<R> convert(const runtime::SpotLight<double>& l, R real) {
    return {convert(static_cast<const runtime::PointLight<double>&>(l), real), convert(l.axis, real),
            convert(l.cos_inner, real), convert(l.cos_outer, real), convert(l.exponent, real)};
}
template <class R>
runtime::RectangleLight<R> convert(const runtime::RectangleLight<double>& l, R real) {
    return {convert(static_cast<const runtime::PointLight<double>&>(l), real), convert(l.edge_u, real),
            convert(l.edge_v, real), l.nu, l.nv};
}
template <class R>
runtime::DirectionalLight<R> convert(const runtime::DirectionalLight<double>& l, R real) {
    return {convert(l.to_light, real), convert(l.diffuse, real), convert(l.specular, real)};
}
template <class R>
runtime::Camera<R> convert(const runtime::Camera<double>& c, R real) {
    return {c.projection,
            convert(c.eye, real),
            convert(c.u, real),
            convert(c.v, real),
            convert(c.n, real),
            convert(c.half_height, real),
            convert(c.shift_x, real),
            convert(c.shift_y, real),
            convert(c.half_width, real),
            convert(c.lens_radius, real),
            convert(c.focus, real),
            convert(c.near, real),
            convert(c.far, real)};
}

template <class R>
std::vector<runtime::LineSegment<R>> line_segments_of(const ir::Scene& scene) {
    std::vector<runtime::LineSegment<R>> segments;
    const auto add = [&](const ir::Polyline& line, const runtime::Rgb<double>& color) {
        for (std::size_t i = 1; i < line.points.size(); ++i) {
            segments.push_back({convert(line.points[i - 1], R{}), convert(line.points[i], R{}),
                                convert(color, R{}), static_cast<R>(line.width)});
        }
    };
    for (std::size_t band = 0; band < std::max<std::size_t>(1, scene.bands.size()); ++band) {
        for (const ir::Polyline& line : scene.polylines) {
            add(line, scene.bands.empty() ? line.color : line.bands[band]);
        }
    }
    return segments;
}

/// A described shape, member by member.
template <template <class> class Shape, class R>
Shape<R> convert(const Shape<double>& from, R real) requires requires {
    Shape<R>::fields();
}
{
    Shape<R> to{};
    const auto copy = [&](const auto& source, const auto& target) {
        to.*target.member = convert(from.*source.member, real);
        if (source.present != nullptr) {
            to.*target.present = from.*source.present;
        }
    };
    const auto sources = Shape<double>::fields();
    const auto targets = Shape<R>::fields();
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        (copy(std::get<i>(sources), std::get<i>(targets)), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(sources)>>{});
    return to;
}
template <class R>
runtime::Mesh<R> convert(const runtime::Mesh<double>& mesh, R) {
    return {mesh.mesh};
}

template <class R>
runtime::Csg<R> convert(const runtime::Csg<double>& solid, R) {
    return {solid.root};
}

template <class R>
runtime::Implicit<R> convert(const runtime::Implicit<double>& implicit, R real) {
    const runtime::Container<double>& within = implicit.within;
    return {implicit.field,
            {static_cast<typename runtime::Container<R>::Kind>(within.kind), convert(within.first, real),
             convert(within.second, real), convert(within.radius, real), convert(within.radius_to, real)}};
}

/// Calls `visit` with an object's Bare or Placed primitive.
template <class R, class Source, class Visit>
void visit_primitive(const Source& source, const runtime::Affine<double>& place, const runtime::Tag& tag,
                     Visit visit) {
    const auto shape = convert(source, R{});
    using Shape = std::remove_const_t<decltype(shape)>;
    if (place == runtime::Affine<double>{}) {
        visit(runtime::Bare<Shape>{shape, tag});
    } else {
        visit(runtime::Placed<Shape, R>{shape, runtime::affine_cast<R>(place),
                                        runtime::affine_cast<R>(inverse(place)), tag});
    }
}

/// Calls `visit` with the Bare or Placed primitive of every object, or its Member of a solid, in the order of
/// their ids.
template <class R, class Visit>
void for_each_primitive(const ir::Scene& scene, Visit visit) {
    std::uint32_t id = 0, solid = 0;
    const auto visit_member = [&](const ir::CsgNode& node) {
        if (node.op != runtime::CsgOp::member) {
            return;
        }
        const ir::Object& member = scene.members[node.member];
        std::visit(
            [&](const auto& source) {
                visit_primitive<R>(source, member.world_from_object, {id++, member.sides},
                                   [&]<class Primitive>(const Primitive& primitive) {
                                       visit(runtime::Member<Primitive>{primitive, node.inverted, solid});
                                   });
            },
            member.shape);
    };
    ir::for_each_shape(
        scene, [&](const auto& source, const runtime::Affine<double>& place, const runtime::Sides& sides) {
            solid = id++;
            visit_primitive<R>(source, place, {solid, sides}, visit);
            if constexpr (requires { source.root; }) {
                ir::for_each_csg_node(scene, source, visit_member);
            }
        });
}

/// The trees of the solids, whose members are where for_each_primitive puts them.
inline std::vector<runtime::CsgNode> csg_nodes_of(const ir::Scene& scene) {
    std::array<std::uint32_t, runtime::primitive_kinds> count{};
    std::vector<runtime::CsgNode> nodes;
    for (const ir::CsgNode& node : scene.csg_nodes) {
        runtime::CsgNode& made = nodes.emplace_back(runtime::CsgNode{node.op, node.size, {}});
        if (node.op == runtime::CsgOp::member) {
            const ir::Object& member = scene.members[node.member];
            const bool placed = !(member.world_from_object == runtime::Affine<double>{});
            made.member.kind = static_cast<std::uint32_t>(2 * member.shape.index() + (placed ? 1 : 0));
            made.member.index = count[made.member.kind]++;
        }
    }
    return nodes;
}

/// The lights of one kind, in source order; of a scene with spectra, those of each of Scene::bands after
/// those of the one before.
template <template <class> class Light, class R>
std::vector<Light<R>> lights_of(const ir::Scene& scene) {
    std::vector<Light<R>> lights;
    const auto add = [&](auto&& colored) {
        for (const ir::Light& light : scene.lights) {
            if (const auto* found = std::get_if<Light<double>>(&light.light)) {
                lights.push_back(convert(colored(light, *found), R{}));
            }
        }
    };
    if (scene.bands.empty()) {
        add([](const ir::Light&, const Light<double>& light) { return light; });
    }
    for (std::size_t band = 0; band < scene.bands.size(); ++band) {
        add([&](const ir::Light& from, Light<double> light) {
            light.diffuse = from.bands[band].diffuse;
            light.specular = from.bands[band].specular;
            return light;
        });
    }
    return lights;
}

/// As the lights, band after band.
template <class R>
std::vector<runtime::Phong<R>> materials_of(const ir::Scene& scene) {
    std::vector<runtime::Phong<R>> materials;
    const auto add = [&](auto&& phong) {
        for (const ir::Material& material : scene.materials) {
            materials.push_back(convert(phong(material), R{}));
        }
    };
    if (scene.bands.empty()) {
        add([](const ir::Material& material) { return material.phong; });
    }
    for (std::size_t band = 0; band < scene.bands.size(); ++band) {
        add([&](const ir::Material& material) { return material.bands[band]; });
    }
    return materials;
}

template <class R>
std::vector<runtime::BandGroup<R>> bands_of(const ir::Scene& scene) {
    std::vector<runtime::BandGroup<R>> bands;
    for (const runtime::BandGroup<double>& band : scene.bands) {
        bands.push_back(
            {convert(band.ambient, R{}), convert(band.background, R{}), band.red, band.green, band.blue});
    }
    return bands;
}

} // namespace scc::compiler
