#pragma once

#include "runtime/host/values.h"
#include "runtime/image.h"
#include "runtime/render_request.h"

namespace scc::host {

/// What a program made by `scc build` is: the code compiled for a scene, and where the scene's numbers are.
struct Program {
    const char* precision;
    const char* isa;
    const char* const* features; ///< ends with a null pointer
    /// Takes the values that are not constants of the code. Called once, before `draw`.
    void (*load)(Values&);
    runtime::RenderResult (*draw)(const runtime::RenderRequest&, runtime::Image&);
    /// Null: the name and the settings come first among the values at the end of the program's file.
    const char* scene = nullptr;
    runtime::RenderSettings settings{};
    const unsigned char* values = nullptr; ///< with a name: those that `load` reads, or null for none
    std::size_t values_size = 0;
};

/// The program's main: reads the options, draws, writes. Returns the exit code.
int run_program(const Program& program, int argc, char** argv);

/// The instruction set that the translation unit which includes this was compiled for.
inline constexpr const char* compiled_isa =
#if defined(__AVX512F__)
    "avx512";
#elif defined(__AVX2__)
    "avx2";
#elif defined(__SSE2__)
    "sse2";
#else
    "portable";
#endif

} // namespace scc::host
