#pragma once

#include "runtime/aov.h"
#include "runtime/camera_rays.h"
#include "runtime/encounter.h"
#include "runtime/render_request.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <thread>
#include <vector>

namespace scc::runtime {

namespace detail {

template <class T, class V>
void store_at(std::vector<T>& list, std::size_t i, V value) {
    if (!list.empty()) {
        list[i] = static_cast<T>(value) + T(0); // as in a picture, no -0
    }
}

template <class S>
void store_aovs(const S& scene, const Ray<typename S::Real>& ray, AovImage& to, std::size_t i) {
    using R = typename S::Real;
    const Hit<R> hit = closest_hit<S, R>(scene, ray);
    const bool met = hit.kind != no_kind;
    Encounter<R> at{};
    if (met) {
        constexpr EncounterParts parts{.body = true, .point = false, .uv = true, .slopes = false};
        meet<parts>(scene, ray, hit, true, !to.uv[0].empty(), false, at);
    }
    store_at(to.depth, i, hit.shape.t * length(ray.dir));
    store_at(to.planar, i, hit.shape.t * -dot(ray.dir, scene.camera.n));
    const auto store_vector = [&](std::array<std::vector<float>, 3>& lists, const Vec3<R>& v,
                                  const std::array<double, 3>& origin) {
        store_at(lists[0], i, static_cast<double>(v.x) + origin[0]);
        store_at(lists[1], i, static_cast<double>(v.y) + origin[1]);
        store_at(lists[2], i, static_cast<double>(v.z) + origin[2]);
    };
    if (met) {
        store_vector(to.position, at.surface.point, to.origin);
    } else {
        store_vector(to.position, {}, {});
    }
    store_vector(to.normal, at.normal, {});
    store_at(to.uv[0], i, at.point.uv.x);
    store_at(to.uv[1], i, at.point.uv.y);
    store_at(to.object, i, met ? at.body + 1 : 0);
    store_at(to.material, i, met ? at.material + 1 : 0);
}

} // namespace detail

/// Fills in what `to`, which has the crop's size, has room for. One ray per pixel, through the middle of the
/// lens, each by itself: what a pack of them would give to the bit, with less code. Rows go to
/// `request.threads` threads; the calling one alone calls `request.progress`. False if that ended it early.
template <SceneModel S>
bool draw_aovs(const S& scene, const RenderRequest& request, AovImage& to) {
    using R = typename S::Real;
    const CameraRays<S> camera(scene, request.settings);
    std::atomic<int> next{0};
    std::atomic<bool> stopped{false};
    const auto draw_rows = [&](auto&& after_row) {
        for (int y = next++; y < to.height && !stopped; y = next++) {
            const R window_y = camera.window_y(static_cast<R>(request.crop.y0 + y), R(0.5));
            for (int x = 0; x < to.width; ++x) {
                const R window_x = camera.window_x(static_cast<R>(request.crop.x0 + x), R(0.5));
                const Ray<R> ray = camera.middle_ray(window_x, window_y);
                detail::store_aovs(scene, ray, to,
                                   static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) +
                                       static_cast<std::size_t>(x));
            }
            after_row(y);
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(request.threads, to.height); ++i) {
        others.emplace_back([&] { draw_rows([](int) {}); });
    }
    auto reported = std::chrono::steady_clock::now();
    draw_rows([&](int y) {
        const auto now = std::chrono::steady_clock::now();
        if (request.progress && now - reported >= std::chrono::milliseconds(250)) {
            reported = now;
            stopped = !request.progress(static_cast<double>(y) / to.height) || stopped;
        }
    });
    return !stopped;
}

} // namespace scc::runtime
