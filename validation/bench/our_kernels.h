#pragma once

#include "validation/bench/rays.h"

#include <memory>

/// The runtime's kernels for a mesh, as a built program has them.
namespace scc::bench {

enum class BuildQuality { sah, quick };

class OurMesh {
public:
    /// With `threads` threads.
    OurMesh(const TriangleMesh& mesh, BuildQuality quality, int threads);
    OurMesh(OurMesh&&) noexcept;
    ~OurMesh();

    /// All that tracing needs, vertices included.
    std::size_t bytes() const;

    /// Camera rays through the pixels' centres; hits in the order of packet_corner.
    void primary(const View& view, Hits& hits, int threads) const;
    /// Coherent rays: packet by packet they have one end in common and neighbouring other ends.
    void occluded(const Rays& rays, std::vector<std::uint8_t>& blocked, int threads) const;
    /// Incoherent rays.
    void closest(const Rays& rays, Hits& hits, int threads) const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

} // namespace scc::bench
