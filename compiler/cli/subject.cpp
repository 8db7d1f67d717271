#include "compiler/cli/subject.h"

#include "compiler/backends/render.h"
#include "validation/renderers.h"

#include <fmt/core.h>

#include <chrono>

namespace scc::cli {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void draw_reference(Subject& subject) {
    const auto start = Clock::now();
    const compiler::ir::Scene& scene = subject.loaded.scene;
    subject.report.reference = draw_subject(subject, scene, compiler::Precision::full);
    subject.report.times.trace = seconds_since(start);
    subject.brightest = validation::brightest_value(subject.report.reference);
    const runtime::RenderSettings& s = subject.request.settings;
    subject.report.reference_made_by =
        fmt::format("scc render --precision double --size {}x{} --samples {}", s.width, s.height, s.samples);

    const validation::Metrics metrics = validation::compare(
        subject.report.reference, draw_subject(subject, scene, compiler::Precision::single));
    subject.report.description = fmt::format("{} x {}, {} samples per pixel. The same in float: max error "
                                             "{:.2g}, away from edges {:.2g}, {} pixels above 1e-3.",
                                             s.width, s.height, s.samples, metrics.all.max_error,
                                             metrics.away_from_edges.max_error, metrics.all.above(1e-3));
}

} // namespace

runtime::Image draw_subject(const Subject& subject, const compiler::ir::Scene& scene,
                            compiler::Precision precision) {
    const runtime::RenderRequest& r = subject.request;
    runtime::Image image(r.settings.width, r.settings.height);
    const runtime::RenderRequest limited = with_deadline(r, subject.timeout_seconds);
    if (!compiler::make_drawable(scene, precision).render(limited, image).complete) {
        throw RenderTimedOut(fmt::format("our own picture was not done after {} s", subject.timeout_seconds));
    }
    return image;
}

runtime::RenderRequest with_deadline(const runtime::RenderRequest& request, double seconds) {
    runtime::RenderRequest limited = request;
    limited.progress = [start = Clock::now(), seconds](double) { return seconds_since(start) < seconds; };
    return limited;
}

std::unique_ptr<Subject> load_subject(const ValidateOptions& options, const std::string& file) {
    auto subject = std::make_unique<Subject>();
    subject->options = options.scene;
    subject->options.file = file;
    subject->timeout_seconds = options.timeout_seconds;
    subject->layers = options.layers;
    subject->report.name = file;
    subject->loaded = load(subject->options, Stage::scene);
    if (!report(subject->loaded)) {
        subject->report.failure = "the scene is wrong";
        return subject;
    }
    subject->report.name = subject->loaded.scene.name;
    subject->request = make_request(options.render, subject->loaded.scene.settings);
    // Which all renderers can have.
    subject->request.settings = with_plain_grid(subject->request.settings);
    try {
        subject->budgets = validation::read_scene_budgets(read_text_file(file));
    } catch (const validation::BudgetError& error) {
        subject->report.failure = fmt::format("{}:{}: {}", file, error.line, error.what());
        fmt::print(stderr, "{}:{}: error: {}\n", file, error.line, error.what());
    }
    return subject;
}

std::unique_ptr<Subject> prepare_subject(const ValidateOptions& options, const std::string& file) {
    std::unique_ptr<Subject> subject = load_subject(options, file);
    try {
        if (subject->report.failure.empty()) {
            draw_reference(*subject);
        }
    } catch (const RenderTimedOut& error) {
        subject->report.failure = error.what();
        fmt::print(stderr, "scc: error: {}: {}\n", file, error.what());
    }
    return subject;
}

} // namespace scc::cli
