#pragma once

#include "lang/ast.h"

#include <optional>
#include <string_view>

/// The units of length, whose literals count in the `unit` of the file's world.
namespace scc::lang {

/// Of a unit's name: `mm cm m km inch`.
std::optional<ast::Unit> length_unit(std::string_view name);
std::string_view name_of(ast::Unit unit);

/// Rounded once where the factor is a power of ten, so that 25mm is the same number as 0.025.
double in_world_units(double value, ast::Unit unit, ast::Unit world);

} // namespace scc::lang
