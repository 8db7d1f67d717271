#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace scc::runtime::raster {

/// Copies past the caches what nobody reads soon: a picture is larger than they are, and a plain store first
/// fetches the line that it replaces. Others see it after `streams_end`.
inline void stream(const float* from, std::size_t count, float* to) {
#ifdef __SSE2__
    constexpr std::size_t at_once = 4; // longer vectors are no faster: memory is what takes the time
    while (count > 0 && reinterpret_cast<std::uintptr_t>(to) % (at_once * sizeof(float)) != 0) {
        *to++ = *from++;
        --count;
    }
    for (; count >= at_once; count -= at_once) {
        _mm_stream_ps(to, _mm_loadu_ps(from));
        from += at_once;
        to += at_once;
    }
#endif
    if (count > 0) {
        std::memcpy(to, from, count * sizeof(float));
    }
}
inline void streams_end() {
#ifdef __SSE2__
    _mm_sfence();
#endif
}

} // namespace scc::runtime::raster
