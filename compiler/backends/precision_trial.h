#pragma once

#include "runtime/host/draw.h"

#include <string>

namespace scc::compiler {

/// Whether a trial with a few thousand samples found float good enough for a file of 8 bits.
struct PrecisionTrial {
    bool passed = false;
    std::string reason; ///< a sentence for people
};

struct TrialOptions {
    bool coherent = false; ///< neighbouring rays cost much less than single ones, as in a mesh
    int threads = 1;
};

/// Compares what the renderers for float and for double draw of a picture with these settings. Float passes
/// where a sample is at most 1/32 step of the file off, or at most 1/4 from what double sees within 1/128
/// pixel around: then float drew what is seen a little beside, as at edges and in mirrors of mirrors, where
/// the choice of the sample's place itself decides more. At most 1 of 20 samples may need that excuse.
PrecisionTrial try_float(const decltype(host::Drawable::render)& single,
                         const decltype(host::Drawable::render)& full,
                         const runtime::RenderSettings& settings, const TrialOptions& options);

} // namespace scc::compiler
