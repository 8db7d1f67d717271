#pragma once

#include "runtime/scene.h"

#include <cstdint>
#include <functional>

namespace scc::runtime {

/// Pixels [x0, x1) x [y0, y1), rows from the top.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct RenderRequest {
    RenderSettings settings;
    Crop crop;       ///< within the picture; the image has the crop's size
    int threads = 1; ///< at least 1
    /// Called from one thread at a time with the part that is done, 0..1, a few times a second at most.
    /// Returning false ends the render early; the image is then incomplete.
    std::function<bool(double)> progress;
};

struct RayCounts {
    std::uint64_t primary = 0;
    std::uint64_t shadow = 0;
    std::uint64_t reflected = 0;
    /// Searches for an implicit surface that remained open somewhere (see FieldCounts), and that ended at a
    /// jump.
    std::uint64_t undecided = 0;
    std::uint64_t at_jumps = 0;

    RayCounts& operator+=(const RayCounts& more) {
        primary += more.primary;
        shadow += more.shadow;
        reflected += more.reflected;
        undecided += more.undecided;
        at_jumps += more.at_jumps;
        return *this;
    }
};

struct RenderResult {
    RayCounts rays;
    bool complete = true;
};

} // namespace scc::runtime
