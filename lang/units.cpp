#include "lang/units.h"

#include <array>
#include <cstdint>
#include <numeric>

namespace scc::lang {
namespace {

struct Row {
    std::string_view name;
    ast::Unit unit;
    std::int64_t over, under; ///< in metres, as an exact fraction
};

constexpr std::array rows{
    Row{"mm", ast::Unit::mm, 1, 1000}, Row{"cm", ast::Unit::cm, 1, 100},        Row{"m", ast::Unit::m, 1, 1},
    Row{"km", ast::Unit::km, 1000, 1}, Row{"inch", ast::Unit::inch, 127, 5000},
};

const Row& row_of(ast::Unit unit) {
    for (const Row& row : rows) {
        if (row.unit == unit) {
            return row;
        }
    }
    return rows[2];
}

} // namespace

std::optional<ast::Unit> length_unit(std::string_view name) {
    for (const Row& row : rows) {
        if (row.name == name) {
            return row.unit;
        }
    }
    return std::nullopt;
}

std::string_view name_of(ast::Unit unit) {
    return row_of(unit).name;
}

double in_world_units(double value, ast::Unit unit, ast::Unit world) {
    const Row& from = row_of(unit);
    const Row& to = row_of(world);
    const std::int64_t over = from.over * to.under;
    const std::int64_t under = from.under * to.over;
    const std::int64_t common = std::gcd(over, under);
    return value * static_cast<double>(over / common) / static_cast<double>(under / common);
}

} // namespace scc::lang
