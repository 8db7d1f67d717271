#pragma once

#include <cstddef>
#include <filesystem>

/// Scenes of very many spheres, the same for us and for POV-Ray, for measuring how fast they are read.
namespace scc::bench {

struct SphereScene {
    std::filesystem::path scn, pov;
    double scn_bytes = 0, pov_bytes = 0;
};

/// One line per sphere.
SphereScene write_flat_spheres(std::size_t count, const std::filesystem::path& folder);
/// The same spheres by a loop, with a palette of five colours.
SphereScene write_loop_of_spheres(std::size_t count, const std::filesystem::path& folder);

} // namespace scc::bench
