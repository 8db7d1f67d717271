#pragma once

#include "compiler/ir/scene.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

#include <map>
#include <set>
#include <string>
#include <utility>

namespace scc::compiler {

/// Gives every material value of a scene its place in the IR's table; a value used often is stored once.
class MaterialTable {
public:
    MaterialTable(ir::Scene& scene, lang::Diagnostics& diagnostics)
        : scene_(scene), diagnostics_(diagnostics) {}

    /// `owner` names a material that has no name of its own. A null thing is the default material.
    runtime::Sides sides(const lang::Thing* material, const std::string& owner);

private:
    std::uint32_t index(const lang::Thing* phong, const std::string& owner);
    std::string unique_name(const std::string& wanted);
    runtime::Varying<runtime::Rgb<double>> color(const lang::Thing& phong, std::string_view field,
                                                 const std::string& owner);
    runtime::Varying<double> scalar(const lang::Thing& phong, std::string_view field,
                                    const std::string& owner);
    /// The function's index, or no_function with its constant values.
    std::pair<std::int32_t, std::vector<double>> function(const lang::ClosurePtr& closure,
                                                          const std::string& name);
    void warn_if_bright(const lang::Thing& phong, std::string_view field,
                        const runtime::Varying<runtime::Rgb<double>>& value);

    ir::Scene& scene_;
    lang::Diagnostics& diagnostics_;
    std::map<const lang::Thing*, std::uint32_t> known_;
    std::map<const lang::Closure*, std::pair<std::int32_t, std::vector<double>>> functions_;
    std::set<std::string> names_;
};

} // namespace scc::compiler
