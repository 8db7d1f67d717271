#include "validation/bench/bench_mesh.h"
#include "validation/bench/embree_kernels.h"
#include "validation/bench/our_kernels.h"
#include "validation/bench/series.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <optional>

/// The runtime's triangle kernels against Embree's, in one process and alternating.
namespace {

using namespace scc::bench;
using nlohmann::json;

struct Options {
    std::filesystem::path meshes = SCC_MESH_DIR;
    std::vector<std::string> only;
    std::vector<std::string> rows{"primary", "shadow", "incoherent", "build"};
    std::vector<int> threads{1, 2};
    int repeat = 5;
    int side = 1024;
    std::string json_file;

    bool wants(const std::string& row) const {
        return std::find(rows.begin(), rows.end(), row) != rows.end();
    }
};

struct MeshCase {
    const char* name;
    const char* file;
    int subdivisions;
};
constexpr MeshCase mesh_cases[] = {{"teapot", "teapot.obj", 0},
                                   {"cow x4", "cow.obj", 1},
                                   {"bunny", "stanford-bunny.obj", 0},
                                   {"bunny x4", "stanford-bunny.obj", 1},
                                   {"teapot x256", "teapot.obj", 4}};

constexpr const char* ours = "ours";

/// Measurements by name; "ours" is among them.
using Measured = std::map<std::string, Series>;
struct Contender {
    std::string name;
    std::function<void()> run;
    std::function<void()> prepare = [] {}; ///< not timed
};
using Contenders = std::vector<Contender>;

Measured measure(const Contenders& contenders, int repeat, Clock clock) {
    Measured result;
    for (int i = 0; i <= repeat; ++i) {
        for (const Contender& contender : contenders) {
            contender.prepare();
            const double time = time_of(clock, contender.run);
            if (i > 0) { // the first time warms caches up
                result[contender.name].add(time);
            }
        }
    }
    return result;
}

/// Processor time where it is one thread's work; of two threads, the time that passes.
Clock clock_for(int threads) {
    return threads == 1 ? Clock::processor : Clock::wall;
}

struct Check {
    std::size_t rays = 0, hits = 0, hit_differs = 0, distance_differs = 0;

    json to_json() const {
        return {{"rays", rays},
                {"hits", hits},
                {"hit_differs", hit_differs},
                {"distance_differs", distance_differs}};
    }
};

Check compare(const Hits& a, const Hits& b, std::size_t rays) {
    constexpr float tolerance = 1e-4F;
    Check check{.rays = rays};
    for (std::size_t i = 0; i < a.t.size(); ++i) {
        check.hits += b.hit(i) ? 1U : 0U;
        if (a.hit(i) != b.hit(i)) {
            ++check.hit_differs;
        } else if (a.hit(i) && std::abs(a.t[i] - b.t[i]) > tolerance * (1 + std::abs(b.t[i]))) {
            ++check.distance_differs;
        }
    }
    return check;
}

Check compare(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, std::size_t rays) {
    Check check{.rays = rays};
    for (std::size_t i = 0; i < a.size(); ++i) {
        check.hits += b[i];
        check.hit_differs += a[i] != b[i] ? 1U : 0U;
    }
    return check;
}

class KernelBench {
public:
    explicit KernelBench(const Options& options) : options_(options) {}

    json run() {
        for (const MeshCase& mesh_case : mesh_cases) {
            const bool wanted = options_.only.empty() || std::find(options_.only.begin(), options_.only.end(),
                                                                   mesh_case.name) != options_.only.end();
            if (wanted) {
                run_mesh(mesh_case);
            }
        }
        return std::move(rows_);
    }

private:
    void run_mesh(const MeshCase& mesh_case) {
        mesh_name_ = mesh_case.name;
        mesh_ = load_mesh(options_.meshes / mesh_case.file);
        if (mesh_case.subdivisions > 0) {
            mesh_ = subdivide(std::move(mesh_), mesh_case.subdivisions);
        }
        fmt::print("{}, {} triangles\n", mesh_name_, mesh_.triangles());
        if (options_.wants("build")) {
            for (const int threads : options_.threads) {
                build(threads);
            }
        }
        if (!options_.wants("primary") && !options_.wants("shadow") && !options_.wants("incoherent")) {
            return;
        }
        const OurMesh our_mesh(mesh_, BuildQuality::sah, 1);
        EmbreeDevice device(1);
        const EmbreeMesh embree(device, mesh_, RTC_BUILD_QUALITY_MEDIUM);
        const View view = view_of(mesh_, options_.side);
        Hits hits(view.rays());
        embree.primary(view, hits, Width::sixteen, 1);
        const Rays to_light = shadow_rays(mesh_, view, hits), bounced = bounce_rays(mesh_, view, hits);
        for (const int threads : options_.threads) {
            if (options_.wants("primary")) {
                primary(our_mesh, embree, view, threads);
            }
            if (options_.wants("shadow")) {
                shadow(our_mesh, embree, to_light, threads);
            }
            if (options_.wants("incoherent")) {
                incoherent(our_mesh, embree, bounced, threads);
            }
        }
    }

    void primary(const OurMesh& our_mesh, const EmbreeMesh& embree, const View& view, int threads) {
        Hits our_hits(view.rays()), hits(view.rays()), hits_of_singles(view.rays());
        const Measured measured =
            measure({{ours, [&] { our_mesh.primary(view, our_hits, threads); }},
                     {"16", [&] { embree.primary(view, hits, Width::sixteen, threads); }},
                     {"1", [&] { embree.primary(view, hits_of_singles, Width::one, threads); }}},
                    options_.repeat, clock_for(threads));
        report_rays("primary", threads, measured, "16", compare(our_hits, hits, view.rays()));
    }

    void shadow(const OurMesh& our_mesh, const EmbreeMesh& embree, const Rays& rays, int threads) {
        std::vector<std::uint8_t> our_blocked(rays.size()), blocked(rays.size());
        const Measured measured = measure({{ours, [&] { our_mesh.occluded(rays, our_blocked, threads); }},
                                           {"16", [&] { embree.occluded(rays, blocked, threads); }}},
                                          options_.repeat, clock_for(threads));
        report_rays("shadow", threads, measured, "16", compare(our_blocked, blocked, rays.active()));
    }

    void incoherent(const OurMesh& our_mesh, const EmbreeMesh& embree, const Rays& rays, int threads) {
        Hits our_hits(rays.size()), hits(rays.size());
        Contenders contenders{{ours, [&] { our_mesh.closest(rays, our_hits, threads); }}};
        for (const Width width : {Width::one, Width::four, Width::eight, Width::sixteen, Width::stream}) {
            contenders.push_back(
                {name_of(width), [&, width] { embree.closest(rays, hits, width, threads); }});
        }
        const Measured measured = measure(contenders, options_.repeat, clock_for(threads));
        std::string best;
        for (const auto& [name, series] : measured) {
            if (name != ours && (best.empty() || series.median() < measured.at(best).median())) {
                best = name;
            }
        }
        report_rays("incoherent", threads, measured, best, compare(our_hits, hits, rays.active()));
    }

    void build(int threads) {
        EmbreeDevice device(threads);
        std::optional<OurMesh> sah, quick;
        std::optional<EmbreeMesh> medium, low;
        const Measured measured = measure(
            {{ours, [&] { sah.emplace(mesh_, BuildQuality::sah, threads); }, [&] { sah.reset(); }},
             {"medium", [&] { medium.emplace(device, mesh_, RTC_BUILD_QUALITY_MEDIUM); },
              [&] { medium.reset(); }},
             {"ours quick", [&] { quick.emplace(mesh_, BuildQuality::quick, threads); },
              [&] { quick.reset(); }},
             {"low", [&] { low.emplace(device, mesh_, RTC_BUILD_QUALITY_LOW); }, [&] { low.reset(); }}},
            options_.repeat, clock_for(threads));
        const auto per_triangle = [&](std::size_t bytes) {
            return static_cast<double>(bytes) / static_cast<double>(mesh_.triangles());
        };
        json bytes{{ours, per_triangle(sah->bytes())}, {"ours quick", per_triangle(quick->bytes())}};
        for (const auto& [name, peer] : {std::pair{"medium", &*medium}, {"low", &*low}}) {
            bytes[name] = {{"own", per_triangle(peer->bytes().own)},
                           {"own_peak", per_triangle(peer->bytes().peak)},
                           {"with_buffers", per_triangle(peer->bytes().own + peer->bytes().buffers)}};
        }
        json& row =
            report("build", threads, static_cast<double>(mesh_.triangles()), "Mtris/s", measured, "medium");
        row["quick_ratio"] = ratio(measured.at("low"), measured.at("ours quick")).json();
        fmt::print(
            "  {:<10}  bytes per triangle: ours {:.1f}, Embree medium {:.1f}, with its buffers {:.1f}\n", "",
            per_triangle(sah->bytes()), per_triangle(medium->bytes().own),
            per_triangle(medium->bytes().own + medium->bytes().buffers));
        row["bytes_per_triangle"] = std::move(bytes);
    }

    void report_rays(const std::string& name, int threads, const Measured& measured,
                     const std::string& against, const Check& check) {
        report(name, threads, static_cast<double>(check.rays), "Mrays/s", measured, against)["check"] =
            check.to_json();
        fmt::print("  {:<10}  of {} rays {} hit; differing: {} in whether, {} in where\n", "", check.rays,
                   check.hits, check.hit_differs, check.distance_differs);
    }

    json& report(const std::string& name, int threads, double count, const char* unit,
                 const Measured& measured, const std::string& against) {
        const Series faster = ratio(measured.at(against), measured.at(ours));
        fmt::print("  {:<10} {} thread{}  ratio {:.2f} ({:.2f}..{:.2f}) to {};", name, threads,
                   threads == 1 ? ", " : "s,", faster.median(), faster.min(), faster.max(), against);
        json rates, seconds;
        for (const auto& [contender, series] : measured) {
            rates[contender] = count * 1e-6 / series.median();
            seconds[contender] = series.json();
            fmt::print("  {} {:.1f}", contender, count * 1e-6 / series.median());
        }
        fmt::print(" {}\n", unit);
        std::fflush(stdout);
        rows_.push_back({{"row", name},
                         {"mesh", mesh_name_},
                         {"triangles", mesh_.triangles()},
                         {"threads", threads},
                         {"clock", clock_for(threads) == Clock::wall ? "wall" : "processor"},
                         {"unit", unit},
                         {"rates", std::move(rates)},
                         {"seconds", std::move(seconds)},
                         {"against", against},
                         {"ratio", faster.json()}});
        return rows_.back();
    }

    const Options& options_;
    std::string mesh_name_;
    TriangleMesh mesh_;
    json rows_ = json::array();
};

} // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app{"Times the runtime's triangle kernels against Embree's."};
    app.add_option("--meshes", options.meshes, "Folder of the OBJ files")->capture_default_str();
    app.add_option("--only", options.only, "Meshes, by name")->delimiter(',');
    app.add_option("--rows", options.rows, "Of primary, shadow, incoherent, build")
        ->delimiter(',')
        ->check(CLI::IsMember({"primary", "shadow", "incoherent", "build"}));
    app.add_option("--threads", options.threads, "Numbers of threads")->delimiter(',')->capture_default_str();
    app.add_option("--repeat", options.repeat, "Repetitions")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--side", options.side, "Of the square picture, a multiple of 32")->capture_default_str();
    app.add_option("--json", options.json_file, "Where to write the figures");
    CLI11_PARSE(app, argc, argv);
    try {
        const json result{{"embree", RTC_VERSION_STRING},
                          {"repeat", options.repeat},
                          {"side", options.side},
                          {"rows", KernelBench(options).run()}};
        if (!options.json_file.empty()) {
            std::ofstream(options.json_file) << result.dump(2) << '\n';
        }
    } catch (const std::exception& error) {
        std::cerr << "scc_kernel_bench: " << error.what() << '\n';
        return 3;
    }
    return 0;
}
