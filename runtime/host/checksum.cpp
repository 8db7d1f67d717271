#include "runtime/host/checksum.h"

#include <array>
#include <cstddef>
#include <cstring>

namespace scc::host {

namespace {

constexpr std::uint64_t odd_a = 0x9e3779b97f4a7c15, odd_b = 0xd6e8feb86659fd93;

/// A bijection in both arguments.
std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * odd_a;
    return state ^ (state >> 32);
}

} // namespace

// Lanes that do not wait for each other; one multiplication per 8 bytes.
std::uint64_t checksum(std::string_view bytes, std::uint64_t seed) {
    constexpr std::size_t lanes = 8, block = lanes * sizeof(std::uint64_t);
    std::array<std::uint64_t, lanes> state{};
    for (std::size_t i = 0; i < lanes; ++i) {
        state[i] = seed + (i + 1) * odd_b;
    }
    const auto absorb = [&](const char* data) {
        std::array<std::uint64_t, lanes> words{};
        std::memcpy(words.data(), data, block);
        for (std::size_t i = 0; i < lanes; ++i) {
            state[i] = mix(state[i], words[i]);
        }
    };
    const std::size_t whole = bytes.size() / block * block;
    for (std::size_t at = 0; at < whole; at += block) {
        absorb(bytes.data() + at);
    }
    std::array<char, block> tail{};
    std::memcpy(tail.data(), bytes.data() + whole, bytes.size() - whole);
    absorb(tail.data());
    std::uint64_t result = mix(odd_b, bytes.size());
    for (const std::uint64_t lane : state) {
        result = mix(result, lane);
    }
    return mix(result, odd_b);
}

} // namespace scc::host
