#pragma once

#include <cstdint>
#include <string_view>

namespace scc::host {

/// Finds accidental damage, at the speed of memory; also a key for content. Not against malice.
std::uint64_t checksum(std::string_view bytes, std::uint64_t seed = 0);

} // namespace scc::host
