#include "compiler/backends/render.h"
#include "compiler/beyond_double.h"
#include "compiler/bounds.h"
#include "compiler/cli/commands.h"
#include "compiler/cli/comparison.h"
#include "compiler/passes/passes.h"
#include "compiler/place_scene.h"
#include "lang/nearest.h"
#include "runtime/host/progress.h"
#include "validation/scratch.h"
#include "validation/stability/families.h"
#include "validation/stability/sweep.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <tuple>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;
using validation::Family;
using validation::Reading;
using validation::Reference;
using validation::Step;
using validation::Sweep;

struct Options {
    std::vector<std::string> subjects; ///< families and files
    SceneOptions scene;
    std::string against;
    std::string report;
    host::RenderOptions render; ///< size, samples, threads
    double timeout_seconds = 120;
    bool list = false;
    bool json = false;
};

/// Auto decides for a picture of this size: in smaller ones float saves nothing.
constexpr int usual_width = 320, usual_height = 320;

struct PlacedScene {
    ir::Scene scene;
    bool warned = false; ///< its author is told that numbers may not be enough
};

/// The scene at 10^power, with what is expected in its place if `formula`. Nothing, and the reason, where
/// there is none.
using SceneAt = std::function<std::optional<PlacedScene>(int power, bool formula, std::string& reason)>;

struct Plan {
    Sweep sweep;
    SceneAt scene_at;
    Reference reference = Reference::neutral;
    std::vector<std::string> against;
    int from = 0, to = 0;

    int steps() const { return std::abs(to - from) + 1; }
};

std::vector<std::string> split(std::string_view list) {
    std::vector<std::string> names;
    std::istringstream stream{std::string(list)};
    for (std::string name; std::getline(stream, name, ',');) {
        names.push_back(name);
    }
    return names;
}

// ---- what is swept -------------------------------------------------------------------------------------

std::string first_error(const lang::Diagnostics& diagnostics) {
    for (const lang::Diagnostic& one : diagnostics.sorted()) {
        if (one.severity == lang::Severity::error) {
            return one.message;
        }
    }
    return {};
}

/// What is told of numbers that double has too few digits for.
bool has_number_warning(const lang::Diagnostics& diagnostics) {
    using enum lang::Diag;
    const auto all = diagnostics.sorted();
    return std::any_of(all.begin(), all.end(), [](const lang::Diagnostic& one) {
        return one.kind == beyond_double || one.kind == coincident_faces || one.kind == depth_gap ||
               one.kind == depth_precision || one.kind == narrow_line;
    });
}

std::optional<PlacedScene> load_family(const Family& family, int power, bool formula, std::string& reason) {
    const std::string file = std::string(family.scene) + ".scn";
    const std::map<std::string, std::string> texts{{file, std::string(validation::scene_text(family.scene))}};
    SceneOptions options;
    options.file = file;
    options.texts = &texts;
    options.only_texts = true;
    options.definitions.push_back(fmt::format("value=1e{}", power));
    if (formula) {
        options.definitions.emplace_back("formula=true");
    }
    Loaded loaded = load(options, Stage::scene);
    if (loaded.diagnostics.has_errors()) {
        reason = first_error(loaded.diagnostics);
        return std::nullopt;
    }
    const bool warned = has_number_warning(loaded.diagnostics);
    return PlacedScene{std::move(loaded.scene), warned};
}

const char* words_for(Reference reference) {
    return reference == Reference::neutral ? "the sweep's first picture, in double"
                                           : "the same by another formula, in double";
}

Plan plan_of(const Family& family, const std::vector<std::string>& against) {
    Plan plan;
    plan.sweep.name = family.name;
    plan.sweep.title = family.title;
    plan.sweep.reference = words_for(family.reference);
    plan.sweep.holds_to = family.holds_to;
    plan.sweep.bound = family.bound;
    plan.reference = family.reference;
    plan.from = family.from;
    plan.to = family.to;
    plan.scene_at = [&family](int power, bool formula, std::string& reason) {
        return load_family(family, power, formula, reason);
    };
    const std::vector<std::string> able = split(family.against);
    std::copy_if(
        against.begin(), against.end(), std::back_inserter(plan.against),
        [&](const std::string& name) { return std::find(able.begin(), able.end(), name) != able.end(); });
    return plan;
}

/// What any scene is put through.
struct GenericSweep {
    const char* name;
    const char* title;
    int from, to;
    void (*place)(ir::Scene&, double value, double size);
};
constexpr GenericSweep generic_sweeps[] = {
    {"offset", "distance from the origin along each axis, in sizes of the scene", 0, 12,
     [](ir::Scene& scene, double value, double size) {
         const double far = value * size;
         compiler::place_scene(scene, 1, {far, far, -far});
     }},
    {"scale_down", "size, down", 0, -12,
     [](ir::Scene& scene, double value, double) { compiler::place_scene(scene, value, {}); }},
    {"scale_up", "size, up", 0, 12,
     [](ir::Scene& scene, double value, double) { compiler::place_scene(scene, value, {}); }},
};

/// A power of two, so that moving by multiples of it rounds no more than it must.
double size_of(const ir::Scene& scene) {
    const runtime::Bounds<double> box = compiler::world_bounds(scene);
    const double size = box.min.x <= box.max.x ? length(box.max - box.min) : length(scene.camera.eye);
    return size > 0 && std::isfinite(size) ? std::exp2(std::round(std::log2(size))) : 1;
}

/// Of a scene as it is before the passes.
std::vector<Plan> plans_of(const std::shared_ptr<const Loaded>& loaded,
                           const std::vector<std::string>& against) {
    std::vector<Plan> plans;
    for (const GenericSweep& generic : generic_sweeps) {
        Plan& plan = plans.emplace_back();
        plan.sweep.name = loaded->scene.name + "/" + generic.name;
        plan.sweep.title = generic.title;
        plan.sweep.reference = "the scene as it is, in double";
        plan.against = against;
        plan.from = generic.from;
        plan.to = generic.to;
        plan.scene_at = [loaded, &generic](int power, bool, std::string&) {
            ir::Scene scene = loaded->scene;
            if (power != 0 || generic.from != 0) {
                generic.place(scene, std::pow(10.0, power), size_of(scene));
            }
            compiler::recenter(scene);
            compiler::run_passes(scene);
            const bool warned = compiler::beyond_double(scene).has_value();
            return std::optional(PlacedScene{std::move(scene), warned});
        };
    }
    return plans;
}

// ---- how it is drawn -----------------------------------------------------------------------------------

class Sweeping {
public:
    Sweeping(const Options& options, host::ProgressLine& progress, int steps)
        : options_(options), progress_(progress), steps_(steps) {}

    void run(Plan& plan) {
        plan.sweep.engines.insert(plan.sweep.engines.end(), plan.against.begin(), plan.against.end());
        std::optional<runtime::Image> expected;
        for (int i = 0; i < plan.steps(); ++i) {
            const int power = plan.from + (plan.to > plan.from ? i : -i);
            if (!expected || plan.reference == Reference::formula) {
                std::string reason;
                const auto scene = plan.scene_at(power, plan.reference == Reference::formula, reason);
                expected =
                    scene ? std::optional(draw(scene->scene, compiler::Precision::full)) : std::nullopt;
            }
            plan.sweep.steps.push_back(step(plan, power, expected));
            progress_.update(static_cast<double>(++done_) / steps_);
            if (host::InterruptGuard::interrupted()) {
                throw Interrupted{};
            }
        }
    }

private:
    runtime::RenderRequest request_of(const ir::Scene& scene) const {
        runtime::RenderRequest request = make_request(options_.render, scene.settings);
        request.settings = with_plain_grid(request.settings);
        return request;
    }

    runtime::Image draw(const ir::Scene& scene, compiler::Precision precision) const {
        const runtime::RenderRequest request = request_of(scene);
        runtime::Image image(request.settings.width, request.settings.height);
        compiler::make_drawable(scene, precision).render(request, image);
        return image;
    }

    Step step(const Plan& plan, int power, const std::optional<runtime::Image>& expected) const {
        Step result;
        result.power = power;
        std::string reason = "there is nothing to compare with";
        const std::optional<PlacedScene> placed =
            expected ? plan.scene_at(power, false, reason) : std::nullopt;
        if (!placed) {
            Reading none;
            none.reason = reason;
            result.readings.assign(plan.sweep.engines.size(), none);
            return result;
        }
        const ir::Scene& scene = placed->scene;
        const Reading single = validation::read(*expected, draw(scene, compiler::Precision::single));
        const Reading full = validation::read(*expected, draw(scene, compiler::Precision::full));
        const compiler::PrecisionChoice choice = choose(scene);
        result.chosen = name_of(choice.precision);
        result.why = choice.reason;
        result.warned = placed->warned;
        result.readings = {single, full, choice.precision == compiler::Precision::single ? single : full};
        for (const std::string& name : plan.against) {
            result.readings.push_back(read_other(name, scene, *expected));
        }
        return result;
    }

    compiler::PrecisionChoice choose(const ir::Scene& scene) const {
        runtime::RenderSettings settings = request_of(scene).settings;
        settings.width = usual_width;
        settings.height = usual_height;
        return compiler::choose_precision_for_8_bits(scene, settings,
                                                     {.threads = host::thread_count(options_.render)});
    }

    Reading read_other(const std::string& name, const ir::Scene& scene,
                       const runtime::Image& expected) const {
        const validation::ScratchFolder folder;
        compiler::Ledger ledger;
        const runtime::RenderRequest request = request_of(scene);
        const ExportedRun how{.exporter = *compiler::find_exporter(name),
                              .folder = folder.path(),
                              .threads = request.threads,
                              .timeout_seconds = options_.timeout_seconds};
        const validation::RenderResult run =
            run_exported_scene(how, scene, request.settings, validation::brightest_value(expected), ledger);
        if (run.status == validation::RenderStatus::missing) {
            throw EnvironmentError(run.reason);
        }
        if (run.status != validation::RenderStatus::done) {
            Reading none;
            none.reason = run.reason;
            return none;
        }
        return validation::read(expected, run.image);
    }

    const Options& options_;
    host::ProgressLine& progress_;
    int steps_;
    int done_ = 0;
};

// ---- the command ---------------------------------------------------------------------------------------

bool is_file(const std::string& subject) {
    return subject.size() > 4 && subject.substr(subject.size() - 4) == ".scn";
}

std::vector<std::string> renderers_of(const std::string& list) {
    std::vector<std::string> names = split(list);
    for (const std::string& name : names) {
        if (compiler::find_exporter(name) == nullptr) {
            throw host::UsageError(
                fmt::format("`{}` is no renderer to compare with; there are pov and blender", name));
        }
    }
    return names;
}

const Family& family_of(const std::string& name) {
    if (const Family* family = validation::find_family(name)) {
        return *family;
    }
    std::vector<std::string_view> names;
    for (const Family& family : validation::families()) {
        names.push_back(family.name);
    }
    const auto near = lang::nearest(name, names);
    throw host::UsageError(fmt::format("there is no case `{}`{}; `scc stability --list` names them, and "
                                       "a scene's file ends in .scn",
                                       name, near ? fmt::format("; did you mean `{}`?", *near) : ""));
}

/// Nothing if a scene is wrong, or cannot be swept.
std::optional<std::vector<Plan>> plans_of(const Options& options) {
    const std::vector<std::string> against = renderers_of(options.against);
    std::vector<Plan> plans;
    if (options.subjects.empty()) {
        for (const Family& family : validation::families()) {
            plans.push_back(plan_of(family, against));
        }
    }
    for (const std::string& subject : options.subjects) {
        if (!is_file(subject)) {
            plans.push_back(plan_of(family_of(subject), against));
            continue;
        }
        SceneOptions scene = options.scene;
        scene.file = subject;
        const auto loaded = std::make_shared<Loaded>(load(scene, Stage::lowered));
        if (!report(*loaded)) {
            return std::nullopt;
        }
        if (const auto reason = compiler::tied_to_place(loaded->scene)) {
            fmt::print(stderr, "{}: error: the scene cannot be moved or scaled: {}\n", subject, *reason);
            return std::nullopt;
        }
        const std::vector<Plan> more = plans_of(loaded, against);
        plans.insert(plans.end(), more.begin(), more.end());
    }
    return plans;
}

int list() {
    for (const Family& family : validation::families()) {
        write_result("-", fmt::format("{:17} 1e{:<4} to 1e{:<4} {}; recorded 1e{}{}\n", family.name,
                                      family.from, family.to, family.title, family.holds_to,
                                      family.bound.empty() ? "" : ": " + std::string(family.bound)));
    }
    return host::exit_fine;
}

int stability(const Options& options) {
    if (options.list) {
        return list();
    }
    std::optional<std::vector<Plan>> plans = plans_of(options);
    if (!plans) {
        return host::exit_scene;
    }
    validation::StabilityReport all;
    all.versions.emplace_back("scc", SCC_VERSION);
    std::tie(all.width, all.height) = *options.render.size;
    int steps = 0;
    for (const Plan& plan : *plans) {
        steps += plan.steps();
    }
    {
        const host::InterruptGuard guard;
        host::ProgressLine progress("stability", host::ProgressMode::automatic);
        Sweeping sweeping(options, progress, steps);
        for (Plan& plan : *plans) {
            sweeping.run(plan);
            if (!options.json) {
                write_result("-", to_text(plan.sweep));
            }
            all.sweeps.push_back(std::move(plan.sweep));
        }
    }
    if (options.json) {
        write_result("-", to_json(all).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }
    if (!options.report.empty()) {
        write_report(all, options.report);
    }
    const bool worse = std::any_of(all.sweeps.begin(), all.sweeps.end(), validation::is_worse_than_recorded);
    return worse ? host::exit_scene : host::exit_fine;
}

} // namespace

void add_stability(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("stability", "how far pictures hold when scenes go to extremes, in float, in "
                                        "double and as `--precision auto` chooses");
    command->add_option("CASE|FILE", options->subjects,
                        "families of the suite, and scenes (.scn) that are moved away and scaled; all "
                        "families, if it is left out");
    add_scene_values(*command, options->scene);
    command
        ->add_option("--against", options->against,
                     "pov, blender, as our exports hand the scenes over; separated by commas")
        ->type_name("LIST");
    command->add_option("--report", options->report, "folder for report.json and index.html with plots")
        ->type_name("DIR");
    command->add_flag("--list", options->list, "names the families with their recorded thresholds");
    command->add_flag("--json", options->json, "prints report.json");
    options->render.size = {64, 64};
    options->render.samples = 1;
    add_render_options(*command, options->render, RenderOptionSet::picture);
    command
        ->add_option("--timeout", options->timeout_seconds,
                     "seconds that one renderer may take for a picture")
        ->capture_default_str();
    command->footer("\nA step is kept if no pixel away from edges is off by more than 1e-4, and at most 1 % "
                    "of all are. Exits with 1 if `auto` keeps less than a family's recorded threshold.");
    command->callback([&selected, options] { selected = [options] { return stability(*options); }; });
}

} // namespace scc::cli
