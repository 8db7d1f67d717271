#pragma once

#include "compiler/backends/cpp.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace scc::cli {

/// Whose instructions a program may use.
enum class Target {
    host,     ///< this machine's
    baseline, ///< any machine of this architecture's
};

struct NativeOptions {
    Target target = Target::host;
    bool use_cache = true; ///< the user's, for compiled code
};

/// Compiles a generated program (Numbers::as_values) with the system's C++ compiler (the one in CXX, else
/// c++, g++ or clang++) and puts it under `output`, as a whole or not at all. Code that was compiled before
/// is taken from the cache. Throws EnvironmentError where there is no compiler or it fails.
void compile_native(const compiler::CppProgram& program, const NativeOptions& options,
                    const std::filesystem::path& output);

} // namespace scc::cli
