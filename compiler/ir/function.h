#pragma once

#include "compiler/ir/image.h"
#include "lang/source.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Per-point functions as straight-line code over scalars; shared sub-expressions are stored once.
namespace scc::compiler::ir {

/// What a per-point function can read, all of them scalars of the hit: p in object space, world in world
/// space, n the unit geometric normal in world space, uv the coordinates on the surface.
enum class Input : std::uint8_t { p_x, p_y, p_z, world_x, world_y, world_z, n_x, n_y, n_z, uv_x, uv_y };
inline constexpr int input_count = 11;
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
    enum class Kind : std::uint8_t { constant, input, apply, image } kind = Kind::constant;
    Input input{};
    Op op{};
    std::uint8_t channel = 0;                ///< of an image: 0 red, 1 green, 2 blue
    std::array<std::uint32_t, 3> operands{}; ///< earlier nodes; of an image: u and v
    std::uint32_t image = 0;                 ///< index into the function's images
    double constant = 0;
};
/// How many operands a node has.
std::size_t arity(const Node& node);

struct Function {
    std::string name; ///< the author's, or made from the field it stands in
    std::vector<Node> nodes;
    std::vector<lang::Span> places;                     ///< where each node's operation was written
    std::vector<std::uint32_t> results;                 ///< 1 for a number, 3 for a colour
    std::vector<std::shared_ptr<const Image>> images{}; ///< each once
    bool reads(Input first, Input last) const;          ///< some node reads an input of this range
};

} // namespace scc::compiler::ir
