#include "compiler/lower.h"

#include "compiler/bounds.h"
#include "compiler/condition.h"
#include "compiler/field_bounds.h"
#include "compiler/function_builder.h"
#include "compiler/ir/objects.h"
#include "compiler/lower_material.h"
#include "compiler/lower_mesh.h"
#include "compiler/lower_view.h"
#include "compiler/schema.h"
#include "compiler/shape_rules.h"
#include "compiler/values.h"
#include "lang/schema.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
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

constexpr std::array<std::string_view, 4> container_names{
    runtime::Sphere<double>::name, runtime::Box<double>::name, runtime::Cylinder<double>::name,
    runtime::Cone<double>::name};

// ---- shapes from their own descriptions ----------------------------------------------------------------

/// `number` gives a scalar's value: its own, or that of a round.
template <class Number>
void assign(double& target, const lang::Value& value, const Number& number) {
    target = number(std::get<lang::NumberValue>(value.v).v);
}
template <class Number>
void assign(bool& target, const lang::Value& value, const Number& number) {
    target = number(std::get<lang::BoolValue>(value.v).v) != 0;
}
template <class Number>
void assign(runtime::Vec2<double>& target, const lang::Value& value, const Number& number) {
    const auto& v = std::get<lang::Vec2Value>(value.v).v;
    target = {number(v[0]), number(v[1])};
}
template <class Number>
void assign(Vec3<double>& target, const lang::Value& value, const Number& number) {
    const auto& v = std::get<lang::Vec3Value>(value.v).v;
    target = {number(v[0]), number(v[1]), number(v[2])};
}

/// The siblings' part of their paths: a name that several share is numbered, so that every path is unique and
/// stable.
struct Numbering {
    std::string parent_path;
    std::map<std::string, std::size_t> total;
    std::map<std::string, std::size_t> seen;
};

/// An author's `name` that can make two paths the same.
bool has_path_in_name(const Thing& thing) {
    const lang::FieldValue* name = thing.find("name");
    const auto* text = name != nullptr ? std::get_if<std::string>(&name->value.v) : nullptr;
    const auto within = [](const lang::ThingPtr& child) { return has_path_in_name(*child); };
    return (text != nullptr && text->find_first_of("/[") != std::string::npos) ||
           std::any_of(thing.children.begin(), thing.children.end(), within) ||
           (thing.rows && std::any_of(thing.rows->things.begin(), thing.rows->things.end(), within));
}

class ObjectLowering {
public:
    ObjectLowering(const lang::Module& module, const LowerOptions& options, MaterialTable& materials,
                   ir::Scene& scene, lang::Diagnostics& diagnostics)
        : options_(options), scene_(scene), diagnostics_(diagnostics), materials_(materials),
          meshes_(options, scene, diagnostics),
          paths_may_meet_(std::any_of(module.items.begin(), module.items.end(),
                                      [](const lang::ThingPtr& item) { return has_path_in_name(*item); })) {}

    void add_all(const std::vector<lang::ThingPtr>& siblings, const std::string& parent_path,
                 const Affine<double>& world_from_parent, const Thing* inherited_material);
    /// Whether a line that is not lit has a spectrum.
    bool lines_have_spectra() const;
    /// Gives such lines their colours in these, too.
    void add_line_bands(const std::vector<Rendition>& bands);

private:
    void add(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
             const Thing* inherited_material);
    template <class Each>
    void for_each_sibling(const lang::ThingPtr& thing, Numbering& numbering, Each each);
    void add_solid(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
                   const Thing* inherited_material);
    /// Where an operand of a solid stands.
    struct Operand {
        const std::string& path;
        const Affine<double>& world_from_parent;
        const Thing* inherited_material;
        std::string_view solid; ///< the author's word for what it is an operand of
        bool inverted;
    };
    bool add_operand(const Thing& thing, const Operand& here);
    bool add_operation(const Thing& thing, runtime::CsgOp op, const Operand& here);
    bool add_member(const Thing& thing, const Operand& here);
    bool add_contained(const Thing& thing, const Operand& here);
    std::vector<Vec3<double>> points_of_line(const Thing& thing);
    void add_thin_line(const Thing& thing, std::vector<Vec3<double>> points,
                       const Affine<double>& world_from_parent);
    void add_line(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
                  const Thing* material);
    bool add_line_operand(const Thing& thing, const Operand& here);
    const Thing* line_material(const Thing& thing, const Thing* inherited);
    void add_leaf(const ir::Shape& shape, const std::string& path, const Operand& here, lang::Span span);
    bool can_be_array(const lang::ThingRows& rows) const;
    void add_array(const lang::ThingRows& rows, Numbering& numbering, const Affine<double>& world_from_parent,
                   const Thing* inherited_material);
    std::optional<ir::ObjectColumn> column(const lang::ThingRows& rows, std::size_t index,
                                           const Numbering& numbering,
                                           const Affine<double>& world_from_parent,
                                           const Thing* inherited_material);
    std::optional<ir::Shapes> make_shapes(const lang::ThingRows& rows, std::size_t index);
    template <class Shape>
    std::optional<ir::Shapes> described_shapes(const lang::ThingRows& rows, std::size_t index);
    std::optional<Affine<double>> place_of_thing(const Thing& thing, const std::string& path,
                                                 const Affine<double>& world_from_parent);
    void check_uv(const ir::Shape& shape, const runtime::Sides& sides, const Thing& thing);
    bool has_room(std::size_t more, const Thing& thing);
    std::string next_path(Numbering& numbering, const Thing& thing) const;
    std::string unique_path(const std::string& wanted);
    std::optional<ir::Shape> make_shape(const Thing& thing);
    template <class Shape>
    std::optional<ir::Shape> described_shape(const Thing& thing);
    template <class Owner, class T, class Number>
    bool set_field(Owner& shape, const runtime::Field<Owner, T>& field, const lang::FieldValue& given,
                   const Number& number);
    std::optional<ir::Shape> implicit_shape(const Thing& thing);
    std::optional<runtime::Container<double>> container(const lang::FieldValue& within,
                                                        std::string_view contained);

    const LowerOptions& options_;
    ir::Scene& scene_;
    lang::Diagnostics& diagnostics_;
    MaterialTable& materials_;
    MeshTable meshes_;
    std::set<std::string> paths_;
    std::vector<lang::ThingPtr> made_materials_; ///< of colours of lines
    std::vector<lang::Value> line_colors_;       ///< of the scene's polylines
    std::vector<lang::ThingPtr> taken_apart_;    ///< things of rows; the materials refer to them
    std::size_t count_ = 0;                      ///< of objects, those in arrays too
    bool paths_may_meet_;
    bool full_ = false;
};

template <class Owner, class T, class Number>
bool ObjectLowering::set_field(Owner& shape, const runtime::Field<Owner, T>& field,
                               const lang::FieldValue& given, const Number& number) {
    if (field.present != nullptr) {
        shape.*field.present = true;
    }
    T& member = shape.*field.member;
    if constexpr (requires { assign(member, given.value, number); }) {
        assign(member, given.value, number);
        if constexpr (std::is_same_v<T, runtime::Vec3<double>>) {
            member = field.rule == runtime::Rule::direction ? to_direction(member) : member;
        }
    } else {
        const auto& list = *std::get<lang::ListPtr>(given.value.v);
        if (list.size() != member.size()) {
            diagnostics_.report(Diag::impossible_shape, given.value_span,
                                fmt::format("`{}` has {} elements; a {} has {}", field.name, list.size(),
                                            Owner::name, member.size()));
            return false;
        }
        for (std::size_t i = 0; i < member.size(); ++i) {
            assign(member[i], list[i], number);
        }
    }
    return true;
}

template <class Shape>
std::optional<ir::Shape> ObjectLowering::described_shape(const Thing& thing) {
    Shape shape{};
    const auto set = [&](const auto& field) {
        const lang::FieldValue* given = thing.find(field.name);
        return given == nullptr ||
               set_field(shape, field, *given, [](const lang::Scalar& scalar) { return scalar.value; });
    };
    if (!std::apply([&](const auto&... field) { return (set(field) & ...); }, Shape::fields())) {
        return std::nullopt;
    }
    if (const std::string_view wrong = problem(shape); !wrong.empty()) {
        diagnostics_.report(Diag::impossible_shape, thing.span, wrong);
        return std::nullopt;
    }
    return ir::Shape{shape};
}

/// Calls `make` with the type that describes itself under this name, if there is one.
template <class Result, class Make>
Result made_by_description(std::string_view name, const Make& make) {
    Result result{};
    const auto try_kind = [&]<class Shape>(std::type_identity<Shape> kind) {
        if constexpr (requires { Shape::fields(); }) {
            if (name == Shape::name) {
                result = make(kind);
            }
        }
    };
    [&]<class... All>(runtime::TypeList<All...>) {
        (try_kind(std::type_identity<All>{}), ...);
    }(runtime::Shapes<double>{});
    return result;
}

std::string own_name(const Thing& thing) {
    if (const lang::FieldValue* name = thing.find("name"); name != nullptr && !to_text(name->value).empty()) {
        return to_text(name->value);
    }
    return thing.name.empty() ? std::string(thing.constructor->name) : thing.name;
}

std::optional<ir::Shape> mesh(std::optional<std::uint32_t> index) {
    return index ? std::optional<ir::Shape>(runtime::Mesh<double>{*index}) : std::nullopt;
}

std::optional<ir::Shape> ObjectLowering::make_shape(const Thing& thing) {
    if (thing.constructor->name == runtime::Mesh<double>::name) {
        return mesh(meshes_.of_file(thing));
    }
    if (thing.constructor->name == runtime::Implicit<double>::name) {
        return implicit_shape(thing);
    }
    if (thing.constructor->name == "heightfield") {
        return mesh(meshes_.of_heights(thing, own_name(thing)));
    }
    return made_by_description<std::optional<ir::Shape>>(
        thing.constructor->name,
        [&]<class Shape>(std::type_identity<Shape>) { return described_shape<Shape>(thing); });
}

// ---- implicit surfaces
// -------------------------------------------------------------------------------------

/// `contained`: the word for what is in it.
std::optional<runtime::Container<double>> ObjectLowering::container(const lang::FieldValue& within,
                                                                    std::string_view contained) {
    const Thing& thing = *to_thing(within.value);
    std::string wrong;
    if (thing.rows || thing.constructor->takes_children ||
        std::find(container_names.begin(), container_names.end(), thing.constructor->name) ==
            container_names.end()) {
        wrong = fmt::format("this is a {}; a container is a sphere, box, cylinder or cone",
                            thing.constructor->name);
    } else if (const lang::Value* caps = thing.get("caps"); caps != nullptr && !to_bool(*caps)) {
        wrong = fmt::format("this {} is open; a container is closed", thing.constructor->name);
    } else if (thing.find("transform") != nullptr) {
        wrong = fmt::format("a container has no `transform`; the {} can have one", contained);
    } else if (thing.find("material") != nullptr) {
        wrong =
            fmt::format("a container has no `material`; where it cuts, that of the {} is seen", contained);
    }
    if (!wrong.empty()) {
        diagnostics_.report(Diag::unusable_container, within.value_span, wrong);
        return std::nullopt;
    }
    const std::optional<ir::Shape> shape = make_shape(thing);
    if (!shape) {
        return std::nullopt;
    }
    return std::visit(
        [](const auto& s) -> std::optional<runtime::Container<double>> {
            if constexpr (requires { runtime::Container<double>::of(s); }) {
                return runtime::Container<double>::of(s);
            } else {
                return std::nullopt;
            }
        },
        *shape);
}

std::optional<ir::Shape> ObjectLowering::implicit_shape(const Thing& thing) {
    const auto within = container(*thing.find("within"), "implicit surface");
    const lang::FieldValue& field = *thing.find("field");
    const auto& closure = std::get<lang::ClosurePtr>(field.value.v);
    FunctionBuilder builder(options_.images);
    const std::vector<lang::Scalar> results =
        lang::trace_at_point(closure, builder, diagnostics_, options_.images);
    if (!within || results.size() != 1) {
        return std::nullopt;
    }
    ir::Function function = builder.finish(results);
    if (!function.images.empty()) {
        diagnostics_.report(Diag::unsupported_setting, field.value_span,
                            "an image in the field of an implicit surface");
        return std::nullopt;
    }
    function.name = lang::name_of(*closure).empty() ? own_name(thing) + " field" : lang::name_of(*closure);
    if (const auto found = find_unbounded(function, *within)) {
        diagnostics_.report(Diag::unbounded_field,
                            found->place == lang::Span{} ? field.value_span : found->place, found->what);
        return std::nullopt;
    }
    scene_.functions.push_back(std::move(function));
    return ir::Shape{
        runtime::Implicit<double>{static_cast<std::int32_t>(scene_.functions.size() - 1), *within}};
}

// ---- objects
// -----------------------------------------------------------------------------------------------

/// Flattens what it is applied to, as far as numbers can tell.
bool is_singular(const Affine<double>& a) {
    return !(condition(a) < 1 / std::numeric_limits<double>::epsilon());
}

Numbering number_siblings(const std::vector<lang::ThingPtr>& siblings, const std::string& parent_path) {
    Numbering numbering{parent_path, {}, {}};
    for (const lang::ThingPtr& thing : siblings) {
        if (thing->rows) {
            for (const lang::ThingPtr& one : thing->rows->things) {
                numbering.total[own_name(*one)] += thing->rows->count;
            }
        } else if (thing->constructor->type == lang::TypeKind::shape) {
            ++numbering.total[own_name(*thing)];
        }
    }
    return numbering;
}

void ObjectLowering::add_all(const std::vector<lang::ThingPtr>& siblings, const std::string& parent_path,
                             const Affine<double>& world_from_parent, const Thing* inherited_material) {
    Numbering numbering = number_siblings(siblings, parent_path);
    for (const lang::ThingPtr& thing : siblings) {
        if (thing->constructor->type != lang::TypeKind::shape || full_) {
            continue;
        }
        if (thing->rows && can_be_array(*thing->rows)) {
            add_array(*thing->rows, numbering, world_from_parent, inherited_material);
            continue;
        }
        for_each_sibling(thing, numbering, [&](const Thing& one, const std::string& path) {
            add(one, path, world_from_parent, inherited_material);
        });
    }
}

/// Calls `each(thing, its path)` with the thing, or with every one that its rows stand for.
template <class Each>
void ObjectLowering::for_each_sibling(const lang::ThingPtr& thing, Numbering& numbering, Each each) {
    if (!thing->rows) {
        each(*thing, next_path(numbering, *thing));
        return;
    }
    for (std::size_t i = 0; i < count_of(*thing) && !full_; ++i) {
        const std::size_t in_round = thing->rows->things.size();
        taken_apart_.push_back(thing->rows->thing(i % in_round, i / in_round));
        const Thing& one = *taken_apart_.back();
        each(one, next_path(numbering, one));
    }
}

std::string ObjectLowering::next_path(Numbering& numbering, const Thing& thing) const {
    const std::string name = own_name(thing);
    const std::string path = numbering.parent_path + name;
    return numbering.total[name] > 1 ? fmt::format("{}[{}]", path, numbering.seen[name]++) : path;
}

std::optional<Affine<double>> ObjectLowering::place_of_thing(const Thing& thing, const std::string& path,
                                                             const Affine<double>& world_from_parent) {
    const lang::FieldValue* transform = thing.find("transform");
    if (transform == nullptr) {
        return world_from_parent;
    }
    const Affine<double> place = compose(world_from_parent, to_affine(transform->value));
    const Vec3<double> moved = translation_of(place);
    if (!std::isfinite(moved.x) || !std::isfinite(moved.y) || !std::isfinite(moved.z)) {
        diagnostics_.report(Diag::endless_transform, transform->value_span, path);
        return std::nullopt;
    }
    if (is_singular(place)) {
        diagnostics_.report(Diag::singular_transform, transform->value_span, path);
        return std::nullopt;
    }
    return place;
}

bool ObjectLowering::has_room(std::size_t more, const Thing& thing) {
    if (!full_ && most_objects - count_ < more) {
        diagnostics_.report(Diag::too_many_objects, thing.span, most_objects);
        full_ = true;
    }
    return !full_;
}

std::optional<runtime::CsgOp> csg_op(const Thing& thing) {
    for (const runtime::CsgOp op :
         {runtime::CsgOp::unite, runtime::CsgOp::intersect, runtime::CsgOp::subtract}) {
        if (thing.constructor->name == ir::csg_word(op)) {
            return op;
        }
    }
    return std::nullopt;
}

/// A quadric within a container is the intersection of both.
bool is_contained(const Thing& thing) {
    return thing.constructor->name == runtime::Quadric<double>::name && thing.find("within") != nullptr;
}

bool is_line(const Thing& thing) {
    return thing.constructor->name == "polyline";
}

void ObjectLowering::add(const Thing& thing, const std::string& path, const Affine<double>& world_from_parent,
                         const Thing* inherited_material) {
    const auto place = place_of_thing(thing, path, world_from_parent);
    if (!place) {
        return;
    }
    const lang::FieldValue* own = thing.find("material");
    const Thing* material = own != nullptr ? to_thing(own->value).get() : inherited_material;
    if (!has_room(1, thing)) {
        return;
    }
    if (is_line(thing)) {
        add_line(thing, path, *place, material);
        return;
    }
    if (csg_op(thing) || is_contained(thing)) {
        add_solid(thing, path, *place, material);
        return;
    }
    if (thing.constructor->takes_children) {
        add_all(thing.children, path + "/", *place, material);
        return;
    }
    if (const std::optional<ir::Shape> shape = make_shape(thing)) {
        ++count_;
        const runtime::Sides sides = materials_.sides(material, path);
        check_uv(*shape, sides, thing);
        scene_.objects.push_back({*shape, *place, sides, unique_path(path), thing.span});
    }
}

/// Whether the shape has what the functions of its materials read.
void ObjectLowering::check_uv(const ir::Shape& shape, const runtime::Sides& sides, const Thing& thing) {
    const auto reads_uv = [&](std::uint32_t material) {
        return ir::material_reads(scene_, material, ir::Input::uv_x, ir::Input::uv_y);
    };
    if (!reads_uv(sides.front) && !reads_uv(sides.back)) {
        return;
    }
    const auto* mesh = std::get_if<runtime::Mesh<double>>(&shape);
    if (mesh != nullptr && scene_.meshes[mesh->mesh].uvs.empty()) {
        const bool is_off = !to_bool(*thing.get("uv"));
        diagnostics_.report(Diag::mesh_without_uv, is_off ? place_of(thing, "uv") : place_of(thing, "file"),
                            is_off ? "the mesh has `uv = false`"
                                   : "not all corners in the mesh's file have texture coordinates");
    }
}

// ---- solids
// ------------------------------------------------------------------------------------------------

/// `world_from_parent` and the material are the thing's own already.
void ObjectLowering::add_solid(const Thing& thing, const std::string& path,
                               const Affine<double>& world_from_parent, const Thing* inherited_material) {
    const std::string_view word = thing.constructor->name;
    const auto root = static_cast<std::uint32_t>(scene_.csg_nodes.size());
    const std::size_t members = scene_.members.size();
    const Operand whole{path, world_from_parent, inherited_material, word, false};
    const bool sound =
        is_contained(thing) ? add_contained(thing, whole) : add_operation(thing, *csg_op(thing), whole);
    const auto take_back = [&] {
        scene_.csg_nodes.resize(root);
        scene_.members.resize(members);
    };
    if (!sound) {
        take_back();
        return;
    }
    const runtime::Bounds<double> box =
        scene_.csg_nodes.size() == root ? runtime::Bounds<double>{} : solid_bounds(scene_, root);
    const Vec3<double> size = box.max - box.min;
    if (!(size.x >= 0 && size.y >= 0 && size.z >= 0)) {
        diagnostics_.report(Diag::empty_solid, thing.span, word);
        take_back();
        return;
    }
    if (!std::isfinite(size.x + size.y + size.z)) {
        diagnostics_.report(Diag::unbounded_solid, thing.span, word);
        take_back();
        return;
    }
    ++count_;
    scene_.objects.push_back(
        {runtime::Csg<double>{root}, {}, scene_.members[members].sides, unique_path(path), thing.span});
}

/// Appends a subtree, or nothing where it is empty; false where something in it is wrong, which is reported.
/// By recursion, as all that walks these trees: the language nests things at most 200 deep.
bool ObjectLowering::add_operation(const Thing& thing, runtime::CsgOp op, const Operand& here) {
    const std::size_t root = scene_.csg_nodes.size();
    scene_.csg_nodes.push_back({op});
    const std::string parent_path = here.path + "/";
    Numbering numbering = number_siblings(thing.children, parent_path);
    const std::size_t members = scene_.members.size();
    std::size_t operands = 0;
    bool sound = true, empty = true;
    for (const lang::ThingPtr& child : thing.children) {
        if (child->constructor->type != lang::TypeKind::shape) {
            continue;
        }
        for_each_sibling(child, numbering, [&](const Thing& one, const std::string& path) {
            const bool removed = op == runtime::CsgOp::subtract && operands > 0;
            const std::size_t before = scene_.csg_nodes.size();
            sound &= add_operand(one, {path, here.world_from_parent, here.inherited_material, here.solid,
                                       here.inverted != removed});
            const bool nothing = scene_.csg_nodes.size() == before;
            empty = operands++ == 0                   ? nothing
                    : op == runtime::CsgOp::unite     ? empty && nothing
                    : op == runtime::CsgOp::intersect ? empty || nothing
                                                      : empty;
        });
    }
    scene_.csg_nodes[root].size = static_cast<std::uint32_t>(scene_.csg_nodes.size() - root);
    if (empty) {
        scene_.csg_nodes.resize(root);
        scene_.members.resize(members);
    }
    return sound && !full_;
}

bool ObjectLowering::add_operand(const Thing& thing, const Operand& here) {
    const auto place = place_of_thing(thing, here.path, here.world_from_parent);
    if (!place || !has_room(1, thing)) {
        return false;
    }
    const lang::FieldValue* own = thing.find("material");
    const Thing* material = own != nullptr ? to_thing(own->value).get() : here.inherited_material;
    const auto op = csg_op(thing);
    const Operand within{here.path, *place, material, op ? thing.constructor->name : here.solid,
                         here.inverted};
    return thing.constructor->takes_children
               ? add_operation(thing, op.value_or(runtime::CsgOp::unite), within)
           : is_line(thing)      ? add_line_operand(thing, within)
           : is_contained(thing) ? add_contained(thing, within)
                                 : add_member(thing, within);
}

bool ObjectLowering::add_member(const Thing& thing, const Operand& here) {
    const std::optional<ir::Shape> shape = make_shape(thing);
    if (!shape) {
        return false;
    }
    const auto* mesh = std::get_if<runtime::Mesh<double>>(&*shape);
    const std::string open = mesh != nullptr ? meshes_.opening(mesh->mesh) : std::string(open_part(*shape));
    if (!open.empty()) {
        diagnostics_.report(Diag::open_solid, mesh != nullptr ? thing.span : place_of(thing, "caps"),
                            fmt::format("this {} {}", thing.constructor->name, open), here.solid);
        return false;
    }
    add_leaf(*shape, here.path, here, thing.span);
    return true;
}

bool ObjectLowering::add_contained(const Thing& thing, const Operand& here) {
    const std::optional<ir::Shape> quadric = make_shape(thing);
    const auto within = container(*thing.find("within"), thing.constructor->name);
    if (!quadric || !within) {
        return false;
    }
    scene_.csg_nodes.push_back({runtime::CsgOp::intersect, 3});
    add_leaf(*quadric, here.path + "/surface", here, thing.span);
    add_leaf(within->visit([](const auto& shape) { return ir::Shape{shape}; }), here.path + "/within", here,
             thing.span);
    return true;
}

void ObjectLowering::add_leaf(const ir::Shape& shape, const std::string& path, const Operand& here,
                              lang::Span span) {
    ++count_;
    scene_.csg_nodes.push_back(
        {runtime::CsgOp::member, 1, static_cast<std::uint32_t>(scene_.members.size()), here.inverted});
    scene_.members.push_back({shape, here.world_from_parent, materials_.sides(here.inherited_material, path),
                              unique_path(path), span});
}

// ---- polylines
// -----------------------------------------------------------------------------------------------

/// f(shape, its part of the path) with the balls and tubes of a line: a ball at each point and a tube to the
/// next. Tubes are open where nothing but surfaces counts, since their ends lie within the balls.
template <class F>
void for_each_capsule(const std::vector<Vec3<double>>& points, double radius, bool closed, F f) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        f(ir::Shape{runtime::Sphere<double>{points[i], radius}}, fmt::format("/ball[{}]", i));
        if (i + 1 < points.size()) {
            f(ir::Shape{runtime::Cylinder<double>{points[i], points[i + 1], radius, closed}},
              fmt::format("/tube[{}]", i));
        }
    }
}

/// Without repetitions; none where the line cannot be drawn, which is reported.
std::vector<Vec3<double>> ObjectLowering::points_of_line(const Thing& thing) {
    std::vector<Vec3<double>> points;
    for (const lang::Value& value : *std::get<lang::ListPtr>(thing.get("points")->v)) {
        if (const Vec3<double> point = to_vec3(value); points.empty() || !(points.back() == point)) {
            points.push_back(point);
        }
    }
    if (points.size() < 2) {
        diagnostics_.report(Diag::impossible_shape, place_of(thing, "points"),
                            "this polyline goes nowhere; it has at least two different points");
        return {};
    }
    return has_room(2 * points.size() - 1, thing) ? points : std::vector<Vec3<double>>{};
}

/// `color` stands for a material of that diffuse colour.
const Thing* ObjectLowering::line_material(const Thing& thing, const Thing* inherited) {
    const lang::FieldValue* color = thing.find("color");
    if (color == nullptr) {
        return inherited;
    }
    lang::FieldValue diffuse = *color;
    diffuse.name = "diffuse";
    made_materials_.push_back(std::make_shared<const Thing>(Thing{.constructor = scene_schema().find("phong"),
                                                                  .fields = {diffuse},
                                                                  .children = {},
                                                                  .name = thing.name,
                                                                  .span = thing.span,
                                                                  .rows = nullptr}));
    return made_materials_.back().get();
}

bool ObjectLowering::lines_have_spectra() const {
    return std::any_of(line_colors_.begin(), line_colors_.end(), lang::has_spectra);
}

void ObjectLowering::add_line_bands(const std::vector<Rendition>& bands) {
    for (std::size_t i = 0; i < line_colors_.size(); ++i) {
        for (const Rendition& band : bands) {
            scene_.polylines[i].bands.push_back(band.rendered(line_colors_[i], ColorRole::light));
        }
    }
}

/// A line without a radius. It is not lit.
void ObjectLowering::add_thin_line(const Thing& thing, std::vector<Vec3<double>> points,
                                   const Affine<double>& world_from_parent) {
    ir::Polyline line{
        .points = std::move(points), .width = to_number(*thing.get("width")), .span = thing.span};
    const lang::FieldValue* color = thing.find("color");
    const lang::Value white{lang::ColorValue{{lang::Scalar{1}, lang::Scalar{1}, lang::Scalar{1}}}};
    line_colors_.push_back(color != nullptr ? color->value : white);
    line.color = materials_.shown(line_colors_.back());
    for (Vec3<double>& point : line.points) {
        point = transform_point(world_from_parent, point);
    }
    ++count_;
    scene_.polylines.push_back(std::move(line));
}

void ObjectLowering::add_line(const Thing& thing, const std::string& path,
                              const Affine<double>& world_from_parent, const Thing* material) {
    const bool is_thin = thing.find("radius") == nullptr;
    if (is_thin && scene_.settings.method != runtime::Method::raster) {
        diagnostics_.report(Diag::thin_line, thing.span);
        return;
    }
    std::vector<Vec3<double>> points = points_of_line(thing);
    if (points.empty()) {
        return;
    }
    if (is_thin) {
        add_thin_line(thing, std::move(points), world_from_parent);
        return;
    }
    const runtime::Sides sides = materials_.sides(line_material(thing, material), path);
    for_each_capsule(
        points, to_number(*thing.get("radius")), false, [&](const ir::Shape& shape, const std::string& part) {
            ++count_;
            scene_.objects.push_back({shape, world_from_parent, sides, unique_path(path + part), thing.span});
        });
}

bool ObjectLowering::add_line_operand(const Thing& thing, const Operand& here) {
    if (thing.find("radius") == nullptr) {
        diagnostics_.report(Diag::thin_line, thing.span);
        return false;
    }
    const std::vector<Vec3<double>> points = points_of_line(thing);
    if (points.empty()) {
        return false;
    }
    Operand whole = here;
    whole.inherited_material = line_material(thing, here.inherited_material);
    scene_.csg_nodes.push_back(
        {runtime::CsgOp::unite, static_cast<std::uint32_t>(2 * points.size())}); // with itself
    for_each_capsule(points, to_number(*thing.get("radius")), true,
                     [&](const ir::Shape& shape, const std::string& part) {
                         add_leaf(shape, here.path + part, whole, thing.span);
                     });
    return true;
}

// ---- arrays
// ------------------------------------------------------------------------------------------------

/// Things that describe themselves in numbers, with paths that meet no other.
bool ObjectLowering::can_be_array(const lang::ThingRows& rows) const {
    const auto is_described = [](const lang::ThingPtr& thing) {
        return !is_contained(*thing) &&
               made_by_description<bool>(thing->constructor->name, [](auto) { return true; });
    };
    return rows.count > 1 && !paths_may_meet_ &&
           std::all_of(rows.things.begin(), rows.things.end(), is_described);
}

void ObjectLowering::add_array(const lang::ThingRows& rows, Numbering& numbering,
                               const Affine<double>& world_from_parent, const Thing* inherited_material) {
    if (!has_room(rows.count * rows.things.size(), *rows.things.front())) {
        return;
    }
    ir::ObjectArray array{scene_.objects.size(), rows.count, {}};
    for (std::size_t i = 0; i < rows.things.size(); ++i) {
        if (auto made = column(rows, i, numbering, world_from_parent, inherited_material)) {
            array.columns.push_back(std::move(*made));
        }
    }
    for (const lang::ThingPtr& thing : rows.things) {
        numbering.seen[own_name(*thing)] += rows.count;
    }
    if (array.columns.size() == rows.things.size()) {
        count_ += rows.count * rows.things.size();
        scene_.arrays.push_back(std::move(array));
    }
}

std::optional<ir::ObjectColumn> ObjectLowering::column(const lang::ThingRows& rows, std::size_t index,
                                                       const Numbering& numbering,
                                                       const Affine<double>& world_from_parent,
                                                       const Thing* inherited_material) {
    const Thing& thing = *rows.things[index];
    const std::string name = own_name(thing);
    const auto same = [&](const lang::ThingPtr& other) { return own_name(*other) == name; };
    const auto here = rows.things.begin() + static_cast<std::ptrdiff_t>(index);
    const auto seen = numbering.seen.find(name);
    ir::ObjectColumn column;
    column.path = numbering.parent_path + name;
    column.first_number = (seen == numbering.seen.end() ? 0 : seen->second) +
                          static_cast<std::size_t>(std::count_if(rows.things.begin(), here, same));
    column.number_step =
        static_cast<std::size_t>(std::count_if(rows.things.begin(), rows.things.end(), same));
    column.span = thing.span;
    column.places = rows.places;
    column.first_place = rows.begin;
    const auto place = place_of_thing(thing, column.path_of(0), world_from_parent);
    auto shapes = make_shapes(rows, index);
    if (!place || !shapes) {
        return std::nullopt;
    }
    column.world_from_object = *place;
    column.shapes = std::move(*shapes);
    const lang::FieldValue* own = thing.find("material");
    if (own != nullptr) {
        column.sides = materials_.sides(rows, to_thing(own->value),
                                        [&](std::size_t round) { return column.path_of(round); });
    } else {
        column.sides = {materials_.sides(inherited_material, column.path_of(0))};
    }
    return column;
}

std::optional<ir::Shapes> ObjectLowering::make_shapes(const lang::ThingRows& rows, std::size_t index) {
    return made_by_description<std::optional<ir::Shapes>>(
        rows.things[index]->constructor->name,
        [&]<class Shape>(std::type_identity<Shape>) { return described_shapes<Shape>(rows, index); });
}

template <class Shape>
std::optional<ir::Shapes> ObjectLowering::described_shapes(const lang::ThingRows& rows, std::size_t index) {
    std::vector<Shape> shapes(rows.count);
    const auto set = [&](const auto& field) {
        const lang::FieldValue* given = rows.things[index]->find(field.name);
        bool fine = true;
        for (std::size_t round = 0; given != nullptr && fine && round < rows.count; ++round) {
            fine = set_field(shapes[round], field, *given,
                             [&](const lang::Scalar& scalar) { return rows.number(scalar, round); });
        }
        return fine;
    };
    if (!std::apply([&](const auto&... field) { return (set(field) & ...); }, Shape::fields())) {
        return std::nullopt;
    }
    bool sound = true;
    for (std::size_t round = 0; round < rows.count; ++round) {
        if (const std::string_view wrong = problem(shapes[round]); !wrong.empty()) {
            diagnostics_.report(Diag::impossible_shape, rows.span(index, round), wrong);
            sound = false;
        }
    }
    return sound ? std::optional<ir::Shapes>(std::move(shapes)) : std::nullopt;
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

namespace {

/// Takes out what raster mode has not: shadows, mirrors, refraction. What is transparent can lie before any
/// number of others that are.
void leave_surfaces_alone(ir::Scene& scene, lang::Diagnostics& diagnostics) {
    scene.settings.shadows = false;
    scene.settings.depth = runtime::most_bounces;
    const auto leave_alone = [](runtime::Phong<double>& phong) {
        phong.reflect = {};
        phong.ior = {1};
        phong.fresnel = false;
        phong.bump = runtime::no_function;
    };
    for (ir::Material& material : scene.materials) {
        if (material.phong.bump != runtime::no_function) {
            diagnostics.report(Diag::raster_leaves_out, material.span, "bumps",
                               "the surface is lit as if smooth");
        }
        leave_alone(material.phong);
        std::for_each(material.bands.begin(), material.bands.end(), leave_alone);
    }
}

} // namespace

ir::Scene lower(const lang::Module& module, const LowerOptions& options, lang::Diagnostics& diagnostics) {
    ir::Scene scene;
    scene.name = options.name;
    const lang::Spectrum& illuminant = illuminant_of(module);
    const Rendition rec709 = Rendition::rec709(illuminant);
    lower_settings(module, options, rec709, scene, diagnostics);
    MaterialTable materials(scene, rec709, options.images, diagnostics);
    // Holds things that the materials refer to until the end.
    ObjectLowering objects(module, options, materials, scene, diagnostics);
    objects.add_all(module.items, "", {}, nullptr);
    lower_camera(module, options, scene, diagnostics);
    lower_lights(module, rec709, scene, diagnostics);
    if (materials.has_spectra() || objects.lines_have_spectra() || view_has_spectra(module)) {
        const std::vector<Rendition> bands = Rendition::bands(illuminant);
        materials.add_bands(bands);
        add_view_bands(module, bands, scene);
        objects.add_line_bands(bands);
    }
    if (scene.settings.method == runtime::Method::raster) {
        leave_surfaces_alone(scene, diagnostics);
    }
    return scene;
}

} // namespace scc::compiler
