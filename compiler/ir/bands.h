#pragma once

#include "compiler/ir/scene.h"

#include <cstddef>

namespace scc::compiler::ir {

/// The scene in one of its bands: three wavelengths, drawn as if they were red, green and blue. It has no
/// bands.
Scene band_scene(const Scene& scene, std::size_t band);

} // namespace scc::compiler::ir
