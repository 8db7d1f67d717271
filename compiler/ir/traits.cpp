#include "compiler/ir/traits.h"

#include "runtime/shapes/list.h"

namespace scc::compiler::ir {

namespace {

template <class... All>
void add_shape_names(std::vector<std::string>& names, std::uint32_t bits, const char* suffix,
                     runtime::TypeList<All...>) {
    std::uint32_t bit = 1;
    const auto add = [&](std::string_view name) {
        if ((bits & bit) != 0) {
            names.push_back(std::string(name) + suffix);
        }
        bit <<= 1;
    };
    (add(All::name), ...);
}

} // namespace

std::vector<std::string> feature_names(const runtime::SceneTraits& traits) {
    std::vector<std::string> names;
    add_shape_names(names, traits.bare_shapes, "", runtime::Shapes<double>{});
    add_shape_names(names, traits.placed_shapes, " (transformed)", runtime::Shapes<double>{});
    add_shape_names(names, traits.bare_members, " (in a solid)", runtime::Primitives<double>{});
    add_shape_names(names, traits.placed_members, " (in a solid, transformed)",
                    runtime::Primitives<double>{});
    for (const TraitFlag& flag : trait_flags) {
        if (traits.*flag.member) {
            names.emplace_back(flag.name);
        }
    }
    return names;
}

} // namespace scc::compiler::ir
