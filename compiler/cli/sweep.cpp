#include "compiler/cli/sweep.h"

#include "compiler/backends/render.h"
#include "compiler/cli/comparison.h"
#include "compiler/cli/native.h"
#include "runtime/host/read_image.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;
using runtime::Image;
using runtime::RenderSettings;
using validation::RenderTimes;
using validation::SweepPoint;
using validation::SweepSeries;

constexpr std::array<int, 6> axes{1, 2, 4, 8, 16, 32}; ///< samples per axis of a sweep
constexpr int reference_axis = 64;
constexpr int tessellation_axis = 4; ///< by so much larger are the pictures in which edges are left out
constexpr std::array<double, 6> tessellations{0.002, 0.001, 0.0005, 0.00025, 0.000125, 0.0000625};
constexpr int default_samples = 256;
constexpr std::pair<int, int> default_size{96, 72};
/// Where lights and highlights are brighter in single samples than in their mean, POV-Ray's file must not cut
/// them off: the exposure follows a picture so many times larger.
constexpr int brightness_axis = 4;

struct Drawn {
    Image image;
    RenderTimes times;
    std::string failure; ///< empty if there is an image
};

/// The least times of a few runs: as many as take a second, at most three.
Drawn least_of_runs(const std::function<Drawn()>& draw) {
    constexpr double enough_seconds = 1;
    constexpr int most_runs = 3;
    Drawn best;
    double seconds = 0;
    for (int run = 0; run < most_runs && seconds < enough_seconds; ++run) {
        Drawn drawn = draw();
        if (!drawn.failure.empty()) {
            return drawn;
        }
        seconds += drawn.times.total.value_or(enough_seconds);
        if (run == 0 || drawn.times.total < best.times.total) {
            best = std::move(drawn);
        }
    }
    return best;
}

/// One scene's sweep.
class Sweep {
public:
    Sweep(const ValidateOptions& options, Subject& subject) : options_(options), subject_(subject) {
        RenderSettings& s = subject.request.settings;
        s.samples = reference_axis * reference_axis;
        threads_ = subject.request.threads;
    }

    validation::SweepScene run(const std::vector<std::string>& against) {
        validation::SweepScene result;
        const RenderSettings& s = subject_.request.settings;
        result.name = subject_.loaded.scene.name;
        reference_ = draw_subject(subject_, subject_.loaded.scene, compiler::Precision::full);
        brightest_ = brightest();
        result.reference_made_by =
            fmt::format("scc render --precision double --size {}x{} --samples {}, double "
                        "being our reference precision",
                        s.width, s.height, s.samples);
        confirm(result);
        for (const char* precision : {"float", "double"}) {
            result.series.push_back(over_samples(fmt::format("scc {}", precision),
                                                 [&](int n) { return draw_own(precision, n); }));
        }
        for (const std::string& renderer : against) {
            add_series(renderer, result.series);
        }
        result.tessellation = over_tessellations();
        return result;
    }

private:
    double brightest() const {
        runtime::RenderRequest request = subject_.request;
        request.settings.width *= brightness_axis;
        request.settings.height *= brightness_axis;
        request.settings.samples = 1;
        request.crop = {0, 0, request.settings.width, request.settings.height};
        Image image(request.settings.width, request.settings.height);
        compiler::make_drawable(subject_.loaded.scene, compiler::Precision::full).render(request, image);
        return std::max(validation::brightest_value(image), validation::brightest_value(reference_));
    }

    /// By POV-Ray with as many samples at the same places.
    void confirm(validation::SweepScene& result) {
        validation::RenderResult drawn = draw_exported("pov", reference_axis, std::nullopt,
                                                       options_.cache == "off" ? nullptr : &subject_.cache);
        if (drawn.status != validation::RenderStatus::done) {
            result.confirmation = "Not confirmed by another renderer: " + drawn.reason;
            return;
        }
        // Of so many rays a few end on the other side of an edge, each worth 1 / 4096: it is the mean that
        // tells.
        const RenderSettings& s = subject_.request.settings;
        const double rounding =
            validation::budget_for("pov", s.width, s.height, reference_axis, drawn.exposure)->max_error;
        const validation::Metrics metrics = validation::compare(reference_, drawn.image);
        result.confirmed = metrics.all.rmse <= rounding;
        result.confirmation =
            fmt::format("{} by POV-Ray with the same samples: RMSE {:.2g} ({:.2g} may be), largest "
                        "difference {:.2g}",
                        result.confirmed ? "Confirmed" : "Not confirmed", metrics.all.rmse, rounding,
                        metrics.all.max_error);
    }

    SweepPoint measured(std::string setting, double quality, const Drawn& drawn) const {
        const validation::Metrics metrics = validation::compare(reference_, drawn.image);
        return {std::move(setting), quality, metrics.all.rmse, metrics.all.max_error, drawn.times};
    }

    /// Adds a point, or why there is none; false in that case.
    bool add_point(SweepSeries& series, std::string setting, double quality,
                   const std::function<Drawn()>& draw) const {
        const Drawn drawn = least_of_runs(draw);
        if (!drawn.failure.empty()) {
            series.failure = setting + ": " + drawn.failure;
            return false;
        }
        series.points.push_back(measured(std::move(setting), quality, drawn));
        return true;
    }

    /// Shading per pixel, so that nothing but the triangles makes the difference; away from edges, where a
    /// sample more or less on a triangle is worth more than all that.
    SweepSeries over_tessellations() const {
        SweepSeries series{.renderer = "scc raster", .knob = "1 / tessellation"};
        if (const std::string reason = why_not_raster(subject_.loaded.scene); !reason.empty()) {
            series.failure = reason;
            return series;
        }
        ir::Scene scene = subject_.loaded.scene;
        runtime::RenderRequest request = subject_.request;
        request.settings.samples = 1;
        request.settings.width *= tessellation_axis;
        request.settings.height *= tessellation_axis;
        request.crop = {0, 0, request.settings.width, request.settings.height};
        request.settings.shadows = false;
        request.settings.depth = 0;
        const auto draw = [&] {
            scene.settings = request.settings;
            Drawn drawn{Image(request.settings.width, request.settings.height), {}, ""};
            const auto start = std::chrono::steady_clock::now();
            const host::Drawable drawable = compiler::make_drawable(scene, compiler::Precision::full);
            const auto made = std::chrono::steady_clock::now();
            drawable.render(request, drawn.image);
            const auto end = std::chrono::steady_clock::now();
            drawn.times.bounding = std::chrono::duration<double>(made - start).count();
            drawn.times.trace = std::chrono::duration<double>(end - made).count();
            return drawn;
        };
        const Image rays = draw().image;
        request.settings.method = runtime::Method::raster;
        request.settings.raster.shading = runtime::RasterShading::phong;
        request.settings.raster.clip = false; // rays have no far plane
        for (const double tessellation : tessellations) {
            request.settings.raster.tessellation = tessellation;
            const Drawn drawn = draw();
            const validation::Metrics metrics = validation::compare(rays, drawn.image);
            series.points.push_back({fmt::format("{}", tessellation), 1 / tessellation,
                                     metrics.away_from_edges.rmse, metrics.away_from_edges.max_error,
                                     drawn.times});
        }
        return series;
    }

    /// What raster mode draws otherwise than rays do, besides triangles; empty: nothing but shadows and
    /// mirrors.
    static std::string why_not_raster(const ir::Scene& scene) {
        const auto differs = [&](auto&& has) {
            return std::any_of(scene.materials.begin(), scene.materials.end(),
                               [&](const ir::Material& material) { return has(material.phong); });
        };
        if (scene.camera.projection == runtime::Projection::spherical || scene.camera.lens_radius > 0) {
            return "no raster picture: its camera does not project onto a plane";
        }
        if (differs([](const auto& phong) { return runtime::lets_through(phong); })) {
            return "no raster picture: transparent surfaces are blended there, and bend no rays";
        }
        if (differs([](const auto& phong) { return phong.bump != runtime::no_function; })) {
            return "no raster picture: there are no bumps in it";
        }
        return !scene.bands.empty() ? "no raster picture: it has spectra, which take as many pictures" : "";
    }

    SweepSeries over_samples(std::string name, const std::function<Drawn(int)>& draw) const {
        SweepSeries series{.renderer = std::move(name), .knob = "samples per pixel"};
        const int most = options_.render.samples.value_or(default_samples);
        for (const int n : axes) {
            if (n * n > most ||
                !add_point(series, fmt::format("{0} x {0}", n), n * n, [&] { return draw(n); })) {
                break;
            }
        }
        return series;
    }

    void add_series(const std::string& renderer, std::vector<SweepSeries>& all) {
        if (renderer == "native") {
            add_native(all);
        } else {
            all.push_back(over_samples(renderer, [&](int n) { return draw_other(renderer, n, {}); }));
        }
        if (renderer == "pov") {
            all.push_back(over_depths("pov +AM1", 1, {1, 2, 3, 4, 6, 9}));
            all.push_back(over_depths("pov +AM2", 2, {1, 2, 3, 4}));
        }
    }

    /// POV-Ray's own antialiasing, as its users ask for it.
    SweepSeries over_depths(std::string name, int method, const std::vector<int>& depths) {
        constexpr double threshold =
            0.03; // a tenth of the default, which leaves edges of low contrast as they are
        SweepSeries series{.renderer = std::move(name), .knob = "depth"};
        for (const int depth : depths) {
            const validation::PovrayAntialiasing how{method, depth, threshold};
            if (!add_point(series, fmt::format("+A{} +AM{} +R{}", threshold, method, depth), 0,
                           [&] { return draw_other("pov", 1, how); })) {
                break;
            }
        }
        return series;
    }

    validation::RenderResult draw_exported(const std::string& renderer, int n,
                                           const std::optional<validation::PovrayAntialiasing>& antialiasing,
                                           const validation::RenderCache* cache) const {
        RenderSettings settings = subject_.request.settings;
        settings.samples = n * n;
        const validation::ScratchFolder folder;
        compiler::Ledger ledger;
        const ExportedRun run{.exporter = *compiler::find_exporter(renderer),
                              .folder = folder.path(),
                              .threads = threads_,
                              .timeout_seconds = subject_.timeout_seconds,
                              .antialiasing = antialiasing,
                              .cache = cache};
        return run_exported_scene(run, subject_.loaded.scene, settings, brightest_, ledger);
    }

    Drawn draw_other(const std::string& renderer, int n,
                     const std::optional<validation::PovrayAntialiasing>& antialiasing) const {
        validation::RenderResult drawn = draw_exported(renderer, n, antialiasing, nullptr);
        return {std::move(drawn.image), drawn.times, std::move(drawn.reason)};
    }

    /// Runs a program of ours that writes `out.exr` and its statistics.
    Drawn draw_by(validation::Command command, int n) const {
        const RenderSettings& s = subject_.request.settings;
        const validation::ScratchFolder folder;
        const std::string picture = (folder.path() / "out.exr").string();
        command.timeout_seconds = options_.timeout_seconds;
        command.arguments.insert(command.arguments.end(),
                                 {"-o", picture, "--size", fmt::format("{}x{}", s.width, s.height),
                                  "--samples", std::to_string(n * n), "--threads", std::to_string(threads_),
                                  "--stats", "-", "--progress", "never"});
        const validation::ProcessResult run = validation::run(command);
        if (run.end == validation::ProcessEnd::interrupted) {
            throw Interrupted{};
        }
        if (!run.ok()) {
            return {{}, {}, validation::describe(run, command) + "\n" + run.err};
        }
        return {host::read_image(picture), times_of(run), ""};
    }

    static RenderTimes times_of(const validation::ProcessResult& run) {
        const auto json = nlohmann::json::parse(run.out.substr(run.out.find('{')));
        const auto seconds = [&](std::initializer_list<const char*> stages) {
            return std::accumulate(stages.begin(), stages.end(), 0.0, [&](double sum, const char* stage) {
                return sum + json["times_ms"].value(stage, 0.0) / 1000;
            });
        };
        RenderTimes times;
        times.parse = seconds({"parse", "check", "lower", "passes"});
        times.bounding = seconds({"accel"});
        times.trace = seconds({"render"});
        times.saving = seconds({"write"});
        times.total = run.wall_seconds;
        times.start_up =
            std::max(0.0, run.wall_seconds - *times.parse - *times.bounding - *times.trace - *times.saving);
        return times;
    }

    Drawn draw_own(const char* precision, int n) const {
        const SceneOptions& scene = subject_.options;
        validation::Command command;
        command.program = std::filesystem::read_symlink("/proc/self/exe").string();
        command.arguments = {"render", scene.file, "--precision", precision, "--mode", "ray"};
        const auto repeat = [&](const char* option, const std::vector<std::string>& values) {
            for (const std::string& value : values) {
                command.arguments.insert(command.arguments.end(), {option, value});
            }
        };
        repeat("-D", scene.definitions);
        repeat("--asset-path", scene.asset_paths);
        if (!scene.camera.empty()) {
            repeat("--camera", {scene.camera});
        }
        if (scene.frame) {
            repeat("--frame", {std::to_string(*scene.frame)});
        }
        return draw_by(command, n);
    }

    void add_native(std::vector<SweepSeries>& all) {
        const validation::ScratchFolder folder;
        const std::string program = (folder.path() / "native").string();
        ir::Scene scene = subject_.loaded.scene;
        scene.settings = subject_.request.settings;
        try {
            compile_native(emit_cpp(scene, compiler::Precision::full, compiler::Numbers::as_values), {},
                           program);
        } catch (const EnvironmentError& error) {
            all.push_back(
                {.renderer = "scc native double", .knob = "samples per pixel", .failure = error.what()});
            return;
        }
        all.push_back(over_samples("scc native double", [&](int n) {
            validation::Command command;
            command.program = program;
            return draw_by(command, n);
        }));
    }

    const ValidateOptions& options_;
    const Subject& subject_;
    int threads_ = 1;
    Image reference_;
    double brightest_ = 1;
};

} // namespace

std::vector<validation::SweepScene> sweep_scenes(const ValidateOptions& options,
                                                 const std::vector<std::string>& against, bool& complete) {
    std::vector<validation::SweepScene> scenes;
    ValidateOptions sized = options;
    sized.render.size = options.render.size.value_or(default_size);
    for (const std::string& file : options.files) {
        const std::unique_ptr<Subject> subject = load_subject(sized, file);
        complete = complete && subject->report.failure.empty();
        if (!subject->report.failure.empty()) {
            continue;
        }
        subject->cache = validation::RenderCache::from_option(options.cache);
        try {
            scenes.push_back(Sweep(sized, *subject).run(against));
        } catch (const RenderTimedOut& error) {
            fmt::print(stderr, "scc: error: {}: {}\n", file, error.what());
            complete = false;
        }
    }
    return scenes;
}

} // namespace scc::cli
