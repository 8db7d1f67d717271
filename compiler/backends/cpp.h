#pragma once

#include "compiler/backends/precision.h"
#include "compiler/ir/scene.h"

#include <array>
#include <string>
#include <string_view>

namespace scc::compiler {

/// What every generated program includes, in its order and with its brackets.
inline constexpr auto program_headers =
    std::to_array<std::string_view>({"\"runtime/accel/build.h\"", "\"runtime/host/program.h\"",
                                     "\"runtime/render.h\"", "<array>", "<cstdint>", "<span>", "<vector>"});

/// Where a generated program has its scene's numbers.
enum class Numbers {
    in_code,   ///< small tables as constants, to be read and compiled by a person
    as_values, ///< all in CppProgram::values; the source depends on the scene's structure alone
    /// As values, and with tables of every kind and any length: code that leaves nothing out, to compare
    /// with.
    of_any_scene
};

/// What a program needs to draw its scene with other values of its `param`s (see compiler/redefine.h).
struct ProgramParameters {
    std::string scene;   ///< packed, see compiler/program_scene.h
    std::string listing; ///< for people, a line each
};

/// A program that draws one scene: data and one type over the runtime's headers.
struct CppProgram {
    std::string source;
    /// As host::ValuesWriter gives them. With Numbers::in_code the large tables and meshes, which the source
    /// takes in by `.incbin`, or nothing.
    std::string values;
    std::string structure; ///< with parameters: stands for the source
    bool takes_definitions() const { return !structure.empty(); }
};

/// `values_name`: the name under which the values will lie beside the source. Its letters, digits, `_`, `-`
/// and `.` only. `parameters`: null for a program that draws the scene as it is; needs Numbers::as_values.
/// `draws_aovs`: the program takes `--aov`.
CppProgram emit_cpp(const ir::Scene& scene, Precision precision, Numbers numbers,
                    const std::string& values_name = "", const ProgramParameters* parameters = nullptr,
                    bool draws_aovs = false);

} // namespace scc::compiler
