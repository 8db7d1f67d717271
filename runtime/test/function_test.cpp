#include "runtime/function.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace scc::runtime;

namespace {

const SurfacePoint<double> point{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};

TEST(Function, ReadsEveryInput) {
    FunctionProgram<double> program;
    for (const Opcode code : {Opcode::p_x, Opcode::p_y, Opcode::p_z, Opcode::world_x, Opcode::world_y,
                              Opcode::world_z, Opcode::n_x, Opcode::n_y, Opcode::n_z}) {
        program.instructions.push_back({code});
    }
    const double* registers = run(program, point);
    for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(registers[i], i + 1);
    }
}

TEST(Function, OperandsAreEarlierRegistersInOrder) {
    const FunctionProgram<double> program{{{Opcode::p_z},
                                           {Opcode::constant, {}, 0.5},
                                           {Opcode::sub, {0, 1}},
                                           {Opcode::pow, {2, 0}},
                                           {Opcode::lt, {1, 0}},
                                           {Opcode::select, {4, 3, 1}}},
                                          {5}};
    const double* registers = run(program, point);
    EXPECT_EQ(registers[2], 2.5);
    EXPECT_EQ(registers[3], std::pow(2.5, 3.0));
    EXPECT_EQ(registers[4], 1);
    EXPECT_EQ(registers[5], registers[3]);
}

} // namespace
