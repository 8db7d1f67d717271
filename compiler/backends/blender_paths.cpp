#include "compiler/backends/blender_paths.h"

#include "compiler/backends/enclosed.h"
#include "compiler/bounds.h"
#include "compiler/ir/objects.h"
#include "compiler/shape_rules.h"
#include "runtime/material.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Bounds;
using runtime::Phong;
using runtime::Rgb;
using runtime::Vec3;

/// Layers are drawn one after the other, each as long as a picture of its own takes.
constexpr std::size_t most_layers = 100;
constexpr int longest_path = 22;
/// Of Fresnel's share, which is larger only where surfaces are grazed.
constexpr double typical_reflectance = 0.1;
/// How likely light outside of bodies meets one that sends it on, if it can.
constexpr double going_on_outside = 0.3;
/// A path that counts less is left out even where there is room.
constexpr double least_weight = 1e-7;
constexpr std::size_t most_bodies = 500;

// ---- bodies within bodies ------------------------------------------------------------------------------

struct Body {
    ir::Object object;
    double ior;
    Bounds<double> bounds; ///< in the object's space
};

enum class Relation { apart, inside, unknown };

std::array<Vec3<double>, 8> corners_of(const Bounds<double>& b) {
    std::array<Vec3<double>, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = {(i & 1) != 0 ? b.max.x : b.min.x, (i & 2) != 0 ? b.max.y : b.min.y,
                      (i & 4) != 0 ? b.max.z : b.min.z};
    }
    return corners;
}

bool meet(const Bounds<double>& a, const Bounds<double>& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// A ball in the world, if the object is one.
std::optional<runtime::Sphere<double>> ball_of(const ir::Object& object) {
    const auto* sphere = std::get_if<runtime::Sphere<double>>(&object.shape);
    const auto& m = object.world_from_object.m;
    const auto column = [&](int i) { return Vec3<double>{m[0][i], m[1][i], m[2][i]}; };
    const Vec3<double> x = column(0), y = column(1), z = column(2);
    const double scale = length(x), tolerance = 1e-12 * scale;
    if (sphere == nullptr || std::abs(length(y) - scale) > tolerance ||
        std::abs(length(z) - scale) > tolerance || std::abs(dot(x, y)) > tolerance * scale ||
        std::abs(dot(x, z)) > tolerance * scale || std::abs(dot(y, z)) > tolerance * scale) {
        return std::nullopt;
    }
    return runtime::Sphere<double>{transform_point(object.world_from_object, sphere->center),
                                   scale * sphere->radius};
}

/// How `one` lies to `other`.
Relation relation(const Body& one, const Body& other) {
    const auto ball = ball_of(one.object), around = ball_of(other.object);
    if (ball && around) {
        const double distance = length(ball->center - around->center);
        return distance > ball->radius + around->radius   ? Relation::apart
               : distance + ball->radius < around->radius ? Relation::inside
                                                          : Relation::unknown;
    }
    const auto seen_from = [](const Body& a, const Body& b) {
        return compose(inverse(b.object.world_from_object), a.object.world_from_object);
    };
    if (!meet(transform_bounds(seen_from(one, other), one.bounds), other.bounds) ||
        !meet(transform_bounds(seen_from(other, one), other.bounds), one.bounds)) {
        return Relation::apart;
    }
    const bool is_inside = std::visit(
        [&]<class Shape>(const Shape& shape) {
            if constexpr (requires(Vec3<double> p) { encloses(shape, p); }) {
                const Affine<double> map = seen_from(one, other);
                const auto corners = corners_of(one.bounds);
                return std::all_of(corners.begin(), corners.end(), [&](const Vec3<double>& corner) {
                    return encloses(shape, transform_point(map, corner));
                });
            } else {
                return false;
            }
        },
        other.object.shape);
    return is_inside ? Relation::inside : Relation::unknown;
}

/// Fills in what surrounds bodies, or says why that cannot be told.
class Surroundings {
public:
    Surroundings(const ir::Scene& scene, BlenderPaths& to) : scene_(scene), to_(to) {}

    void find() {
        ir::for_each_object(scene_, [&](const ir::Object& object) { add(object); });
        relate_all();
    }
    /// Whether light goes straight through some surface, which takes no bounce.
    bool let_straight_through() const {
        return has_panes_ || std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
                   const auto around = to_.outside.find(body.object.path);
                   return body.ior == (around == to_.outside.end() ? 1 : around->second);
               });
    }

private:
    void relate_all() {
        const auto bends = [](const Body& body) { return body.ior != 1; };
        if (!to_.obstacle.empty() || std::none_of(bodies_.begin(), bodies_.end(), bends)) {
            return;
        }
        if (bodies_.size() > most_bodies) {
            to_.obstacle = fmt::format("there are more than {} transparent bodies", most_bodies);
            return;
        }
        std::vector<std::vector<std::size_t>> around(bodies_.size());
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            for (std::size_t k = 0; k < bodies_.size(); ++k) {
                if (i != k && (bends(bodies_[i]) || bends(bodies_[k]))) {
                    relate(i, k, around[i]);
                }
            }
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const auto innermost =
                std::max_element(around[i].begin(), around[i].end(), [&](std::size_t a, std::size_t b) {
                    return around[a].size() < around[b].size();
                });
            if (innermost != around[i].end() && bodies_[*innermost].ior != 1) {
                to_.outside[bodies_[i].object.path] = bodies_[*innermost].ior;
            }
        }
    }
    void add(const ir::Object& object) {
        const Phong<double>&front = scene_.materials[object.sides.front].phong,
              &back = scene_.materials[object.sides.back].phong;
        if (!lets_through(front) && !lets_through(back)) {
            return;
        }
        const double ior = lets_through(front) ? front.ior : back.ior;
        const auto bounds = object_bounds(object.shape, scene_);
        if (bounds && is_closed(object.shape)) {
            bodies_.push_back({object, ior, *bounds});
        } else if (ior == 1) {
            has_panes_ = true;
        } else {
            to_.obstacle = fmt::format("`{}` bends rays and encloses nothing", object.path);
        }
    }
    bool is_closed(const ir::Shape& shape) const {
        const auto* mesh = std::get_if<runtime::Mesh<double>>(&shape);
        return mesh != nullptr ? open_part(scene_.meshes[mesh->mesh]).empty() : open_part(shape).empty();
    }
    void relate(std::size_t i, std::size_t k, std::vector<std::size_t>& around) {
        const Relation to = relation(bodies_[i], bodies_[k]);
        if (to == Relation::inside) {
            around.push_back(k);
        } else if (to == Relation::unknown && to_.obstacle.empty() &&
                   relation(bodies_[k], bodies_[i]) != Relation::inside) {
            to_.obstacle =
                fmt::format("`{}` and `{}` may overlap", bodies_[i].object.path, bodies_[k].object.path);
        }
    }

    const ir::Scene& scene_;
    BlenderPaths& to_;
    std::vector<Body> bodies_;
    bool has_panes_ = false; ///< transparent ones that enclose nothing
};

// ---- ways ----------------------------------------------------------------------------------------------

double largest(const runtime::Varying<Rgb<double>>& color) {
    return color.function != runtime::no_function ? 1
                                                  : std::max({color.value.r, color.value.g, color.value.b});
}

/// The most that a surface sends on each way.
struct Strengths {
    double through = 0, mirrored = 0;
};
Strengths strengths_of(const ir::Scene& scene) {
    Strengths result;
    for (const ir::Material& material : scene.materials) {
        const Phong<double>& p = material.phong;
        result.through = std::max(result.through, std::min(1.0, largest(p.transmit)));
        result.mirrored = std::max(result.mirrored, std::min(1.0, largest(p.reflect)) *
                                                        (p.fresnel != 0 ? typical_reflectance : 1));
    }
    return result;
}

/// How likely light that leaves a body, or is totally reflected within, meets a surface that sends it on.
double chance_outside(const ir::Scene& scene) {
    const auto sends_on = [&](std::uint32_t material) {
        const Phong<double>& p = scene.materials[material].phong;
        return lets_through(p) || largest(p.reflect) > 0;
    };
    const auto bends = [&](std::uint32_t material) { return refracts(scene.materials[material].phong); };
    std::size_t count = 0;
    bool meets_nothing = true;
    ir::for_each_object(scene, [&](const ir::Object& object) {
        const auto [front, back] = object.sides;
        if (!sends_on(front) && !sends_on(back)) {
            return;
        }
        ++count;
        const bool is_convex = std::visit(
            [](const auto& shape) {
                return requires(Vec3<double> p) {
                    encloses(shape, p);
                };
            },
            object.shape);
        const bool is_ball = std::holds_alternative<runtime::Sphere<double>>(object.shape);
        meets_nothing = meets_nothing && is_convex && (is_ball || (!bends(front) && !bends(back)));
    });
    return count == 1 && meets_nothing ? 0 : going_on_outside;
}

std::size_t layers_per_path(const ir::Scene& scene) {
    std::size_t count = 0;
    for (const ir::Light& light : scene.lights) {
        const auto* rectangle = std::get_if<runtime::RectangleLight<double>>(&light.light);
        count += rectangle != nullptr ? std::size_t{rectangle->nu} * rectangle->nv : 1;
    }
    return std::max<std::size_t>(count, 1);
}

/// A path with what is known of the light that takes it.
struct Way {
    std::string path;
    double share = 1;  ///< of what is seen at its end, the most that it counts
    double weight = 1; ///< the same by how likely it is taken
    bool is_inside = false;

    bool operator<(const Way& other) const { // the shorter one first, where they count alike
        return weight != other.weight ? weight < other.weight : path.size() > other.path.size();
    }
    /// One surface on; `leaving`: how likely light outside of bodies meets one that sends it on.
    Way on(char letter, double strength, double leaving) const {
        const double chance = path.empty() || is_inside ? 1 : leaving;
        return {path + letter, share * strength, weight * strength * chance, is_inside != (letter == 'T')};
    }
};

/// Best first: what goes on within a body surely meets its surface again. `each_bends`: every surface on a
/// way takes a bounce, so that ways end where ours do.
void find_ways(const ir::Scene& scene, bool each_bends, BlenderPaths& to) {
    const Strengths strengths = strengths_of(scene);
    constexpr int some_straight = 2; // surfaces on a way that take none
    const int depth = scene.settings.depth + (each_bends ? 0 : some_straight);
    const auto longest = static_cast<std::size_t>(std::min(longest_path, depth));
    const bool ends_alike = each_bends && depth <= longest_path;
    const std::size_t room = std::max<std::size_t>(1, most_layers / layers_per_path(scene));
    const double leaving = chance_outside(scene);
    std::priority_queue<Way> open;
    open.push({});
    while (!open.empty() && to.paths.size() < room && open.top().weight > least_weight) {
        const Way best = open.top();
        open.pop();
        to.paths.push_back(best.path);
        if (best.path.size() == longest) {
            to.cut_off = std::max(to.cut_off, ends_alike ? 0 : best.share);
            continue;
        }
        open.push(best.on('T', strengths.through, leaving));
        if (strengths.mirrored > 0) {
            open.push(best.on('R', strengths.mirrored, leaving));
        }
    }
    for (; !open.empty() && open.top().weight > 0; open.pop()) {
        to.cut_off = std::max(to.cut_off, open.top().share);
    }
}

} // namespace

BlenderPaths blender_paths(const ir::Scene& scene) {
    BlenderPaths result;
    Surroundings surroundings(scene, result);
    surroundings.find();
    if (result.obstacle.empty()) {
        find_ways(scene, !surroundings.let_straight_through(), result);
    }
    return result;
}

} // namespace scc::compiler
