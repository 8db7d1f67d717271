#pragma once

#include "runtime/image.h"
#include "validation/bench/renderers.h"

#include <filesystem>
#include <string>
#include <vector>

/// POV-Ray's `isosurface` with a `max_gradient` that is guessed: where it is too low, the surface has holes.
namespace scc::bench {

/// The bound in an exported scene with one isosurface; throws std::runtime_error if there is none.
double max_gradient_of(const std::string& pov);

/// The same scene with another bound.
std::string with_max_gradient(const std::string& pov, double bound);

/// What POV-Ray draws of it, in linear light; empty, with the reason in `failure`, if it draws nothing.
runtime::Image picture_of(const std::filesystem::path& pov, const PictureJob& job, double brightest,
                          std::string& failure);

/// Pictures of one size in a row.
runtime::Image side_by_side(const std::vector<runtime::Image>& pictures);

} // namespace scc::bench
