#pragma once

#include "runtime/image.h"
#include "runtime/render_request.h"

namespace scc::host {

/// What a program made by `scc build` is: its scene's name and settings, and the one function compiled for
/// it.
struct Program {
    const char* scene;
    const char* precision;
    const char* isa;
    const char* const* features; ///< ends with a null pointer
    runtime::RenderSettings settings;
    runtime::RenderResult (*render)(const runtime::RenderRequest&, runtime::Image&);
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
