#include "runtime/host/draw.h"

#include "runtime/host/exr.h"
#include "runtime/host/file.h"
#include "runtime/host/image_file.h"
#include "runtime/host/json.h"
#include "runtime/host/layers.h"
#include "runtime/host/progress.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string_view>
#include <sys/resource.h>
#include <utility>

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

/// Joins members or entries that are JSON already: on lines of their own, or all on one for no `indent`.
std::string list(const char* brackets, const std::vector<std::string>& entries, std::size_t indent) {
    const auto line = [&](std::size_t depth) { return indent == 0 ? "" : "\n" + std::string(depth, ' '); };
    std::string text(1, brackets[0]);
    for (const std::string& entry : entries) {
        text += (text.size() > 1 ? "," : "") + line(indent) + entry;
    }
    return text + (indent == 0 ? "" : line(indent - 2)) + brackets[1];
}
template <class T>
std::string member(std::string_view name, const T& value) {
    return json(name) + ": " + json(value);
}

/// Pixels of colours that Rec.709 cannot show: some part is negative. Files of float keep them.
std::uint64_t out_of_gamut(const runtime::Image& image) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
        count += std::min({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}) < 0 ? 1 : 0;
    }
    return count;
}

struct Spent {
    double render_ms = 0;
    std::optional<double> aovs_ms;
    double write_ms = 0;
};

std::string statistics(const Drawable& drawable, const runtime::RenderRequest& request,
                       const runtime::RenderResult& result, const runtime::Image& image, const Spent& spent) {
    std::vector<std::string> times;
    double total = spent.render_ms + spent.write_ms;
    for (const std::string_view stage : {"parse", "check", "lower", "passes", "accel", "precision"}) {
        double stage_ms = 0;
        for (const auto& [name, ms] : drawable.times_ms) {
            stage_ms += name == stage ? ms : 0;
        }
        times.push_back(member(stage, stage_ms));
        total += stage_ms;
    }
    if (spent.aovs_ms) {
        times.push_back(member("aov", *spent.aovs_ms));
        total += *spent.aovs_ms;
    }
    times.push_back(member("render", spent.render_ms));
    times.push_back(member("write", spent.write_ms));
    times.push_back(member("total", total));
    const runtime::RayCounts& rays = result.rays;
    const auto count = static_cast<double>(rays.primary + rays.shadow + rays.reflected + rays.refracted);
    std::vector<std::string> features;
    for (const std::string& feature : drawable.features) {
        features.push_back(json(feature));
    }
    const runtime::RenderSettings& settings = request.settings;
    const std::vector<std::string> members{
        member("schema", 1),
        member("scene", std::string_view(drawable.scene)),
        "\"size\": " + list("[]", {json(settings.width), json(settings.height)}, 0),
        member("samples", settings.samples),
        member("threads", request.threads),
        member("precision", std::string_view(drawable.precision)),
        member("precision_reason", std::string_view(drawable.precision_reason)),
        member("isa", std::string_view(drawable.isa)),
        "\"times_ms\": " + list("{}", times, 4),
        "\"rays\": " + list("{}",
                            {member("primary", rays.primary), member("shadow", rays.shadow),
                             member("reflected", rays.reflected), member("refracted", rays.refracted),
                             member("undecided", rays.undecided), member("at_jumps", rays.at_jumps)},
                            4),
        member("out_of_gamut", out_of_gamut(image)),
        member("mrays_per_s", spent.render_ms > 0 ? count / spent.render_ms / 1000 : 0.0),
        member("peak_rss_mb", peak_rss_mb()),
        "\"features\": " + list("[]", features, 4)};
    return list("{}", members, 2) + "\n";
}

} // namespace

int draw(const Drawable& drawable, const RenderOptions& options) {
    check_output(options);
    runtime::RenderRequest request = make_request(options, drawable.settings);
    runtime::Image image(request.crop.x1 - request.crop.x0, request.crop.y1 - request.crop.y0);

    runtime::RenderResult result;
    runtime::AovImage aovs(image.width, image.height, options.aovs);
    aovs.origin = request.settings.origin;
    Spent spent;
    {
        const InterruptGuard guard;
        const auto draw_with_progress = [&](const char* what, auto&& draw_it) {
            ProgressLine line(what + drawable.scene, options.progress);
            request.progress = [&](double done) {
                line.update(done);
                return !InterruptGuard::interrupted();
            };
            const auto start = Clock::now();
            draw_it();
            return milliseconds_since(start);
        };
        spent.render_ms = draw_with_progress("render ", [&] { result = drawable.render(request, image); });
        if (options.aovs != 0 && result.complete) {
            spent.aovs_ms =
                draw_with_progress("AOVs of ", [&] { result.complete = drawable.draw_aovs(request, aovs); });
        }
    }
    if (!result.complete) {
        std::fputs("interrupted; no picture was written\n", stderr);
        return exit_interrupted;
    }

    const auto write_start = Clock::now();
    if (options.aovs != 0) {
        ExrContent content = exr_content(image);
        add_layers(aovs, drawable.names(), content);
        replace_file(options.output, encode_exr(std::move(content), false, request.threads));
    } else {
        write_image(options.output, image, {.bits = options.bits, .threads = request.threads});
    }
    spent.write_ms = milliseconds_since(write_start);

    if (!options.stats.empty()) {
        const std::string text = statistics(drawable, request, result, image, spent);
        if (options.stats == "-") {
            std::fwrite(text.data(), 1, text.size(), stdout);
        } else {
            replace_file(options.stats, text);
        }
    }
    return exit_fine;
}

} // namespace scc::host
