#pragma once

#include "compiler/cli/subject.h"

namespace scc::cli {

/// Adds why the picture differs: what rays meet is compared first, where the renderer draws exported scenes;
/// the layers are drawn for it. Of a picture that passed only the layers, and those if they are asked for.
void diagnose(validation::RendererReport& result, const Subject& subject, int threads);

} // namespace scc::cli
