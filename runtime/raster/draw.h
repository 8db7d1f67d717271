#pragma once

#include "runtime/accel/build_bvh.h"
#include "runtime/aov.h"
#include "runtime/image.h"
#include "runtime/raster/make_model.h"
#include "runtime/raster/paint_tile.h"
#include "runtime/raster/setup.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace scc::runtime {

namespace raster {

/// The stages one after the other: triangles into bins, by runs of triangles; then tiles. Keeps its memory
/// from picture to picture.
template <SceneModel S, class L>
class RasterPainter {
    using R = typename S::Real;

public:
    RasterPainter(const S& scene, const RasterModel<R>& model)
        : scene_(scene), model_(model), lights_(scene, model) {}

    /// `paint(painter, tile)` finishes a tile that `painter` shows; the calling thread calls `progress`.
    template <class Paint>
    bool draw(const RenderRequest& request, const DrawChoice& choice, RasterShading shading, Paint&& paint) {
        const RasterView<R> view(scene_.camera, request.settings);
        const TileGrid tiles(request.crop, view.samples_across());
        fill_bins(request, choice, view, tiles);
        if (tiles.count() <= 0) {
            return true;
        }
        lights_.update(view, bins_, shading, request.threads);
        std::atomic<int> next{0}, done{0};
        std::atomic<bool> stopped{false};
        const auto work = [&](auto&& after_tile) {
            TilePainter<S, L> painter(scene_, model_, view, tiles, bins_, lights_, shading);
            for (int tile = next++; tile < tiles.count() && !stopped; tile = next++) {
                painter.show(tile);
                paint(painter, tile);
                ++done;
                after_tile();
            }
            painter.finish();
        };
        Progress progress(request);
        std::vector<std::jthread> others;
        for (int i = 1; i < std::min(request.threads, tiles.count()); ++i) {
            others.emplace_back([&] { work([] {}); });
        }
        try {
            work([&] {
                if (!progress.report(static_cast<double>(done) / tiles.count())) {
                    stopped = true;
                }
            });
        } catch (...) {
            stopped = true;
            throw;
        }
        others.clear();
        return done == tiles.count();
    }

private:
    /// Tells the caller a few times a second.
    class Progress {
    public:
        explicit Progress(const RenderRequest& request) : request_(request) {}
        bool report(double part) {
            const Clock::time_point now = Clock::now();
            if (!request_.progress || now - reported_ < std::chrono::milliseconds(250)) {
                return true;
            }
            reported_ = now;
            return request_.progress(part);
        }

    private:
        using Clock = std::chrono::steady_clock;
        const RenderRequest& request_;
        Clock::time_point reported_ = Clock::now();
    };

    /// A bin for each run of triangles, so that their order does not depend on the threads; the last one has
    /// the lines.
    void fill_bins(const RenderRequest& request, const DrawChoice& choice, const RasterView<R>& view,
                   const TileGrid& tiles) {
        const bool has_surfaces =
            !choice.lines || request.settings.raster.shading != RasterShading::wireframe;
        const std::uint32_t count = has_surfaces ? model_.triangle_count : 0;
        const auto runs = static_cast<std::uint32_t>(request.threads > 1 ? 4 * request.threads : 1);
        bins_.resize(runs + 1);
        const TriangleSetup<S, L> setup(scene_, model_, view, choice, tiles);
        runtime::detail::share_work(runs, request.threads, [&](std::size_t i) {
            bins_[i].clear(tiles);
            const auto at = [&](std::size_t run) {
                return static_cast<std::uint32_t>(std::uint64_t{count} * run / runs);
            };
            setup.run(at(i), at(i + 1), bins_[i]);
        });
        bins_[runs].clear(tiles);
        if constexpr (S::traits.lines) {
            if (choice.lines) {
                set_up_lines(model_, view, tiles, bins_[runs]);
            }
        }
    }

    const S& scene_;
    const RasterModel<R>& model_;
    std::vector<Bin<R>> bins_;
    VertexLights<S, L> lights_;
};

} // namespace raster

/// Draws the crop into the image, which has its size and 3 channels. The pixels depend on neither the crop
/// nor the number of threads nor the lanes that a pack L holds. The calling thread draws too, and it alone
/// calls `request.progress`. `pseudodepth`, if any, gets z* of L4 of the nearest opaque surface at each pixel
/// of the crop, or 1: at the pixel's centre, or with an even number of samples across right below it.
template <class L, SceneModel S>
RenderResult draw_raster(raster::RasterPainter<S, L>& painter, const RenderRequest& request, Image& image,
                         std::vector<typename S::Real>* pseudodepth = nullptr) {
    const RasterSettings& settings = request.settings.raster;
    const raster::DrawChoice choice{settings.cull, settings.shading == RasterShading::hidden_line};
    if (pseudodepth != nullptr) {
        pseudodepth->resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    }
    RenderResult result;
    result.complete = painter.draw(request, choice, settings.shading, [&](auto& tile_painter, int tile) {
        tile_painter.paint(tile, request.crop, image, pseudodepth);
    });
    const auto n = static_cast<std::uint64_t>(samples_per_axis(request.settings));
    result.rays.primary =
        n * n * static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
    return result;
}

template <class L, SceneModel S>
RenderResult draw_raster_with_lanes(const S& scene, const RasterModel<typename S::Real>& model,
                                    const RenderRequest& request, Image& image,
                                    std::vector<typename S::Real>* pseudodepth = nullptr) {
    raster::RasterPainter<S, L> painter(scene, model);
    return draw_raster(painter, request, image, pseudodepth);
}

template <SceneModel S>
RenderResult draw_raster(const S& scene, const RasterModel<typename S::Real>& model,
                         const RenderRequest& request, Image& image,
                         std::vector<typename S::Real>* pseudodepth = nullptr) {
    return draw_raster_with_lanes<WidestLane<typename S::Real>>(scene, model, request, image, pseudodepth);
}

/// As draw_aovs, of the triangles; surfaces that let light through count as others.
template <SceneModel S>
bool draw_raster_aovs(const S& scene, const RasterModel<typename S::Real>& model,
                      const RenderRequest& request, AovImage& to) {
    RenderRequest plain = request;
    plain.settings.samples = 1;
    raster::RasterPainter<S, WidestLane<typename S::Real>> painter(scene, model);
    return painter.draw(
        plain, {request.settings.raster.cull, false, true, false}, RasterShading::phong,
        [&](auto& tile_painter, int tile) { tile_painter.store_aovs(tile, request.crop, to); });
}

} // namespace scc::runtime
