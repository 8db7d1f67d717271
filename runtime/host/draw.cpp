#include "runtime/host/draw.h"

#include "runtime/host/file.h"
#include "runtime/host/image_file.h"
#include "runtime/host/progress.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <sys/resource.h>

namespace scc::host {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double peak_rss_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string statistics(const Drawable& drawable, const runtime::RenderRequest& request,
                       const runtime::RenderResult& result, double render_ms, double write_ms) {
    nlohmann::ordered_json times;
    double total = render_ms + write_ms;
    for (const char* stage : {"parse", "check", "lower", "passes", "accel"}) {
        times[stage] = 0.0;
    }
    for (const auto& [stage, ms] : drawable.times_ms) {
        times[stage] = ms;
        total += ms;
    }
    times["render"] = render_ms;
    times["write"] = write_ms;
    times["total"] = total;
    const runtime::RayCounts& rays = result.rays;
    const auto count = static_cast<double>(rays.primary + rays.shadow + rays.reflected);
    const nlohmann::ordered_json json{
        {"schema", 1},
        {"scene", drawable.scene},
        {"size", {request.settings.width, request.settings.height}},
        {"samples", request.settings.samples_per_axis * request.settings.samples_per_axis},
        {"threads", request.threads},
        {"precision", drawable.precision},
        {"isa", drawable.isa},
        {"times_ms", times},
        {"rays",
         {{"primary", rays.primary},
          {"shadow", rays.shadow},
          {"reflected", rays.reflected},
          {"refracted", 0}}},
        {"mrays_per_s", render_ms > 0 ? count / render_ms / 1000 : 0},
        {"peak_rss_mb", peak_rss_mb()},
        {"features", drawable.features}};
    return json.dump(2) + "\n";
}

} // namespace

int draw(const Drawable& drawable, const RenderOptions& options) {
    check_output(options);
    runtime::RenderRequest request = make_request(options, drawable.settings);
    runtime::Image image(request.crop.x1 - request.crop.x0, request.crop.y1 - request.crop.y0);

    runtime::RenderResult result;
    const auto render_start = Clock::now();
    {
        const InterruptGuard guard;
        ProgressLine line(fmt::format("render {}", drawable.scene), options.progress);
        request.progress = [&](double done) {
            line.update(done);
            return !InterruptGuard::interrupted();
        };
        result = drawable.render(request, image);
    }
    if (!result.complete) {
        fmt::print(stderr, "interrupted; no picture was written\n");
        return exit_interrupted;
    }
    const double render_ms = milliseconds_since(render_start);

    const auto write_start = Clock::now();
    write_image(options.output, image, {.bits = options.bits});
    const double write_ms = milliseconds_since(write_start);

    if (!options.stats.empty()) {
        const std::string text = statistics(drawable, request, result, render_ms, write_ms);
        if (options.stats == "-") {
            std::fwrite(text.data(), 1, text.size(), stdout);
        } else {
            replace_file(options.stats, text);
        }
    }
    return exit_fine;
}

} // namespace scc::host
