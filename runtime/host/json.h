#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Values as JSON has them, for what must not need a library.
namespace scc::host {

std::string json(double number);
std::string json(std::uint64_t number);
std::string json(int number);
/// Control characters are written as \u00xx; the rest is UTF-8 as it is.
std::string json(std::string_view text);

} // namespace scc::host
