#pragma once

#include "compiler/backends/cpp.h"

#include <filesystem>
#include <string>

namespace scc::cli {

/// Compiles a generated program with the system's C++ compiler (the one in CXX, else c++, g++ or clang++) and
/// puts it under `output`, as a whole or not at all. Throws EnvironmentError where there is no compiler or it
/// fails.
void compile_native(const compiler::CppProgram& program, const std::filesystem::path& output);

} // namespace scc::cli
