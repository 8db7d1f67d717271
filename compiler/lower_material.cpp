#include "compiler/lower_material.h"

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
    material.phong = lowered(thing, material.name, rec709_);
    warn_if_bright(thing, "diffuse", material.phong.diffuse);
    warn_if_bright(thing, "reflect", material.phong.reflect);

    const auto id = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
    known_.emplace(phong, id);
    things_.push_back(&thing);
    return id;
}

runtime::Phong<double> MaterialTable::lowered(const Thing& thing, const std::string& owner,
                                              const Rendition& by) {
    runtime::Phong<double> phong;
    phong.diffuse = color(thing, "diffuse", owner, by);
    phong.ambient = thing.find("ambient") != nullptr ? color(thing, "ambient", owner, by) : phong.diffuse;
    phong.specular = color(thing, "specular", owner, by);
    phong.emission = color(thing, "emission", owner, by);
    phong.reflect = color(thing, "reflect", owner, by);
    phong.shininess = scalar(thing, "shininess", owner);
    return phong;
}

void MaterialTable::add_bands(const std::vector<Rendition>& bands) {
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
        ir::Material& material = scene_.materials[i];
        for (const Rendition& band : bands) {
            material.bands.push_back(lowered(*things_[i], material.name, band));
        }
    }
}

std::string MaterialTable::unique_name(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !names_.insert(name).second; ++i) {
        name = fmt::format("{} {}", wanted, i);
    }
    return name;
}

Varying<Rgb<double>> MaterialTable::color(const Thing& phong, std::string_view field,
                                          const std::string& owner, const Rendition& by) {
    const lang::Value& value = *phong.get(field);
    const ColorRole role = field == "emission" ? ColorRole::light : ColorRole::surface;
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] = function(*closure, fmt::format("{} {}", owner, field), by, role);
        Varying<Rgb<double>> result{{}, id};
        if (constants.size() == 3) {
            result.value = {constants[0], constants[1], constants[2]};
        }
        return result;
    }
    has_spectra_ = has_spectra_ || lang::has_spectra(value);
    return {by.rendered(value, role)};
}

Varying<double> MaterialTable::scalar(const Thing& phong, std::string_view field, const std::string& owner) {
    const lang::Value& value = *phong.get(field);
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] =
            function(*closure, fmt::format("{} {}", owner, field), rec709_, ColorRole::surface);
        return {constants.size() == 1 ? constants[0] : 0, id};
    }
    return {to_number(value)};
}

MaterialTable::Traced& MaterialTable::traced(const lang::ClosurePtr& closure) {
    const auto [found, is_new] = functions_.try_emplace(closure.get(), images_);
    Traced& traced = found->second;
    if (is_new) {
        traced.result = lang::trace(closure, traced.builder, diagnostics_, images_);
        has_spectra_ = has_spectra_ || traced.result.spectral;
    }
    return traced;
}

std::pair<std::int32_t, std::vector<double>> MaterialTable::function(const lang::ClosurePtr& closure,
                                                                     const std::string& name,
                                                                     const Rendition& by, ColorRole role) {
    Traced& source = traced(closure);
    const auto [found, is_new] =
        source.lowered.try_emplace({&by, role}, runtime::no_function, std::vector<double>{});
    auto& [index, constants] = found->second;
    if (!is_new) {
        return found->second;
    }
    const lang::Components& parts = source.result;
    std::vector<lang::Scalar> results(parts.v.begin(), parts.v.begin() + parts.count);
    if (parts.kind == lang::TypeKind::color) {
        lang::ScalarMath math(&source.builder);
        const auto rendered = by.rendered(math, parts, role);
        results.assign(rendered.begin(), rendered.end());
    }
    if (std::all_of(results.begin(), results.end(), [](const lang::Scalar& s) { return s.is_constant(); })) {
        for (const lang::Scalar& scalar : results) {
            constants.push_back(scalar.value);
        }
        return found->second;
    }
    ir::Function function = source.builder.finish(results);
    function.name = lang::name_of(*closure).empty() ? name : lang::name_of(*closure);
    function.name += by.name().empty() ? "" : ", " + by.name();
    index = static_cast<std::int32_t>(scene_.functions.size());
    scene_.functions.push_back(std::move(function));
    return found->second;
}

void MaterialTable::warn_if_bright(const Thing& phong, std::string_view field,
                                   const Varying<Rgb<double>>& value) {
    if (value.function != runtime::no_function) {
        return;
    }
    double largest = std::max({value.value.r, value.value.g, value.value.b});
    if (const lang::Value& given = *phong.get(field); lang::has_spectra(given)) {
        const lang::Spectrum spectrum = lang::spectrum_of(lang::components(given));
        largest = *std::max_element(spectrum.begin(), spectrum.end());
    }
    if (largest > 1) {
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
