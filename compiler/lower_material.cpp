#include "compiler/lower_material.h"

#include "compiler/function_builder.h"
#include "compiler/schema.h"
#include "compiler/values.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::compiler {

using lang::Thing;
using runtime::Rgb;
using runtime::Varying;

runtime::Sides MaterialTable::sides(const Thing* material, const std::string& owner) {
    if (material != nullptr && material->constructor->name == "two_sided") {
        const Thing* front = to_thing(*material->get("front")).get();
        const Thing* back = to_thing(*material->get("back")).get();
        // Of a two_sided inside a two_sided, the side in question counts.
        return {sides(front, owner + " front").front, sides(back, owner + " back").back};
    }
    const std::uint32_t both = index(material, owner);
    return {both, both};
}

std::uint32_t MaterialTable::index(const Thing* phong, const std::string& owner) {
    if (const auto found = known_.find(phong); found != known_.end()) {
        return found->second;
    }
    static const Thing default_material{.constructor = scene_schema().find("phong"),
                                        .fields = {},
                                        .children = {},
                                        .name = "default",
                                        .span = {},
                                        .rows = nullptr};
    const Thing& thing = phong != nullptr ? *phong : default_material;
    ir::Material material;
    material.span = thing.span;
    material.name = unique_name(thing.name.empty() ? owner : thing.name);
    material.phong.diffuse = color(thing, "diffuse", material.name);
    material.phong.ambient =
        thing.find("ambient") != nullptr ? color(thing, "ambient", material.name) : material.phong.diffuse;
    material.phong.specular = color(thing, "specular", material.name);
    material.phong.emission = color(thing, "emission", material.name);
    material.phong.reflect = color(thing, "reflect", material.name);
    material.phong.shininess = scalar(thing, "shininess", material.name);
    warn_if_bright(thing, "diffuse", material.phong.diffuse);
    warn_if_bright(thing, "reflect", material.phong.reflect);

    const auto id = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
    known_.emplace(phong, id);
    return id;
}

std::string MaterialTable::unique_name(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !names_.insert(name).second; ++i) {
        name = fmt::format("{} {}", wanted, i);
    }
    return name;
}

Varying<Rgb<double>> MaterialTable::color(const Thing& phong, std::string_view field,
                                          const std::string& owner) {
    const lang::Value& value = *phong.get(field);
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] = function(*closure, fmt::format("{} {}", owner, field));
        Varying<Rgb<double>> result{{}, id};
        if (constants.size() == 3) {
            result.value = {constants[0], constants[1], constants[2]};
        }
        return result;
    }
    return {to_rgb(value)};
}

Varying<double> MaterialTable::scalar(const Thing& phong, std::string_view field, const std::string& owner) {
    const lang::Value& value = *phong.get(field);
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] = function(*closure, fmt::format("{} {}", owner, field));
        return {constants.size() == 1 ? constants[0] : 0, id};
    }
    return {to_number(value)};
}

std::pair<std::int32_t, std::vector<double>> MaterialTable::function(const lang::ClosurePtr& closure,
                                                                     const std::string& name) {
    if (const auto found = functions_.find(closure.get()); found != functions_.end()) {
        return found->second;
    }
    FunctionBuilder builder(images_);
    const std::vector<lang::Scalar> results = lang::trace(closure, builder, diagnostics_, images_);
    std::pair<std::int32_t, std::vector<double>> entry{runtime::no_function, {}};
    if (std::all_of(results.begin(), results.end(), [](const lang::Scalar& s) { return s.is_constant(); })) {
        for (const lang::Scalar& scalar : results) {
            entry.second.push_back(scalar.value);
        }
    } else {
        ir::Function function = builder.finish(results);
        function.name = lang::name_of(*closure).empty() ? name : lang::name_of(*closure);
        entry.first = static_cast<std::int32_t>(scene_.functions.size());
        scene_.functions.push_back(std::move(function));
    }
    functions_.emplace(closure.get(), entry);
    return entry;
}

void MaterialTable::warn_if_bright(const Thing& phong, std::string_view field,
                                   const Varying<Rgb<double>>& value) {
    const double largest = std::max({value.value.r, value.value.g, value.value.b});
    if (value.function == runtime::no_function && largest > 1) {
        diagnostics_.report(lang::Diag::bright_reflectance, place_of(phong, field),
                            fmt::format("`{}`", field), largest);
    }
}

// ---- rows of numbers --------------------------------------------------------------------------------------

/// The slot of this row, or the empty one where it belongs.
std::size_t RowIndex::slot_of(const std::uint64_t* row) const {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < width_; ++i) {
        hash = (hash ^ row[i]) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32U;
    }
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    while (slots_[slot] != empty && !std::equal(row, row + width_, rows_.data() + slots_[slot] * width_)) {
        slot = (slot + 1) & mask;
    }
    return slot;
}

std::uint32_t RowIndex::find_or_add(const std::uint64_t* row) {
    const std::size_t slot = slot_of(row);
    if (slots_[slot] != empty) {
        return slots_[slot];
    }
    const auto id = static_cast<std::uint32_t>(count_++);
    slots_[slot] = id;
    rows_.insert(rows_.end(), row, row + width_);
    if (count_ * 2 > slots_.size()) {
        grow();
    }
    return id;
}

void RowIndex::grow() {
    slots_.assign(slots_.size() * 2, empty);
    for (std::uint32_t id = 0; id < count_; ++id) {
        slots_[slot_of(rows_.data() + id * width_)] = id;
    }
}

} // namespace scc::compiler
