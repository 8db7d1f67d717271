#pragma once

#include "runtime/math/dual.h"
#include "runtime/math/vec.h"
#include "runtime/texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::runtime {

/// What a per-point function can read. L is a lane type, or an interval or dual number over one.
template <class L>
struct SurfacePoint {
    Vec3<L> p; ///< in object space
    Vec3<L> world;
    Vec3<L> n;    ///< unit geometric normal in world space
    Vec2<L> uv{}; ///< where SceneTraits::uv
};

/// One step of a per-point function: a constant, an input, or a row of operators.def.
enum class Opcode : std::uint8_t {
    constant,
    p_x,
    p_y,
    p_z,
    world_x,
    world_y,
    world_z,
    n_x,
    n_y,
    n_z,
    uv_x,
    uv_y,
    image, ///< a channel of an image at (u, v)
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender) name,
#include "runtime/operators.def"
#undef SCC_OPERATOR
};

template <class R>
struct Instruction {
    Opcode code{};
    std::array<std::uint32_t, 3> operands{}; ///< earlier instructions; of an image: u, v, channel_of()
    R constant{};
};

/// The third operand of an image's instruction; see FunctionProgram::images.
constexpr std::uint32_t channel_of(std::uint32_t image, std::uint32_t channel) {
    return 3 * image + channel;
}

/// A per-point function for the interpreter: instruction i writes register i.
template <class R>
struct FunctionProgram {
    std::vector<Instruction<R>> instructions;
    std::vector<std::uint32_t> results; ///< 1 register for a number, 3 for a colour
    std::vector<ImageData> images{};    ///< whose texels live elsewhere
};

namespace detail {

template <class L, class R>
L execute(const Instruction<R>& instruction, const SurfacePoint<L>& point, const L* registers) {
    const L a = registers[instruction.operands[0]];
    const L b = registers[instruction.operands[1]];
    const L c = registers[instruction.operands[2]];
    switch (instruction.code) {
    case Opcode::constant:
        return L(instruction.constant);
    case Opcode::p_x:
        return point.p.x;
    case Opcode::p_y:
        return point.p.y;
    case Opcode::p_z:
        return point.p.z;
    case Opcode::world_x:
        return point.world.x;
    case Opcode::world_y:
        return point.world.y;
    case Opcode::world_z:
        return point.world.z;
    case Opcode::n_x:
        return point.n.x;
    case Opcode::n_y:
        return point.n.y;
    case Opcode::n_z:
        return point.n.z;
    case Opcode::uv_x:
        return point.uv.x;
    case Opcode::uv_y:
        return point.uv.y;
    case Opcode::image: // by look_up
        break;
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender)                                                  \
    case Opcode::name:                                                                                       \
        return L(value);
#include "runtime/operators.def"
#undef SCC_OPERATOR
    }
    return L(0);
}

template <class L, class R>
L look_up(const FunctionProgram<R>& program, const Instruction<R>& instruction, const L* registers) {
    const auto& [u, v, channel] = instruction.operands;
    return image_channel(program.images[channel / 3], channel % 3, registers[u], registers[v]);
}

} // namespace detail

/// The registers after running the program, of any type that SurfacePoint has; valid until the next call from
/// the same thread.
template <class L, class R>
const L* run(const FunctionProgram<R>& program, const SurfacePoint<L>& point) {
    thread_local std::vector<L> registers;
    const std::size_t size = program.instructions.size();
    if (registers.size() < size) {
        registers.resize(size);
    }
    for (std::size_t i = 0; i < size; ++i) {
        const Instruction<R>& instruction = program.instructions[i];
        registers[i] = instruction.code == Opcode::image
                           ? detail::look_up(program, instruction, registers.data())
                           : detail::execute(instruction, point, registers.data());
    }
    return registers.data();
}

} // namespace scc::runtime
