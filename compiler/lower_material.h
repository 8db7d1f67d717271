#pragma once

#include "compiler/function_builder.h"
#include "compiler/image_table.h"
#include "compiler/ir/scene.h"
#include "compiler/rendition.h"
#include "lang/check.h"
#include "lang/diagnostic.h"
#include "lang/rows.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace scc::compiler {

/// Gives every material value of a scene its place in the IR's table; a value used often is stored once.
class MaterialTable {
public:
    MaterialTable(ir::Scene& scene, const Rendition& rec709, ImageTable* images,
                  lang::Diagnostics& diagnostics)
        : scene_(scene), rec709_(rec709), images_(images), diagnostics_(diagnostics) {}

    /// `owner` names a material that has no name of its own. A null thing is the default material.
    runtime::Sides sides(const lang::Thing* material, const std::string& owner);
    /// Of rounds whose `material` has these scalars: one per round, or one for all. Rounds with the same
    /// numbers have the same material, named after the first of them by `owner(round)`.
    template <class Owner>
    std::vector<runtime::Sides> sides(const lang::ThingRows& rows, const lang::ThingPtr& material,
                                      const Owner& owner);

    /// A colour that is seen as it is.
    runtime::Rgb<double> shown(const lang::Value& color) const {
        return rec709_.rendered(color, ColorRole::light);
    }

    /// Whether some material has a spectrum.
    bool has_spectra() const { return has_spectra_; }
    /// Gives every material of the scene its colours in these too.
    void add_bands(const std::vector<Rendition>& bands);

private:
    /// A material's alpha: a number, or a function of the point.
    struct Opacity {
        double value = 1;
        lang::ClosurePtr function;
    };
    /// What it does to a field.
    enum class Covering { none, dims, leaves_open };
    /// How a field's value becomes three numbers, or one.
    struct Treatment {
        const Rendition* rendition;
        ColorRole role = ColorRole::surface;
        Covering covering = Covering::none;
        Opacity opacity{};
    };
    using Key = std::tuple<const Rendition*, ColorRole, Covering, double, const lang::Closure*>;
    /// A per-point function, and what became of it by the treatment of its results.
    struct Traced {
        explicit Traced(ImageTable* images) : builder(images) {}

        FunctionBuilder builder;
        lang::Components result;
        std::map<const lang::Closure*, lang::Scalar> opacities; ///< in the same builder
        std::map<Key, std::pair<std::int32_t, std::vector<double>>> lowered;
    };

    std::uint32_t index(const lang::Thing* material, const std::string& owner);
    std::string unique_name(const std::string& wanted);
    runtime::Phong<double> lowered(const lang::Thing& material, const std::string& owner,
                                   const Rendition& by);
    runtime::Phong<double> lowered_phong(const lang::Thing& phong, const std::string& owner,
                                         const Rendition& by);
    runtime::Phong<double> lowered_glass(const lang::Thing& glass, const std::string& owner,
                                         const Rendition& by);
    static Opacity opacity_of(const lang::Thing& phong);
    runtime::Varying<runtime::Rgb<double>> color(const lang::Thing& material, std::string_view field,
                                                 const std::string& owner, Treatment treatment);
    runtime::Varying<double> scalar(const lang::Thing& phong, std::string_view field,
                                    const std::string& owner);
    /// The function's index, or no_function with its constant values.
    std::pair<std::int32_t, std::vector<double>>
    function(const lang::ClosurePtr& closure, const std::string& name, const Treatment& treatment);
    /// Of a constant colour that an opacity makes vary.
    runtime::Varying<runtime::Rgb<double>> covered(const runtime::Rgb<double>& color, const std::string& name,
                                                   const Treatment& treatment);
    std::vector<lang::Scalar> treated(Traced& traced, const Treatment& treatment);
    static lang::Scalar cover(lang::ScalarMath& math, const lang::Scalar& value, const lang::Scalar& opacity,
                              Covering covering);
    lang::Scalar opacity_in(Traced& traced, const Opacity& opacity);
    std::int32_t add_function(ir::Function function, const std::string& name, const Treatment& treatment);
    Traced& traced(const lang::ClosurePtr& closure);
    std::int32_t bump(const lang::Thing& phong, const std::string& owner);
    void check_bump(const lang::Thing& thing, const runtime::Phong<double>& phong);
    void warn_of_idle_ior(const lang::Thing& thing, const runtime::Phong<double>& phong);
    void warn_if_bright(const lang::Thing& phong, std::string_view field,
                        const runtime::Varying<runtime::Rgb<double>>& value);

    ir::Scene& scene_;
    const Rendition& rec709_;
    ImageTable* images_;
    lang::Diagnostics& diagnostics_;
    bool has_spectra_ = false;
    std::map<const lang::Thing*, std::uint32_t> known_;
    std::vector<const lang::Thing*> things_; ///< by their index
    std::map<const lang::Closure*, Traced> functions_;
    std::set<std::string> names_;
    std::vector<lang::ThingPtr> made_; ///< known_ refers to them
};

/// Gives each different row of numbers an index, in the order in which they come.
class RowIndex {
public:
    explicit RowIndex(std::size_t width) : width_(width) {}

    std::size_t size() const { return count_; }
    std::uint32_t find_or_add(const std::uint64_t* row);

private:
    void grow();
    std::size_t slot_of(const std::uint64_t* row) const;

    std::size_t width_;
    std::size_t count_ = 0;
    std::vector<std::uint64_t> rows_;
    std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(64, empty);
    static constexpr std::uint32_t empty = ~0U;
};

template <class Owner>
std::vector<runtime::Sides> MaterialTable::sides(const lang::ThingRows& rows, const lang::ThingPtr& material,
                                                 const Owner& owner) {
    const std::vector<std::uint32_t> symbols =
        material ? lang::symbols_of(*material) : std::vector<std::uint32_t>{};
    if (symbols.empty()) {
        return {sides(material.get(), owner(0))};
    }
    std::vector<runtime::Sides> different;
    std::vector<runtime::Sides> result(rows.count);
    std::vector<std::uint64_t> key(symbols.size());
    std::vector<lang::Scalar> numbers(rows.columns->size());
    RowIndex known(symbols.size());
    for (std::size_t round = 0; round < rows.count; ++round) {
        for (std::size_t i = 0; i < symbols.size(); ++i) {
            key[i] = std::bit_cast<std::uint64_t>((*rows.columns)[symbols[i]][rows.begin + round]);
        }
        const std::uint32_t id = known.find_or_add(key.data());
        if (id == different.size()) {
            for (const std::uint32_t symbol : symbols) {
                numbers[symbol] = {(*rows.columns)[symbol][rows.begin + round]};
            }
            made_.push_back(lang::replaced(material, numbers));
            different.push_back(sides(made_.back().get(), owner(round)));
        }
        result[round] = different[id];
    }
    return result;
}

} // namespace scc::compiler
