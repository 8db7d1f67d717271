#pragma once

#include "validation/bench/rays.h"

#include <embree3/rtcore.h>
#include <string>

namespace scc::bench {

/// What one call of Embree takes.
enum class Width { one, four, eight, sixteen, stream };
std::string name_of(Width width);

struct EmbreeBytes {
    std::size_t own = 0;     ///< as Embree's memory monitor counts after the build
    std::size_t peak = 0;    ///< during the build
    std::size_t buffers = 0; ///< the vertices and indices, which Embree shares with the caller and keeps
};

/// Builds with so many threads, and counts the bytes.
class EmbreeDevice {
public:
    explicit EmbreeDevice(int threads);
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    ~EmbreeDevice();

    RTCDevice get() const { return device_; }
    std::ptrdiff_t bytes() const { return bytes_; }
    /// The most since the last call.
    std::ptrdiff_t take_peak() { return peak_.exchange(bytes_); }

private:
    static bool count_bytes(void* self, ssize_t bytes, bool after);

    RTCDevice device_;
    std::atomic<std::ptrdiff_t> bytes_{0}, peak_{0};
};

/// A triangle mesh in a scene of Embree's with default flags.
class EmbreeMesh {
public:
    EmbreeMesh(EmbreeDevice& device, const TriangleMesh& mesh, RTCBuildQuality quality);
    EmbreeMesh(const EmbreeMesh&) = delete;
    EmbreeMesh& operator=(const EmbreeMesh&) = delete;
    ~EmbreeMesh();

    EmbreeBytes bytes() const { return bytes_; }

    /// As in OurMesh. `width` is sixteen, told to be coherent, or one.
    void primary(const View& view, Hits& hits, Width width, int threads) const;
    void occluded(const Rays& rays, std::vector<std::uint8_t>& blocked, int threads) const;
    /// Told to be incoherent.
    void closest(const Rays& rays, Hits& hits, Width width, int threads) const;

private:
    RTCScene scene_;
    EmbreeBytes bytes_;
};

} // namespace scc::bench
