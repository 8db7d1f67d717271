#include "runtime/host/image_file.h"
#include "runtime/host/read_image.h"
#include "validation/bench/contest.h"
#include "validation/bench/frontend.h"
#include "validation/bench/holes.h"
#include "validation/bench/nff.h"
#include "validation/bench/own_scenes.h"
#include "validation/compare.h"
#include "validation/renderers.h"
#include "validation/subprocess.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <set>
#include <thread>

/// All comparisons with other renderers in one run.
namespace {

using namespace scc::bench;
namespace fs = std::filesystem;
namespace validation = scc::validation;
using nlohmann::json;

const std::vector<std::string> all_rows{"kernels",  "mirrors",  "spd",   "gains",
                                        "frontend", "implicit", "raster"};

struct Options {
    fs::path out = "bench";
    fs::path scc = SCC_BINARY_DIR "/scc";
    fs::path kernel_bench = SCC_BINARY_DIR "/scc_kernel_bench";
    fs::path raster_bench = SCC_BINARY_DIR "/scc_raster_bench";
    fs::path data = SCC_BENCH_DATA;
    fs::path examples = SCC_SOURCE_DIR "/examples";
    fs::path scenes = SCC_SOURCE_DIR "/validation/bench/scenes";
    std::vector<std::string> rows = all_rows;
    std::vector<int> threads{1, 2};
    int repeat = 5;

    bool wants(const std::string& row) const {
        return std::find(rows.begin(), rows.end(), row) != rows.end();
    }
};

/// The contestants of the comparisons between whole renderers.
constexpr const char* program_name = "built program";
constexpr const char* render_name = "scc render";
constexpr const char* povray_name = "POV-Ray";
constexpr const char* tachyon_name = "Tachyon";

struct Scene {
    fs::path scn, pov, tachyon, program;
    std::string missing;         ///< why it cannot be drawn at all
    std::string program_missing; ///< why there is no program
    std::string pov_missing;     ///< why there is no scene for POV-Ray
    double build_seconds = 0;
    int width = 0, height = 0;
};

class Bench {
public:
    explicit Bench(const Options& options) : options_(options), work_(fs::absolute(options.out) / "work") {
        fs::create_directories(work_);
    }

    void run() {
        describe_machine();
        if (options_.wants("kernels")) {
            kernels();
        }
        if (options_.wants("mirrors")) {
            mirrors();
        }
        if (options_.wants("spd")) {
            spd();
        }
        if (options_.wants("gains")) {
            gains();
        }
        if (options_.wants("frontend")) {
            frontend();
        }
        if (options_.wants("implicit")) {
            implicit();
        }
        if (options_.wants("raster")) {
            raster();
        }
        for (const std::string& version : versions_) {
            report_.describe("peer", version);
        }
        report_.write(options_.out);
    }

private:
    // --- setting ---

    void describe_machine() {
        std::ifstream file("/proc/cpuinfo");
        std::set<std::string> told;
        for (std::string line; std::getline(file, line);) {
            const std::string name = line.substr(0, line.find_first_of("\t:"));
            if ((name == "model name" || name == "flags") && told.insert(name).second) {
                report_.describe(name == "flags" ? "CPU flags" : "CPU", line.substr(line.find(':') + 2));
            }
        }
        report_.describe("CPUs", std::to_string(std::thread::hardware_concurrency()));
        report_.describe("compiler of scc", SCC_COMPILER);
        report_.describe("repetitions", std::to_string(options_.repeat));
    }

    /// Runs scc; what it said if it fails.
    std::string run_scc(std::vector<std::string> arguments, double* seconds = nullptr) {
        validation::Command command;
        command.program = fs::absolute(options_.scc).string();
        command.arguments = std::move(arguments);
        command.directory = work_;
        command.timeout_seconds = 900;
        const validation::ProcessResult process = validation::run(command);
        if (seconds != nullptr) {
            *seconds = process.wall_seconds;
        }
        return process.ok()
                   ? std::string()
                   : fmt::format("`scc {}`: {}", command.arguments.front(), failure_of(process, command));
    }

    /// How it ended and the first line of what it said.
    static std::string failure_of(const validation::ProcessResult& process,
                                  const validation::Command& command) {
        return describe(process, command) + ": " + process.err.substr(0, process.err.find('\n'));
    }

    /// Everything that drawing it needs besides the scene itself and Tachyon's.
    Scene prepare(const std::string& name, const fs::path& scn) {
        Scene scene;
        scene.scn = fs::absolute(scn);
        scene.pov = work_ / (name + ".pov");
        scene.program = work_ / name;
        scene.program_missing =
            run_scc({"build", scene.scn.string(), "-o", scene.program.string()}, &scene.build_seconds);
        scene.pov_missing =
            run_scc({"export", "pov", scene.scn.string(), "-o", scene.pov.string(), "--allow-drop"});
        return scene;
    }

    // --- runs ---

    std::map<std::string, Runs> draw_all(const Scene& scene, int threads) {
        PictureJob job{.folder = work_,
                       .threads = threads,
                       .width = scene.width,
                       .height = scene.height,
                       .image = scene.pov.stem().string() + ".png"};
        const auto unless = [](std::initializer_list<std::string> failures, std::function<Drawing()> draw) {
            const auto* failure = std::find_if(failures.begin(), failures.end(),
                                               [](const std::string& f) { return !f.empty(); });
            return failure == failures.end() ? std::move(draw) : [why = *failure] { return failed(why); };
        };
        const auto not_installed = [](const char* name, const char* program) {
            return validation::find_program(program) ? std::string()
                                                     : fmt::format("{} is not installed", name);
        };
        std::map<std::string, Runs> runs = alternate(
            {{program_name, unless({scene.missing, scene.program_missing},
                                   [&] { return draw_with_program(scene.program, job); })},
             {render_name, unless({scene.missing},
                                  [&] { return draw_with_scc(fs::absolute(options_.scc), scene.scn, job); })},
             {povray_name, unless({not_installed(povray_name, "povray"), scene.missing, scene.pov_missing},
                                  [&] { return draw_with_povray(scene.pov, job); })},
             {tachyon_name, unless({not_installed(tachyon_name, "tachyon"), scene.missing},
                                   [&] { return draw_with_tachyon(scene.tachyon, job); })}},
            options_.repeat);
        for (const auto& [name, one] : runs) {
            if (!one.version.empty()) {
                versions_.insert(one.version);
            }
        }
        return runs;
    }

    void add(Row row, std::string line, std::string detail, int threads, std::optional<Target> target = {}) {
        row.line = std::move(line);
        row.detail = detail.empty() || row.detail.empty() ? detail + row.detail : detail + ", " + row.detail;
        row.threads = threads;
        row.target = target;
        report_.add(std::move(row));
    }

    // --- the triangle kernels ---

    struct KernelLine {
        const char* row;
        const char* line;
        Target target;
    };
    static constexpr KernelLine kernel_lines[] = {
        {"primary", "primary rays, against Embree", {0.8, 1.2}},
        {"shadow", "shadow rays to a point light, against Embree", {0.8, 1.2}},
        {"incoherent", "incoherent rays, against the best of Embree", {0.8, 1.2}},
        {"build", "BVH build, against Embree medium", {1.0, 1.5}},
    };
    static constexpr const char* bytes_line = "bytes per triangle, all in";
    static constexpr Target bytes_target{80, 67, true, "B"};

    static Row skipped(const std::string& why) {
        Row row;
        row.skipped = why;
        return row;
    }

    void kernels() {
        json figures;
        const std::string failure = run_kernel_bench(figures);
        if (!failure.empty()) {
            for (const KernelLine& line : kernel_lines) {
                add(skipped(failure), line.line, "", 1, line.target);
            }
            add(skipped(failure), bytes_line, "", 1, bytes_target);
            return;
        }
        versions_.insert("Embree " + figures.at("embree").get<std::string>());
        for (const json& figure : figures.at("rows")) {
            const auto* line = std::find_if(std::begin(kernel_lines), std::end(kernel_lines),
                                            [&](const KernelLine& l) { return figure.at("row") == l.row; });
            Row row;
            row.skipped = disagreement(figure);
            if (row.skipped.empty()) {
                row.reached = series_of(figure.at("ratio"));
            }
            row.facts = figure;
            const int threads = figure.at("threads");
            const std::string mesh = fmt::format("{}, {} triangles", figure.at("mesh").get<std::string>(),
                                                 figure.at("triangles").get<std::size_t>());
            add(std::move(row), line->line,
                fmt::format("{}; against {}", mesh, figure.at("against").get<std::string>()), threads,
                line->target);
            if (figure.contains("bytes_per_triangle")) {
                Row bytes;
                bytes.reached.add(figure.at("bytes_per_triangle").at("ours"));
                bytes.facts = figure.at("bytes_per_triangle");
                add(std::move(bytes), bytes_line,
                    fmt::format(
                        "{}; Embree {:.0f}, with its buffers {:.0f}", mesh,
                        figure.at("bytes_per_triangle").at("medium").at("own").get<double>(),
                        figure.at("bytes_per_triangle").at("medium").at("with_buffers").get<double>()),
                    threads, bytes_target);
            }
        }
    }

    /// A few rays graze an edge; more of them mean that something else was measured than intended.
    static std::string disagreement(const json& figure) {
        if (!figure.contains("check")) {
            return {};
        }
        const json& check = figure.at("check");
        const double rays = check.at("rays");
        const double differing =
            check.at("hit_differs").get<double>() + check.at("distance_differs").get<double>();
        return differing * 5000 > rays ? fmt::format("{} of {} rays hit something else", differing, rays)
                                       : "";
    }

    /// Median, smallest and largest again as a series.
    static Series series_of(const json& summary) {
        return {{summary.at("min").get<double>(), summary.at("median").get<double>(),
                 summary.at("max").get<double>()}};
    }

    std::string run_kernel_bench(json& figures) {
        if (!fs::exists(options_.kernel_bench)) {
            return "scc_kernel_bench is missing: it is built where Embree is installed";
        }
        std::string threads;
        for (const int n : options_.threads) {
            threads += (threads.empty() ? "" : ",") + std::to_string(n);
        }
        const fs::path file = work_ / "kernels.json";
        validation::Command command;
        command.program = fs::absolute(options_.kernel_bench).string();
        command.arguments = {"--repeat", std::to_string(options_.repeat),   "--threads", threads,
                             "--meshes", (options_.data / "mesh").string(), "--json",    file.string()};
        const validation::ProcessResult process = validation::run(command);
        if (!process.ok()) {
            return failure_of(process, command);
        }
        std::ifstream stream(file);
        figures = json::parse(stream);
        return {};
    }

    // --- the raster pipeline ---

    static constexpr Target frame_target{3, 5}, fill_target{1, 1.5};

    void raster() {
        for (const int threads : options_.threads) {
            json figures;
            const std::string failure = run_raster_bench(threads, figures);
            if (!failure.empty()) {
                add(skipped(failure), "lit mesh by vertices, against llvmpipe", "", threads, frame_target);
                continue;
            }
            for (const json& figure : figures.at("rows")) {
                const std::size_t triangles = figure.at("triangles");
                const bool fills = triangles < 1000;
                Row row;
                row.reached = series_of(figure.at("ratio"));
                row.facts = figure;
                // Small meshes are for information.
                const std::optional<Target> target = fills                ? std::optional(fill_target)
                                                     : triangles >= 69000 ? std::optional(frame_target)
                                                                          : std::nullopt;
                add(std::move(row),
                    fills ? "layers that fill the picture, against llvmpipe"
                          : "lit mesh by vertices, against llvmpipe",
                    fmt::format("{}, {} triangles, 1920x1080", figure.at("mesh").get<std::string>(),
                                triangles),
                    threads, target);
                versions_.insert("OpenGL " + figure.at("version").get<std::string>());
            }
        }
    }

    std::string run_raster_bench(int threads, json& figures) {
        if (!fs::exists(options_.raster_bench)) {
            return "scc_raster_bench is missing: it is built where OSMesa is installed";
        }
        validation::Command command;
        command.program = fs::absolute(options_.raster_bench).string();
        command.arguments = {"--repeat",  std::to_string(options_.repeat),
                             "--threads", std::to_string(threads),
                             "--meshes",  (options_.data / "mesh").string()};
        const validation::ProcessResult process = validation::run(command);
        if (!process.ok()) {
            return failure_of(process, command);
        }
        figures = json::parse(process.out);
        return {};
    }

    // --- the small scene ---

    void mirrors() {
        Scene scene = prepare("mirror_spheres", options_.scenes / "mirror_spheres.scn");
        scene.tachyon = fs::absolute(options_.scenes / "mirror_spheres.dat");
        scene.width = 1280;
        scene.height = 720;
        for (const int threads : options_.threads) {
            const auto runs = draw_all(scene, threads);
            const std::string what = "plane and 8 mirror spheres, 1280x720";
            add(compare(runs, program_name, povray_name, &Runs::trace), what + ", built program, POV-Ray", "",
                threads, Target{30, 50});
            add(compare(runs, program_name, tachyon_name, &Runs::trace), what + ", built program, Tachyon",
                "", threads, Target{10, 16});
            add(compare(runs, render_name, povray_name, &Runs::trace), what + ", scc render, POV-Ray", "",
                threads, Target{15, 30});
            add(compare(runs, render_name, tachyon_name, &Runs::trace), what + ", scc render, Tachyon", "",
                threads);
            for (const char* ours : {render_name, program_name}) {
                add(compare(runs, ours, povray_name, &Runs::wall), "whole process to PNG, POV-Ray", ours,
                    threads, Target{10, 30});
            }
            samples(scene, threads);
        }
    }

    void samples(const Scene& scene, int threads) {
        PictureJob one{.folder = work_, .threads = threads, .arguments = {"--samples", "1"}};
        PictureJob nine = one;
        nine.arguments.back() = "9";
        const fs::path scc = fs::absolute(options_.scc);
        for (const bool compiled : {true, false}) {
            const auto draw = [&](const PictureJob& job) {
                if (compiled && !scene.program_missing.empty()) {
                    return failed(scene.program_missing);
                }
                return compiled ? draw_with_program(scene.program, job) : draw_with_scc(scc, scene.scn, job);
            };
            const auto runs = alternate({{"1", [&] { return draw(one); }}, {"9", [&] { return draw(nine); }}},
                                        options_.repeat);
            Row row = compare(runs, "1", "9", &Runs::trace);
            for (double& value : row.reached.values) {
                value /= 9;
            }
            add(std::move(row), "cost per sample, 3 x 3 samples over 1 x 1",
                compiled ? program_name : render_name, threads, Target{1.0, 0.75, true});
        }
    }

    // --- reading scenes ---

    void frontend() {
        for (const std::size_t count : {std::size_t{100'000}, std::size_t{1'000'000}}) {
            read_spheres("flat text", write_flat_spheres(count, work_), count, Target{10, 10});
            read_spheres("a loop", write_loop_of_spheres(count, work_), count, Target{40, 40});
        }
    }

    void read_spheres(const std::string& how, const SphereScene& scene, std::size_t count, Target target) {
        const PictureJob job{.folder = work_, .width = 16, .height = 16, .arguments = {"--size", "16x16"}};
        const bool has_povray = validation::find_program("povray").has_value();
        const auto runs = alternate(
            {{render_name,
              [&] { return draw_with_scc(fs::absolute(options_.scc), fs::absolute(scene.scn), job); }},
             {povray_name,
              [&] {
                  return has_povray ? draw_with_povray(fs::absolute(scene.pov), job)
                                    : failed("POV-Ray is not installed");
              }}},
            options_.repeat);
        Row row = compare(runs, render_name, povray_name, &Runs::parse);
        std::string figures;
        if (row.skipped.empty()) {
            const double ours = runs.at(render_name).parse.median();
            const double theirs = runs.at(povray_name).parse.median();
            const double memory =
                runs.at(render_name).stats.at("peak_rss_mb").get<double>() * 1e6 / static_cast<double>(count);
            const auto rates = [&](double bytes, double seconds) {
                const std::string text =
                    bytes > 1e6 ? fmt::format("{:.0f} MB/s, ", bytes / seconds * 1e-6) : "";
                return text + fmt::format("{:.2f} M objects/s", static_cast<double>(count) / seconds * 1e-6);
            };
            figures = fmt::format("; ours {}, theirs {}; at most {:.0f} bytes per sphere with the hierarchy",
                                  rates(scene.scn_bytes, ours), rates(scene.pov_bytes, theirs), memory);
        }
        add(std::move(row), fmt::format("reading spheres from {}, POV-Ray", how),
            fmt::format("{} spheres{}", count, figures), 1, target);
    }

    // --- implicit surfaces ---

    /// A thin wall, drawn by POV-Ray with the bound on the slope that the export derives, and with lower ones
    /// as somebody who tries for speed would guess them.
    void implicit() {
        const char* line = "isosurface with our derived bound, POV-Ray";
        Scene scene = prepare("thin_gyroid", options_.scenes / "thin_gyroid.scn");
        scene.width = 320;
        scene.height = 240;
        const std::string problem = !scene.program_missing.empty()        ? scene.program_missing
                                    : !scene.pov_missing.empty()          ? scene.pov_missing
                                    : !validation::find_program("povray") ? "POV-Ray is not installed"
                                                                          : "";
        if (!problem.empty()) {
            add(skipped(problem), line, "", options_.threads.front(), isosurface_target);
            return;
        }
        for (const int threads : options_.threads) {
            const PictureJob job{.folder = work_,
                                 .threads = threads,
                                 .width = scene.width,
                                 .height = scene.height,
                                 .arguments = {"--precision", "double"},
                                 .image = "thin_gyroid.exr"};
            draw_with_scc(fs::absolute(options_.scc), scene.scn, job);
            const scc::runtime::Image ours = scc::host::read_image((work_ / job.image).string());
            std::vector<scc::runtime::Image> pictures{ours};
            std::ifstream file(scene.pov);
            const std::string text{std::istreambuf_iterator<char>(file), {}};
            for (const double share : {1.0, 0.25, 0.125}) {
                const double bound = share * max_gradient_of(text);
                Scene other = scene;
                other.pov = work_ / fmt::format("thin_gyroid_{:.0f}.pov", 1000 * share);
                std::ofstream(other.pov) << with_max_gradient(text, bound);
                Row row = compare(draw_all(other, threads), program_name, povray_name, &Runs::trace);
                const scc::runtime::Image theirs =
                    picture_of(other.pov, job, validation::brightest_value(ours), row.skipped);
                if (row.skipped.empty()) {
                    pictures.push_back(theirs);
                    row.facts["difference"] = to_json(validation::compare(ours, theirs));
                    row.detail += fmt::format(
                        "; max_gradient {:.3g}, {} of {} pixels differ by more than 1e-3", bound,
                        validation::compare(ours, theirs).all.above(1e-3), ours.width * ours.height);
                }
                add(std::move(row), share == 1 ? line : "isosurface with a guessed bound, POV-Ray", "",
                    threads, share == 1 ? std::optional(isosurface_target) : std::nullopt);
            }
            scc::host::write_image((work_ / "thin_gyroid_all.png").string(), side_by_side(pictures));
        }
    }
    static constexpr Target isosurface_target{10, 30};

    // --- the Standard Procedural Databases and scenes like them ---

    void spd() {
        std::vector<std::pair<std::string, fs::path>> files;
        for (const char* name : {"balls4", "rings2", "tetra4", "teapot6"}) {
            files.emplace_back(name, fs::absolute(options_.data / "nff" / fmt::format("{}.nff", name)));
        }
        for (const auto& [name, scene] :
             {std::pair{"cones_and_spheres", cones_and_spheres()}, {"many_lights", many_lights()}}) {
            files.emplace_back(name, work_ / fmt::format("{}.nff", name));
            write_nff(scene, files.back().second);
        }
        std::vector<std::pair<std::string, Scene>> scenes;
        for (const auto& [name, file] : files) {
            scenes.emplace_back(name, prepare_nff(name, file));
        }
        for (const int threads : options_.threads) {
            std::map<std::string, std::vector<SpdResult>> results; // by our contestant
            for (const auto& [name, scene] : scenes) {
                const auto runs = draw_all(scene, threads);
                for (const char* ours : {program_name, render_name}) {
                    SpdResult& result = results[ours].emplace_back();
                    result.scene = name;
                    for (const char* peer : {povray_name, tachyon_name}) {
                        Row row = compare(runs, ours, peer, &Runs::trace);
                        row.facts["build_seconds"] = scene.build_seconds;
                        if (row.skipped.empty()) {
                            result.ratios.push_back(row.reached);
                        }
                        add(std::move(row), fmt::format("NFF scenes, {}", ours),
                            fmt::format("{}, {}", name, peer), threads);
                    }
                }
            }
            for (const char* ours : {program_name, render_name}) {
                summarise_spd(results.at(ours), ours, threads);
            }
        }
    }

    Scene prepare_nff(const std::string& name, const fs::path& file) {
        Scene scene;
        if (!fs::exists(file)) {
            scene.missing = fmt::format("`{}` is missing; see --data", file.filename().string());
            return scene;
        }
        const NffScene nff = read_nff(file);
        const fs::path scn = work_ / (name + ".scn");
        const std::string failure = run_scc({"import", "nff", file.string(), "-o", scn.string()});
        if (!failure.empty()) {
            scene.missing = failure;
            return scene;
        }
        scene = prepare(name, scn);
        scene.tachyon = work_ / (name + ".dat");
        scene.width = nff.width;
        scene.height = nff.height;
        write_tachyon(nff, bounces_of(scn), scene.tachyon);
        return scene;
    }

    /// The import says how many mirror bounces it draws; the language's default is 5.
    static int bounces_of(const fs::path& scn) {
        std::ifstream file(scn);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        constexpr std::string_view mark = "depth = ";
        const std::size_t at = text.find(mark);
        return at == std::string::npos ? 5 : std::stoi(text.substr(at + mark.size()));
    }

    struct SpdResult {
        std::string scene;
        std::vector<Series> ratios; ///< to the peers that drew it
    };

    /// Over what was measured, which the details count.
    void summarise_spd(const std::vector<SpdResult>& results, const char* ours, int threads) {
        Row mean, worst;
        mean.skipped = worst.skipped = "nothing was measured";
        std::string worst_scene;
        std::vector<double> logarithms(static_cast<std::size_t>(options_.repeat));
        std::size_t measured = 0, wanted = 0;
        for (const SpdResult& result : results) {
            wanted += 2;
            for (const Series& one : result.ratios) {
                ++measured;
                for (std::size_t i = 0; i < one.values.size(); ++i) {
                    logarithms[i] += std::log(one.values[i]);
                }
                if (worst_scene.empty() || one.median() < worst.reached.median()) {
                    worst_scene = result.scene;
                    worst.reached = one;
                }
            }
        }
        for (std::size_t i = 0; measured > 0 && i < logarithms.size(); ++i) {
            mean.reached.add(std::exp(logarithms[i] / static_cast<double>(measured)));
        }
        add(std::move(mean), fmt::format("NFF scenes, {}, geometric mean", ours),
            fmt::format("{} of {} comparisons with POV-Ray and Tachyon", measured, wanted), threads,
            Target{8, 12});
        add(std::move(worst), fmt::format("NFF scenes, {}, worst against the faster peer", ours), worst_scene,
            threads, Target{3, 5});
    }

    // --- generic against specialised ---

    void gains() {
        std::vector<fs::path> files{options_.scenes / "mirror_spheres.scn"};
        for (const fs::directory_entry& entry : fs::directory_iterator(options_.examples)) {
            if (entry.path().extension() == ".scn") {
                files.push_back(entry.path());
            }
        }
        std::sort(files.begin() + 1, files.end());
        for (const fs::path& file : files) {
            const Scene scene = prepare("gain_" + file.stem().string(), file);
            for (const int threads : options_.threads) {
                gain(file, scene, threads);
            }
        }
    }

    void gain(const fs::path& file, const Scene& scene, int threads) {
        Row row;
        row.skipped = scene.program_missing;
        std::string how;
        if (row.skipped.empty()) {
            const PictureJob generic{.folder = work_, .threads = threads, .image = "generic.pfm"};
            PictureJob compiled = generic;
            compiled.image = "compiled.pfm";
            const fs::path scc = fs::absolute(options_.scc);
            const auto runs =
                alternate({{program_name, [&] { return draw_with_program(scene.program, compiled); }},
                           {render_name, [&] { return draw_with_scc(scc, scene.scn, generic); }}},
                          options_.repeat);
            row = compare(runs, program_name, render_name, &Runs::trace);
            const bool same = same_files(work_ / generic.image, work_ / compiled.image);
            how = fmt::format(", built in {:.1f} s, {} bits", scene.build_seconds, same ? "same" : "other");
            row.facts["build_seconds"] = scene.build_seconds;
        }
        add(std::move(row), "generic over specialised", file.stem().string() + how, threads, Target{0, 1.5});
    }

    static bool same_files(const fs::path& a, const fs::path& b) {
        std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
        return std::equal(std::istreambuf_iterator<char>(one), {}, std::istreambuf_iterator<char>(other), {});
    }

    const Options& options_;
    fs::path work_;
    Report report_;
    std::set<std::string> versions_;
};

} // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app{"Compares scc with Embree, POV-Ray and Tachyon and writes bench.json and bench.md."};
    app.add_option("--out", options.out, "Folder for the tables; pictures and scenes go to its work/")
        ->capture_default_str();
    app.add_option("--rows", options.rows, fmt::format("Of {}", fmt::join(all_rows, ", ")))
        ->delimiter(',')
        ->check(CLI::IsMember(all_rows));
    app.add_option("--threads", options.threads, "Numbers of threads")->delimiter(',')->capture_default_str();
    app.add_option("--repeat", options.repeat, "Repetitions")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--scc", options.scc, "The compiler to measure")->capture_default_str();
    app.add_option("--kernel-bench", options.kernel_bench, "The kernels to measure")->capture_default_str();
    app.add_option("--raster-bench", options.raster_bench, "The raster pipeline to measure")
        ->capture_default_str();
    app.add_option("--data", options.data, "Folder with mesh/ and nff/")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        Bench(options).run();
    } catch (const std::exception& error) {
        std::cerr << "scc_bench: " << error.what() << '\n';
        return 3;
    }
    return 0;
}
