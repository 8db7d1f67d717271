#include "compiler/lower.h"

#include "compiler/lower_material.h"
#include "compiler/lower_view.h"
#include "compiler/mesh_cache.h"
#include "compiler/shape_rules.h"
#include "compiler/values.h"
#include "lang/schema.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace scc::compiler {

using lang::Diag;
using lang::Thing;
using runtime::Affine;
using runtime::Vec3;

namespace {

/// Groups share what they hold, so a few lines can stand for more objects than any memory has.
constexpr std::size_t most_objects = 20'000'000;

// ---- shapes from their own descriptions ----------------------------------------------------------------

void assign(double& target, const lang::Value& value) {
    target = to_number(value);
}
void assign(bool& target, const lang::Value& value) {
    target = to_bool(value);
}
void assign(Vec3<double>& target, const lang::Value& value) {
    target = to_vec3(value);
}

class ObjectLowering {
public:
    ObjectLowering(const LowerOptions& options, ir::Scene& scene, lang::Diagnostics& diagnostics)
        : options_(options), scene_(scene), diagnostics_(diagnostics), materials_(scene, diagnostics) {}

    void add_all(const std::vector<lang::ThingPtr>& siblings, const std::string& parent_path,
                 const Affine<double>& world_from_parent, const Thing* inherited_material);

private:
    void add(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
             const Thing* inherited_material);
    std::string unique_path(const std::string& wanted);
    std::optional<ir::Shape> make_shape(const Thing& thing);
    template <class Shape>
    std::optional<ir::Shape> described_shape(const Thing& thing);
    template <class Owner, class T>
    bool set_field(Owner& shape, const runtime::Field<Owner, T>& field, const Thing& thing);
    std::optional<ir::Shape> mesh_shape(const Thing& thing);
    std::optional<std::uint32_t> load_mesh(const Thing& thing, const std::string& file, MeshNormals normals);

    const LowerOptions& options_;
    ir::Scene& scene_;
    lang::Diagnostics& diagnostics_;
    MaterialTable materials_;
    std::map<std::pair<std::string, MeshNormals>, std::optional<std::uint32_t>> meshes_;
    std::set<std::string> mesh_names_;
    std::optional<host::Cache> cache_; ///< once a mesh asks for it
    std::set<std::string> paths_;
    bool full_ = false;
};

template <class Owner, class T>
bool ObjectLowering::set_field(Owner& shape, const runtime::Field<Owner, T>& field, const Thing& thing) {
    const lang::FieldValue* given = thing.find(field.name);
    if (given == nullptr) {
        return true;
    }
    if (field.present != nullptr) {
        shape.*field.present = true;
    }
    T& member = shape.*field.member;
    if constexpr (requires { assign(member, given->value); }) {
        assign(member, given->value);
        if constexpr (std::is_same_v<T, runtime::Vec3<double>>) {
            member = field.rule == runtime::Rule::direction ? normalize(member) : member;
        }
    } else {
        const auto& list = *std::get<lang::ListPtr>(given->value.v);
        if (list.size() != member.size()) {
            diagnostics_.report(Diag::impossible_shape, given->value_span,
                                fmt::format("`{}` has {} elements; a {} has {}", field.name, list.size(),
                                            Owner::name, member.size()));
            return false;
        }
        for (std::size_t i = 0; i < member.size(); ++i) {
            assign(member[i], list[i]);
        }
    }
    return true;
}

template <class Shape>
std::optional<ir::Shape> ObjectLowering::described_shape(const Thing& thing) {
    Shape shape{};
    const bool complete = std::apply(
        [&](const auto&... field) { return (set_field(shape, field, thing) & ...); }, Shape::fields());
    if (!complete) {
        return std::nullopt;
    }
    if (const std::string_view wrong = problem(shape); !wrong.empty()) {
        diagnostics_.report(Diag::impossible_shape, thing.span, wrong);
        return std::nullopt;
    }
    return ir::Shape{shape};
}

std::optional<ir::Shape> ObjectLowering::make_shape(const Thing& thing) {
    if (thing.constructor->name == runtime::Mesh<double>::name) {
        return mesh_shape(thing);
    }
    std::optional<ir::Shape> result;
    const auto try_kind = [&]<class Shape>(std::type_identity<Shape>) {
        if constexpr (requires { Shape::fields(); }) {
            if (thing.constructor->name == Shape::name) {
                result = described_shape<Shape>(thing);
            }
        }
    };
    [&]<class... All>(runtime::TypeList<All...>) {
        (try_kind(std::type_identity<All>{}), ...);
    }(runtime::Shapes<double>{});
    return result;
}

// ---- meshes
// ------------------------------------------------------------------------------------------------

std::optional<ir::Shape> ObjectLowering::mesh_shape(const Thing& thing) {
    static const std::map<std::string, MeshNormals, std::less<>> kinds{
        {"file", MeshNormals::file}, {"smooth", MeshNormals::smooth}, {"flat", MeshNormals::flat}};
    const std::string file = to_text(*thing.get("file"));
    const MeshNormals normals = kinds.at(to_text(*thing.get("normals")));
    auto [place, is_new] = meshes_.try_emplace({file, normals});
    if (is_new) {
        place->second = load_mesh(thing, file, normals);
    }
    if (!place->second) {
        return std::nullopt;
    }
    return ir::Shape{runtime::Mesh<double>{*place->second}};
}

std::optional<std::uint32_t> ObjectLowering::load_mesh(const Thing& thing, const std::string& file,
                                                       MeshNormals normals) {
    const lang::Span place = place_of(thing, "file");
    const std::string quoted = fmt::format("`{}`", file);
    const Asset asset = find_asset(options_.assets, file);
    if (asset.status == AssetStatus::outside) {
        diagnostics_.report(Diag::asset_outside, place, quoted);
        return std::nullopt;
    }
    if (asset.status == AssetStatus::missing) {
        diagnostics_.report(Diag::missing_asset, place, quoted,
                            "there is no such file in the scene's folder");
        return std::nullopt;
    }
    try {
        if (options_.keep_meshes && !cache_) {
            cache_ = host::Cache::of_user();
        }
        LoadedMesh loaded = compiler::load_mesh(asset.path, normals, cache_.value_or(host::Cache()));
        for (const std::string& warning : loaded.warnings) {
            diagnostics_.report(Diag::suspect_mesh, place, quoted, warning);
        }
        const std::string wanted = loaded.mesh.name;
        for (int i = 2; !mesh_names_.insert(loaded.mesh.name).second; ++i) {
            loaded.mesh.name = fmt::format("{} {}", wanted, i);
        }
        scene_.meshes.push_back(std::move(loaded.mesh));
        return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
    } catch (const MeshError& error) {
        diagnostics_.report(Diag::broken_mesh, place, quoted, error.what());
        return std::nullopt;
    }
}

// ---- objects
// -----------------------------------------------------------------------------------------------

std::string own_name(const Thing& thing) {
    if (const lang::FieldValue* name = thing.find("name"); name != nullptr && !to_text(name->value).empty()) {
        return to_text(name->value);
    }
    return thing.name.empty() ? std::string(thing.constructor->name) : thing.name;
}

// The determinant relative to what the columns' lengths allow; 0 for a transform that flattens.
bool is_singular(const Affine<double>& a) {
    const auto column = [&](int i) { return Vec3<double>{a.m[0][i], a.m[1][i], a.m[2][i]}; };
    const Vec3<double> x = column(0);
    const Vec3<double> y = column(1);
    const Vec3<double> z = column(2);
    const double volume = std::abs(dot(x, cross(y, z)));
    return !(volume > 1e-14 * length(x) * length(y) * length(z)) || !std::isfinite(volume);
}

void ObjectLowering::add_all(const std::vector<lang::ThingPtr>& siblings, const std::string& parent_path,
                             const Affine<double>& world_from_parent, const Thing* inherited_material) {
    // A name that several siblings share is numbered, so that every path is unique and stable.
    std::map<std::string, int> total;
    std::map<std::string, int> seen;
    for (const lang::ThingPtr& thing : siblings) {
        if (thing->constructor->type == lang::TypeKind::shape) {
            ++total[own_name(*thing)];
        }
    }
    for (const lang::ThingPtr& thing : siblings) {
        if (thing->constructor->type != lang::TypeKind::shape || full_) {
            continue;
        }
        const std::string name = own_name(*thing);
        const std::string path =
            total[name] > 1 ? fmt::format("{}{}[{}]", parent_path, name, seen[name]++) : parent_path + name;
        add(*thing, path, world_from_parent, inherited_material);
    }
}

void ObjectLowering::add(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
                         const Thing* inherited_material) {
    Affine<double> world_from_object = world_from_parent;
    if (const lang::FieldValue* transform = thing.find("transform"); transform != nullptr) {
        world_from_object = compose(world_from_parent, to_affine(transform->value));
        if (is_singular(world_from_object)) {
            diagnostics_.report(Diag::singular_transform, transform->value_span, path);
            return;
        }
    }
    const lang::FieldValue* own = thing.find("material");
    const Thing* material = own != nullptr ? to_thing(own->value).get() : inherited_material;
    if (scene_.objects.size() >= most_objects) {
        if (!full_) {
            diagnostics_.report(Diag::too_many_objects, thing.span, most_objects);
        }
        full_ = true;
        return;
    }
    if (thing.constructor->takes_children) {
        add_all(thing.children, path + "/", world_from_object, material);
        return;
    }
    if (const std::optional<ir::Shape> shape = make_shape(thing)) {
        scene_.objects.push_back(
            {*shape, world_from_object, materials_.sides(material, path), unique_path(path), thing.span});
    }
}

// Two paths meet only where an author's `name` holds a slash or a bracket.
std::string ObjectLowering::unique_path(const std::string& wanted) {
    std::string path = wanted;
    for (int i = 2; !paths_.insert(path).second; ++i) {
        path = fmt::format("{} {}", wanted, i);
    }
    return path;
}

} // namespace

ir::Scene lower(const lang::Module& module, const LowerOptions& options, lang::Diagnostics& diagnostics) {
    ir::Scene scene;
    scene.name = options.name;
    lower_settings(module, scene, diagnostics);
    ObjectLowering(options, scene, diagnostics).add_all(module.items, "", {}, nullptr);
    lower_camera(module, options, scene, diagnostics);
    lower_lights(module, scene, diagnostics);
    return scene;
}

} // namespace scc::compiler
