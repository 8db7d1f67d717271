#pragma once

#include "lang/source.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Per-point functions as straight-line code over scalars; shared sub-expressions are stored once.
namespace scc::compiler::ir {

/// What a per-point function can read, all of them scalars of the hit: p in object space, world in world
/// space, n the unit geometric normal in world space.
enum class Input : std::uint8_t { p_x, p_y, p_z, world_x, world_y, world_z, n_x, n_y, n_z };
inline constexpr int input_count = 9;
std::string_view name(Input input);

/// Rows of runtime/operators.def.
enum class Op : std::uint8_t {
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender) name,
#include "runtime/operators.def"
#undef SCC_OPERATOR
};

struct OperatorRow {
    std::string_view name;
    int arity;
    std::string_view cpp, sdl, blender; ///< spellings; see runtime/operators.def
};
const OperatorRow& row(Op op);
std::optional<Op> find_operator(std::string_view name);

struct Node {
    enum class Kind : std::uint8_t { constant, input, apply } kind = Kind::constant;
    Input input{};
    Op op{};
    std::array<std::uint32_t, 3> operands{}; ///< earlier nodes
    double constant = 0;
};

struct Function {
    std::string name; ///< the author's, or made from the field it stands in
    std::vector<Node> nodes;
    std::vector<lang::Span> places;            ///< where each node's operation was written
    std::vector<std::uint32_t> results;        ///< 1 for a number, 3 for a colour
    bool reads(Input first, Input last) const; ///< some node reads an input of this range
};

} // namespace scc::compiler::ir
