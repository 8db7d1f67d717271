#pragma once

#include "runtime/raycast.h"
#include "runtime/test/contains.h"
#include "runtime/test/random_scene.h"

#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// Solids made of others, with a test of their own for what is inside: points, not rays.
namespace scc::runtime::test {

/// The one field of the scenes here: a ball with dents.
template <class R>
FunctionProgram<R> dented_ball() {
    using O = Opcode;
    return {{{O::p_x, {}, 0},
             {O::p_y, {}, 0},
             {O::p_z, {}, 0},
             {O::square, {0}, 0},
             {O::square, {1}, 0},
             {O::square, {2}, 0},
             {O::add, {3, 4}, 0},
             {O::add, {6, 5}, 0},
             {O::constant, {}, 5},
             {O::mul, {0, 8}, 0},
             {O::sin, {9}, 0},
             {O::mul, {1, 8}, 0},
             {O::sin, {11}, 0},
             {O::mul, {10, 12}, 0},
             {O::constant, {}, R(0.5)},
             {O::mul, {13, 14}, 0},
             {O::add, {7, 15}, 0},
             {O::sub, {16, 14}, 0}},
            {17}};
}
template <class R>
bool contains(const Implicit<R>& s, const Wide& p) {
    const bool in_container = s.within.visit([&](const auto& shape) { return contains(shape, p); });
    return in_container && dot(p, p) + std::sin(5 * p.x) * std::sin(5 * p.y) / 2 - 0.5L <= 0;
}

/// The one mesh of the scenes here: an octahedron, of which corners and edges are many.
inline constexpr float octahedron_reach = 0.75F;
inline std::vector<float> octahedron_corners(float shift = 0) {
    constexpr float r = octahedron_reach;
    return {shift + r, 0, 0, shift - r, 0, 0, shift, r, 0, shift, -r, 0, shift, 0, r, shift, 0, -r};
}
inline constexpr std::uint32_t octahedron_triangles[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                                         2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
inline const MeshStorage& octahedron() {
    static const MeshStorage mesh = build_mesh(octahedron_corners(), octahedron_triangles);
    return mesh;
}
template <class R>
bool contains(const Mesh<R>&, const Wide& p) {
    const Wide q = absolute(p);
    return q.x + q.y + q.z <= static_cast<long double>(octahedron_reach);
}

template <class R>
struct Node {
    CsgOp op = CsgOp::member;
    std::vector<Node> operands{};
    std::variant<Sphere<R>, Box<R>, Plane<R>, Cylinder<R>, Cone<R>, Implicit<R>, Torus<R>, Quadric<R>,
                 Mesh<R>>
        shape{};
    std::optional<Affine<double>> place{};
    Affine<long double> object_from_world{}; ///< of the rounded place
};

enum class Members { all, with_fields }; ///< meshes too, or not
template <class R>
Node<R> random_node(Random<R>& random, int depth, Members members = Members::all) {
    Node<R> node;
    if (depth > 0) {
        node.op = static_cast<CsgOp>(1 + static_cast<int>(random.number(0, 2.999)));
        const int operands = 2 + static_cast<int>(random.number(0, 2));
        for (int i = 0; i < operands; ++i) {
            node.operands.push_back(
                random_node(random, depth - 1 - static_cast<int>(random.number(0, 1.5)), members));
        }
        return node;
    }
    const auto make = [&](auto shape) {
        randomize(shape, random, 0.8);
        if constexpr (requires { shape.caps; }) {
            shape.caps = true;
        }
        node.shape = shape;
    };
    switch (static_cast<int>(random.number(0, members == Members::all ? 8.999 : 7.999))) {
    case 0:
        make(Sphere<R>{});
        break;
    case 1:
        make(Box<R>{});
        break;
    case 2:
        make(Plane<R>{});
        break;
    case 3:
        make(Cylinder<R>{});
        break;
    case 4: {
        Sphere<R> container;
        randomize(container, random, 0.8);
        node.shape = Implicit<R>{0, Container<R>::of(container)};
        break;
    }
    case 5:
        make(Torus<R>{});
        break;
    case 6:
        make(Quadric<R>{});
        break;
    case 8:
        node.shape = Mesh<R>{0};
        break;
    default:
        make(Cone<R>{});
        break;
    }
    if (random.number(0, 1) < 0.5) {
        node.place = random.map(0.5);
    }
    return node;
}

/// Solids in a scene of their own.
template <class R>
struct Solid {
    DynamicScene<R> scene;
    std::vector<Node<R>> trees;
    std::uint32_t next_id = 0;

    explicit Solid(Node<R> tree) { add(std::move(tree)); }
    Solid(Random<R>& random, int depth) : Solid(random_node(random, depth)) {}

    void add(Node<R> tree) {
        scene.functions.resize(1, dented_ball<R>());
        scene.meshes.resize(1, octahedron().data());
        const auto root = static_cast<std::uint32_t>(scene.csg_nodes.size());
        scene.add(Bare<Csg<R>>{{root}, {next_id++, {}}});
        add_node(tree, false);
        trees.push_back(std::move(tree));
    }

    bool contains(const Wide& p) const {
        for (const Node<R>& tree : trees) {
            if (contains(tree, p)) {
                return true;
            }
        }
        return false;
    }

    Vec3<R> center() const { return {0, 0, 0}; }

    Surface<R> surface(const Ray<R>& ray, const Hit<R>& hit) const {
        Surface<R> result;
        for_each_primitive(scene, hit, true,
                           [&](const auto& primitive, bool here, bool inverted, std::uint32_t) {
                               Vec3<R> object_point;
                               result = surface_of(scene, primitive, ray, hit.shape, here, object_point);
                               result = inverted ? turned_over(result) : result;
                           });
        return result;
    }

private:
    static bool contains(const Node<R>& node, const Wide& p) {
        if (node.op == CsgOp::member) {
            const Wide q = node.place ? transform_point(node.object_from_world, p) : p;
            return std::visit([&](const auto& shape) { return test::contains(shape, q); }, node.shape);
        }
        bool result = contains(node.operands.front(), p);
        for (std::size_t i = 1; i < node.operands.size(); ++i) {
            const bool operand = contains(node.operands[i], p);
            result = node.op == CsgOp::unite       ? result || operand
                     : node.op == CsgOp::intersect ? result && operand
                                                   : result && !operand;
        }
        return result;
    }

    template <class Primitive>
    PrimitiveRef add_member(const Primitive& primitive, std::uint32_t kind, bool inverted) {
        scene.add(Member<Primitive>{primitive, inverted});
        return {kind, static_cast<std::uint32_t>(scene.members(Of<Primitive>{}).size() - 1)};
    }

    template <class Shape, std::uint32_t kind = 0>
    static constexpr std::uint32_t kind_of() {
        if constexpr (std::is_same_v<Shape, ShapeOfKind<R, kind>>) {
            return kind;
        } else {
            return kind_of<Shape, kind + 2>();
        }
    }

    void add_node(Node<R>& node, bool inverted) {
        const std::size_t at = scene.csg_nodes.size();
        scene.csg_nodes.push_back({node.op, 1, {}});
        if (node.op == CsgOp::member) {
            scene.csg_nodes[at].member = std::visit(
                [&]<class Shape>(const Shape& shape) {
                    const Tag tag{next_id++, {}};
                    if (!node.place) {
                        return add_member(Bare<Shape>{shape, tag}, kind_of<Shape>(), inverted);
                    }
                    const Affine<R> place = affine_cast<R>(*node.place);
                    node.object_from_world = inverse(affine_cast<long double>(place));
                    return add_member(
                        Placed<Shape, R>{shape, place, affine_cast<R>(node.object_from_world), tag},
                        kind_of<Shape>() + 1, inverted);
                },
                node.shape);
        }
        for (std::size_t i = 0; i < node.operands.size(); ++i) {
            add_node(node.operands[i], inverted != (node.op == CsgOp::subtract && i > 0));
        }
        scene.csg_nodes[at].size = static_cast<std::uint32_t>(scene.csg_nodes.size() - at);
    }
};

} // namespace scc::runtime::test
