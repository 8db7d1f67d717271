#pragma once

#include "runtime/aov.h"
#include "runtime/host/values.h"
#include "runtime/image.h"
#include "runtime/render_request.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace scc::host {

/// Other values of a scene's `param`s, for a program that was made before.
struct Redefinition {
    std::string_view scene; ///< what the compiler packed for this
    std::string_view structure;
    std::string_view precision;
    std::vector<std::string> definitions; ///< NAME=VALUE
    std::vector<std::string> asset_paths;
    bool draws_aovs = false;
};

/// The scene is wrong with these values, which was said on standard error.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

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
    /// Null: the scene has no `param`. Else what makes the values for others of its values, in the form in
    /// which they are at the end of the program's file. There the scene, packed, and a list of the `param`s
    /// for people come after the settings. Throws UsageError, FileError, SceneError.
    std::string (*redefine)(const Redefinition&) = nullptr;
    const char* structure = nullptr; ///< what of the scene is in the code
    /// Null: the program draws no AOVs. Else the scene's names (see SceneNames) come before the values that
    /// `load` reads.
    bool (*draw_aovs)(const runtime::RenderRequest&, runtime::AovImage&) = nullptr;
    bool has_filters = false; ///< SceneTraits::pixel_sampling
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
