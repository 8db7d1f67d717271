#include "compiler/coincident_faces.h"

#include "compiler/flat_faces.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace scc::compiler {

namespace {

using lang::Diag;
using runtime::Bounds;
using runtime::Vec3;

/// Planes this much closer than their distance from the origin are one, whatever rounding placed them.
constexpr double same_plane = 1e-12;

/// The normal points out of the solid that it bounds.
struct Face : FlatFace {
    const ir::Object* member;
    std::size_t operand;
};

class Solid {
public:
    Solid(const ir::Scene& scene, lang::Diagnostics& diagnostics)
        : scene_(scene), diagnostics_(diagnostics) {}

    void check(std::size_t at) {
        const ir::CsgNode& node = scene_.csg_nodes[at];
        if (node.op == runtime::CsgOp::member) {
            return;
        }
        std::vector<Face> faces;
        std::size_t operand = 0;
        for (std::size_t child = at + 1; child < at + node.size; child += scene_.csg_nodes[child].size) {
            check(child);
            if (node.op != runtime::CsgOp::unite) {
                add_faces(child, operand++, faces);
            }
        }
        compare(node.op, faces);
    }

private:
    void add_faces(std::size_t at, std::size_t operand, std::vector<Face>& faces) {
        // A member's parity counts within the operand only.
        const std::size_t end = at + scene_.csg_nodes[at].size;
        const bool inverted = is_inverted(at);
        for (std::size_t i = at; i < end; ++i) {
            const ir::CsgNode& node = scene_.csg_nodes[i];
            if (node.op == runtime::CsgOp::member) {
                const ir::Object& member = scene_.members[node.member];
                const double sign = node.inverted != inverted ? -1 : 1;
                std::visit([&](const auto& shape) { add_faces(shape, member, sign, operand, faces); },
                           member.shape);
            }
        }
    }
    /// The parity that a node's own place gives it: that of the first member that no subtraction below takes.
    bool is_inverted(std::size_t at) const {
        while (scene_.csg_nodes[at].op != runtime::CsgOp::member) {
            ++at; // the first operand is never subtracted
        }
        return scene_.csg_nodes[at].inverted;
    }

    template <class Shape>
    static void add_faces(const Shape& shape, const ir::Object& member, double sign, std::size_t operand,
                          std::vector<Face>& faces) {
        if constexpr (!std::is_same_v<Shape, runtime::Disc<double>>) { // which is no solid
            for_each_flat_face(shape, member.world_from_object, [&](FlatFace face) {
                face.normal = face.normal * sign;
                face.offset *= sign;
                faces.push_back({face, &member, operand});
            });
        }
    }

    void compare(runtime::CsgOp op, std::vector<Face>& faces) {
        const auto by_offset = [](const Face& a, const Face& b) { return a.offset < b.offset; };
        std::stable_sort(faces.begin(), faces.end(), by_offset);
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (std::size_t k = i + 1; k < faces.size() && is_same(faces[i].offset, faces[k].offset); ++k) {
                compare(op, faces[i], faces[k]);
            }
        }
    }
    static bool is_same(double a, double b) {
        return std::abs(a - b) <= same_plane * std::max({std::abs(a), std::abs(b), 1.0});
    }

    void compare(runtime::CsgOp op, const Face& one, const Face& other) {
        const bool of_difference = op == runtime::CsgOp::subtract;
        // Two shapes that are taken away do not meet each other.
        if (one.operand == other.operand || (of_difference && one.operand != 0 && other.operand != 0) ||
            !(dot(one.normal, other.normal) > 1 - same_plane) || !overlap(one.box, other.box)) {
            return;
        }
        const Face& later = one.operand > other.operand ? one : other;
        if (told_.insert({later.member->span.file, later.member->span.begin}).second) {
            diagnostics_.report(Diag::coincident_faces, later.member->span, ir::csg_word(op),
                                plane_text(later.normal, later.offset),
                                of_difference ? "the cut is taken as closed"
                                              : "the first one's material is seen");
        }
    }
    /// In more than an edge.
    static bool overlap(const Bounds<double>& a, const Bounds<double>& b) {
        const Vec3<double> low = maximum(a.min, b.min), high = minimum(a.max, b.max);
        const double slack = 1e-9 * std::max({1.0, std::abs(low.x), std::abs(low.y), std::abs(low.z)});
        const std::array<double, 3> size{high.x - low.x, high.y - low.y, high.z - low.z};
        return std::all_of(size.begin(), size.end(), [&](double x) { return x >= -slack; }) &&
               std::count_if(size.begin(), size.end(), [&](double x) { return x > slack; }) >= 2;
    }

    /// `y = 0`, or with a normal along no axis its dot product.
    static std::string plane_text(const Vec3<double>& normal, double offset) {
        const std::array<std::pair<const char*, double>, 3> axes{
            {{"x", normal.x}, {"y", normal.y}, {"z", normal.z}}};
        for (const auto& [name, component] : axes) {
            if (std::abs(component) > 1 - same_plane) {
                const double at = offset * component;
                return fmt::format("{} = {:.6g}", name, at == 0 ? 0.0 : at);
            }
        }
        return fmt::format("dot(({:.3g}, {:.3g}, {:.3g}), p) = {:.6g}", normal.x + 0.0, normal.y + 0.0,
                           normal.z + 0.0, offset);
    }

    const ir::Scene& scene_;
    lang::Diagnostics& diagnostics_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> told_; ///< places, for what loops repeat
};

} // namespace

void check_coincident_faces(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    Solid solid(scene, diagnostics);
    for (const ir::Object& object : scene.objects) {
        if (const auto* csg = std::get_if<runtime::Csg<double>>(&object.shape)) {
            solid.check(csg->root);
        }
    }
}

} // namespace scc::compiler
