#include "compiler/lower_material.h"

#include "compiler/derivative.h"
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

std::uint32_t MaterialTable::index(const Thing* given, const std::string& owner) {
    if (const auto found = known_.find(given); found != known_.end()) {
        return found->second;
    }
    static const Thing default_material{.constructor = scene_schema().find("phong"),
                                        .fields = {},
                                        .children = {},
                                        .name = "default",
                                        .span = {},
                                        .rows = nullptr};
    const Thing& thing = given != nullptr ? *given : default_material;
    ir::Material material;
    material.span = thing.span;
    material.name = unique_name(thing.name.empty() ? owner : thing.name);
    material.phong = lowered(thing, material.name, rec709_);
    if (material.phong.fresnel) {
        warn_if_bright(thing, "tint", material.phong.transmit);
    } else {
        warn_if_bright(thing, "diffuse", material.phong.diffuse);
        warn_if_bright(thing, "reflect", material.phong.reflect);
        warn_if_bright(thing, "transmit", material.phong.transmit);
    }
    warn_of_idle_ior(thing, material.phong);
    check_bump(thing, material.phong);

    const auto id = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
    known_.emplace(given, id);
    things_.push_back(&thing);
    return id;
}

runtime::Phong<double> MaterialTable::lowered(const Thing& material, const std::string& owner,
                                              const Rendition& by) {
    return material.constructor->name == "glass" ? lowered_glass(material, owner, by)
                                                 : lowered_phong(material, owner, by);
}

runtime::Phong<double> MaterialTable::lowered_phong(const Thing& thing, const std::string& owner,
                                                    const Rendition& by) {
    const Opacity opacity = opacity_of(thing);
    const Treatment dimmed{&by, ColorRole::surface, Covering::dims, opacity};
    runtime::Phong<double> phong;
    phong.diffuse = color(thing, "diffuse", owner, dimmed);
    phong.ambient = thing.find("ambient") != nullptr ? color(thing, "ambient", owner, dimmed) : phong.diffuse;
    phong.specular = color(thing, "specular", owner, dimmed);
    phong.emission = color(thing, "emission", owner, {&by, ColorRole::light, Covering::dims, opacity});
    phong.reflect = color(thing, "reflect", owner, {&by});
    phong.transmit =
        color(thing, "transmit", owner, {&by, ColorRole::surface, Covering::leaves_open, opacity});
    phong.shininess = scalar(thing, "shininess", owner);
    phong.ior = to_number(*thing.get("ior"));
    phong.bump = bump(thing, owner);
    return phong;
}

runtime::Phong<double> MaterialTable::lowered_glass(const Thing& thing, const std::string& owner,
                                                    const Rendition& by) {
    runtime::Phong<double> phong;
    phong.specular = color(thing, "specular", owner, {&by});
    phong.reflect.value = {1, 1, 1};
    phong.transmit = color(thing, "tint", owner, {&by});
    phong.shininess = scalar(thing, "shininess", owner);
    phong.ior = to_number(*thing.get("ior"));
    phong.fresnel = true;
    return phong;
}

MaterialTable::Opacity MaterialTable::opacity_of(const Thing& phong) {
    const lang::Value& value = *phong.get("opacity");
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        return {1, *closure};
    }
    return {to_number(value), nullptr};
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

Varying<Rgb<double>> MaterialTable::color(const Thing& material, std::string_view field,
                                          const std::string& owner, Treatment treatment) {
    const lang::Value& value = *material.get(field);
    const std::string name = fmt::format("{} {}", owner, field);
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] = function(*closure, name, treatment);
        Varying<Rgb<double>> result{{}, id};
        if (constants.size() == 3) {
            result.value = {constants[0], constants[1], constants[2]};
        }
        return result;
    }
    has_spectra_ = has_spectra_ || lang::has_spectra(value);
    const Rgb<double> constant = treatment.rendition->rendered(value, treatment.role);
    return treatment.covering == Covering::none ? Varying<Rgb<double>>{constant}
                                                : covered(constant, name, treatment);
}

Varying<Rgb<double>> MaterialTable::covered(const Rgb<double>& color, const std::string& name,
                                            const Treatment& treatment) {
    // What is black without its covering stays so, whatever that is.
    const bool stays = treatment.covering == Covering::dims && color == Rgb<double>{};
    const lang::ClosurePtr& varying = treatment.opacity.function;
    Traced* source = varying && !stays ? &traced(varying) : nullptr;
    lang::ScalarMath math(source != nullptr ? &source->builder : nullptr);
    const lang::Scalar opacity =
        source != nullptr ? opacity_in(*source, treatment.opacity) : lang::Scalar{treatment.opacity.value};
    std::vector<lang::Scalar> results;
    for (const double channel : {color.r, color.g, color.b}) {
        results.push_back(cover(math, {channel}, opacity, treatment.covering));
    }
    if (opacity.is_constant()) {
        return {{results[0].value, results[1].value, results[2].value}};
    }
    return {{}, add_function(source->builder.finish(results), name, treatment)};
}

Varying<double> MaterialTable::scalar(const Thing& phong, std::string_view field, const std::string& owner) {
    const lang::Value& value = *phong.get(field);
    if (const auto* closure = std::get_if<lang::ClosurePtr>(&value.v)) {
        const auto [id, constants] = function(*closure, fmt::format("{} {}", owner, field), {&rec709_});
        return {constants.size() == 1 ? constants[0] : 0, id};
    }
    return {to_number(value)};
}

/// no_function where it tilts no normal.
std::int32_t MaterialTable::bump(const Thing& phong, const std::string& owner) {
    if (phong.find("bump") == nullptr) {
        return runtime::no_function;
    }
    const auto& closure = std::get<lang::ClosurePtr>(phong.get("bump")->v);
    const std::int32_t id = function(closure, fmt::format("{} bump", owner), {&rec709_}).first;
    return id != runtime::no_function && has_slope(scene_.functions[static_cast<std::size_t>(id)])
               ? id
               : runtime::no_function;
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
                                                                     const Treatment& treatment) {
    Traced& source = traced(closure);
    const Opacity& opacity = treatment.opacity;
    const auto [found, is_new] = source.lowered.try_emplace(
        {treatment.rendition, treatment.role, treatment.covering, opacity.value, opacity.function.get()},
        runtime::no_function, std::vector<double>{});
    auto& [index, constants] = found->second;
    if (!is_new) {
        return found->second;
    }
    const std::vector<lang::Scalar> results = treated(source, treatment);
    if (std::all_of(results.begin(), results.end(), [](const lang::Scalar& s) { return s.is_constant(); })) {
        for (const lang::Scalar& scalar : results) {
            constants.push_back(scalar.value);
        }
        return found->second;
    }
    const std::string own_name(lang::name_of(*closure));
    index = add_function(source.builder.finish(results), own_name.empty() ? name : own_name, treatment);
    return found->second;
}

std::vector<lang::Scalar> MaterialTable::treated(Traced& source, const Treatment& treatment) {
    const lang::Components& parts = source.result;
    std::vector<lang::Scalar> results(parts.v.begin(), parts.v.begin() + parts.count);
    lang::ScalarMath math(&source.builder);
    if (parts.kind == lang::TypeKind::color) {
        const auto rendered = treatment.rendition->rendered(math, parts, treatment.role);
        results.assign(rendered.begin(), rendered.end());
    }
    if (treatment.covering != Covering::none) {
        const lang::Scalar opacity = opacity_in(source, treatment.opacity);
        for (lang::Scalar& scalar : results) {
            scalar = cover(math, scalar, opacity, treatment.covering);
        }
    }
    return results;
}

lang::Scalar MaterialTable::cover(lang::ScalarMath& math, const lang::Scalar& value,
                                  const lang::Scalar& opacity, Covering covering) {
    using lang::ScalarOp;
    if (opacity.is_constant() && opacity.value == 1) {
        return value;
    }
    return covering == Covering::dims
               ? math.apply(ScalarOp::mul, value, opacity)
               : math.apply(ScalarOp::add, value, math.apply(ScalarOp::sub, lang::Scalar{1}, opacity));
}

/// Within 0 and 1, what a field's limits ask of a number.
lang::Scalar MaterialTable::opacity_in(Traced& source, const Opacity& opacity) {
    if (!opacity.function) {
        return {opacity.value};
    }
    const auto [found, is_new] = source.opacities.try_emplace(opacity.function.get());
    if (is_new) {
        // What is wrong with it is said where it is traced by itself.
        traced(opacity.function);
        lang::Diagnostics repeated;
        const lang::Components parts = lang::trace(opacity.function, source.builder, repeated);
        lang::ScalarMath math(&source.builder);
        found->second =
            math.apply(lang::ScalarOp::min, math.apply(lang::ScalarOp::max, parts.v[0], lang::Scalar{0}),
                       lang::Scalar{1});
    }
    return found->second;
}

std::int32_t MaterialTable::add_function(ir::Function function, const std::string& name,
                                         const Treatment& treatment) {
    const std::string& rendition = treatment.rendition->name();
    function.name = name + (rendition.empty() ? "" : ", " + rendition);
    scene_.functions.push_back(std::move(function));
    return static_cast<std::int32_t>(scene_.functions.size() - 1);
}

void MaterialTable::warn_of_idle_ior(const Thing& thing, const runtime::Phong<double>& phong) {
    const bool opaque =
        phong.transmit.function == runtime::no_function && phong.transmit.value == Rgb<double>{};
    if (thing.find("ior") != nullptr && opaque && phong.ior != 1) {
        diagnostics_.report(lang::Diag::idle_ior, place_of(thing, "ior"));
    }
}

void MaterialTable::check_bump(const Thing& thing, const runtime::Phong<double>& phong) {
    if (phong.bump == runtime::no_function) {
        if (thing.find("bump") != nullptr) {
            diagnostics_.report(lang::Diag::idle_bump, place_of(thing, "bump"));
        }
        return;
    }
    // Inputs have no place of their own.
    if (scene_.functions[static_cast<std::size_t>(phong.bump)].reads(ir::Input::n_x, ir::Input::n_z)) {
        diagnostics_.report(lang::Diag::bump_of_normal, place_of(thing, "bump"));
    }
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
