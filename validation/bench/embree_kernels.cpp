#include "validation/bench/embree_kernels.h"

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace scc::bench {

namespace {

/// Embree's structures and calls by packet size.
template <int n>
struct Packet;
template <>
struct Packet<4> {
    using RayHit = RTCRayHit4;
    static constexpr auto intersect = rtcIntersect4;
};
template <>
struct Packet<8> {
    using RayHit = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
};
template <>
struct Packet<16> {
    using RayHit = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
};

RTCIntersectContext context_with(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

template <std::size_t n, class RayPacket>
void load(const Rays& rays, std::size_t first, RayPacket& to, std::array<int, n>& valid) {
    const auto copy = [first](const std::vector<float>& from, float* numbers) {
        std::memcpy(numbers, from.data() + first, n * sizeof(float));
    };
    copy(rays.org_x, to.org_x);
    copy(rays.org_y, to.org_y);
    copy(rays.org_z, to.org_z);
    copy(rays.dir_x, to.dir_x);
    copy(rays.dir_y, to.dir_y);
    copy(rays.dir_z, to.dir_z);
    copy(rays.t_min, to.tnear);
    copy(rays.t_max, to.tfar);
    for (std::size_t i = 0; i < n; ++i) {
        to.time[i] = 0;
        to.mask[i] = ~0U;
        to.flags[i] = 0;
        valid[i] = to.tnear[i] <= to.tfar[i] ? -1 : 0;
    }
}

RTCRayHit load_one(const Rays& rays, std::size_t i) {
    RTCRayHit result;
    result.ray = {rays.org_x[i],
                  rays.org_y[i],
                  rays.org_z[i],
                  rays.t_min[i],
                  rays.dir_x[i],
                  rays.dir_y[i],
                  rays.dir_z[i],
                  0,
                  rays.t_max[i],
                  ~0U,
                  0,
                  0};
    result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return result;
}

template <std::size_t n, class RayHit>
void store(const RayHit& from, Hits& hits, std::size_t first) {
    for (std::size_t i = 0; i < n; ++i) {
        hits.t[first + i] = from.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                                ? std::numeric_limits<float>::infinity()
                                : from.ray.tfar[i];
    }
    std::memcpy(hits.triangle.data() + first, from.hit.primID, n * sizeof(std::uint32_t));
}

void store_one(const RTCRayHit& from, Hits& hits, std::size_t i) {
    hits.t[i] =
        from.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : from.ray.tfar;
    hits.triangle[i] = from.hit.primID;
}

template <int n>
void closest_packets(RTCScene scene, const Rays& rays, Hits& hits, std::size_t first, std::size_t last) {
    RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    typename Packet<n>::RayHit query;
    alignas(64) std::array<int, n> valid;
    for (; first < last; first += n) {
        load(rays, first, query.ray, valid);
        std::fill_n(query.hit.geomID, n, RTC_INVALID_GEOMETRY_ID);
        Packet<n>::intersect(valid.data(), scene, &context, &query);
        store<n>(query, hits, first);
    }
}

/// A camera ray without the camera's terms: dir = corner + x right + y down for the pixel (x, y).
struct RaySource {
    using Vec = runtime::Vec3<float>;
    Vec org, corner, right, down;

    explicit RaySource(const View& view) {
        const auto at = [&](float x, float y) { return view.ray_through(x, y).dir; };
        const auto side = static_cast<float>(view.side);
        org = view.camera.eye;
        corner = at(0.5F, 0.5F);
        right = (at(side, 0) - at(0, 0)) / side;
        down = (at(0, side) - at(0, 0)) / side;
    }
};

} // namespace

std::string name_of(Width width) {
    switch (width) {
    case Width::one:
        return "1";
    case Width::four:
        return "4";
    case Width::eight:
        return "8";
    case Width::sixteen:
        return "16";
    case Width::stream:
        return "stream";
    }
    return {};
}

EmbreeDevice::EmbreeDevice(int threads)
    : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    if (device_ == nullptr) {
        throw std::runtime_error("Embree gives no device");
    }
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, this);
}

EmbreeDevice::~EmbreeDevice() {
    rtcReleaseDevice(device_);
}

bool EmbreeDevice::count_bytes(void* self, ssize_t bytes, bool) {
    auto& device = *static_cast<EmbreeDevice*>(self);
    const std::ptrdiff_t now = device.bytes_ += bytes;
    std::ptrdiff_t peak = device.peak_;
    while (now > peak && !device.peak_.compare_exchange_weak(peak, now)) {
    }
    return true;
}

EmbreeMesh::EmbreeMesh(EmbreeDevice& device, const TriangleMesh& mesh, RTCBuildQuality quality)
    : scene_(rtcNewScene(device.get())) {
    const std::ptrdiff_t before = device.bytes();
    device.take_peak();
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                               0, 3 * sizeof(float), mesh.positions.size() / 3);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(std::uint32_t), mesh.triangles());
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, quality);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) {
        throw std::runtime_error("Embree cannot build");
    }
    bytes_ = {static_cast<std::size_t>(device.bytes() - before),
              static_cast<std::size_t>(device.take_peak() - before),
              mesh.positions.size() * sizeof(float) + mesh.indices.size() * sizeof(std::uint32_t)};
}

EmbreeMesh::~EmbreeMesh() {
    rtcReleaseScene(scene_);
}

void EmbreeMesh::primary(const View& view, Hits& hits, Width width, int threads) const {
    const RaySource source(view);
    const auto direction = [&](float x, float y) {
        return source.corner + source.right * x + source.down * y;
    };
    const auto packets = [&](std::size_t first, std::size_t last) {
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
        RTCRayHit16 query;
        alignas(64) std::array<int, packet> valid;
        valid.fill(-1);
        for (; first < last; first += packet) {
            const Pixel corner = packet_corner(view.side, first);
            for (std::size_t i = 0; i < packet; ++i) {
                const auto dir = direction(static_cast<float>(corner.x + static_cast<int>(i) % packet_side),
                                           static_cast<float>(corner.y + static_cast<int>(i) / packet_side));
                query.ray.org_x[i] = source.org.x;
                query.ray.org_y[i] = source.org.y;
                query.ray.org_z[i] = source.org.z;
                query.ray.dir_x[i] = dir.x;
                query.ray.dir_y[i] = dir.y;
                query.ray.dir_z[i] = dir.z;
                query.ray.tnear[i] = 0;
                query.ray.tfar[i] = std::numeric_limits<float>::infinity();
                query.ray.time[i] = 0;
                query.ray.mask[i] = ~0U;
                query.ray.flags[i] = 0;
                query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            }
            rtcIntersect16(valid.data(), scene_, &context, &query);
            store<packet>(query, hits, first);
        }
    };
    const auto singles = [&](std::size_t first, std::size_t last) {
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
        for (; first < last; ++first) {
            const Pixel corner = packet_corner(view.side, first);
            const auto i = static_cast<int>(first % packet);
            const auto dir = direction(static_cast<float>(corner.x + i % packet_side),
                                       static_cast<float>(corner.y + i / packet_side));
            RTCRayHit query;
            query.ray = {source.org.x,
                         source.org.y,
                         source.org.z,
                         0,
                         dir.x,
                         dir.y,
                         dir.z,
                         0,
                         std::numeric_limits<float>::infinity(),
                         ~0U,
                         0,
                         0};
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &query);
            store_one(query, hits, first);
        }
    };
    if (width == Width::sixteen) {
        for_each_tile(view.rays(), threads, packets);
    } else {
        for_each_tile(view.rays(), threads, singles);
    }
}

void EmbreeMesh::occluded(const Rays& rays, std::vector<std::uint8_t>& blocked, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t first, std::size_t last) {
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
        RTCRay16 query;
        alignas(64) std::array<int, packet> valid;
        for (; first < last; first += packet) {
            load(rays, first, query, valid);
            rtcOccluded16(valid.data(), scene_, &context, &query);
            for (std::size_t i = 0; i < packet; ++i) {
                blocked[first + i] = valid[i] != 0 && query.tfar[i] < 0 ? 1 : 0;
            }
        }
    });
}

void EmbreeMesh::closest(const Rays& rays, Hits& hits, Width width, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t first, std::size_t last) {
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
        switch (width) {
        case Width::one:
            for (; first < last; ++first) {
                RTCRayHit query = load_one(rays, first);
                rtcIntersect1(scene_, &context, &query);
                store_one(query, hits, first);
            }
            break;
        case Width::four:
            closest_packets<4>(scene_, rays, hits, first, last);
            break;
        case Width::eight:
            closest_packets<8>(scene_, rays, hits, first, last);
            break;
        case Width::sixteen:
            closest_packets<16>(scene_, rays, hits, first, last);
            break;
        case Width::stream: {
            std::array<RTCRayHit, tile> queries;
            for (std::size_t i = first; i < last; ++i) {
                queries[i - first] = load_one(rays, i);
            }
            rtcIntersect1M(scene_, &context, queries.data(), static_cast<unsigned>(last - first),
                           sizeof(RTCRayHit));
            for (std::size_t i = first; i < last; ++i) {
                store_one(queries[i - first], hits, i);
            }
            break;
        }
        }
    });
}

} // namespace scc::bench
