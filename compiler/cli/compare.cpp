#include "validation/compare.h"

#include "compiler/cli/commands.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"
#include "runtime/host/read_image.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <memory>
#include <optional>

namespace scc::cli {

namespace {

struct Options {
    std::string a, b;
    bool json = false;
    std::string difference;
    std::optional<double> max_error;
    std::optional<double> rmse;
};

std::string to_text(const validation::Metrics& m) {
    const auto& [color, place] = std::pair{m.worst_reference, m.all.worst};
    std::string text = fmt::format(
        "max error      {:.6g} at ({}, {}): ({:.6g}, {:.6g}, {:.6g}) and ({:.6g}, {:.6g}, {:.6g})\n",
        m.all.max_error, place.x, place.y, color[0], color[1], color[2], m.worst_other[0], m.worst_other[1],
        m.worst_other[2]);
    text += fmt::format("away from edges {:.6g} over {} of {} pixels\n", m.away_from_edges.max_error,
                        m.away_from_edges.pixels, m.all.pixels);
    text +=
        fmt::format("mean {:.6g}, rmse {:.6g}, psnr {:.4g} dB, ssim {:.6g}, dE2000 mean {:.3g} max {:.3g}\n",
                    m.all.mean, m.all.rmse, m.psnr, m.ssim, m.delta_e_mean, m.delta_e_max);
    text += fmt::format("percentiles    50 % {:.3g}, 90 % {:.3g}, 99 % {:.3g}, 99.9 % {:.3g}\n", m.all.p50,
                        m.all.p90, m.all.p99, m.all.p999);
    for (const auto& count : m.all.counts) {
        text += fmt::format("above {:<8g} {} pixels\n", count.threshold, count.pixels);
    }
    if (m.non_finite_reference + m.non_finite_other > 0) {
        text += fmt::format("not finite     {} and {} values\n", m.non_finite_reference, m.non_finite_other);
    }
    return text;
}

int compare(const Options& options) {
    const runtime::Image a = host::read_image(options.a);
    const runtime::Image b = host::read_image(options.b);
    validation::Metrics metrics;
    try {
        metrics = validation::compare(a, b);
    } catch (const validation::CompareError& error) {
        fmt::print(stderr, "scc: error: {}\n", error.what());
        return host::exit_scene;
    }
    write_result("-", options.json ? to_json(metrics).dump(2) + "\n" : to_text(metrics));
    if (!options.difference.empty()) {
        const double amplification = validation::suggest_amplification(metrics);
        host::write_image(options.difference, validation::difference_image(a, b, amplification));
        fmt::print(stderr, "{}: the difference times {:g}\n", options.difference, amplification);
    }
    const bool over = (options.max_error && !(metrics.all.max_error <= *options.max_error)) ||
                      (options.rmse && !(metrics.all.rmse <= *options.rmse));
    return over ? host::exit_scene : host::exit_fine;
}

} // namespace

void add_compare(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("compare", "measure how far two pictures are apart, in linear light");
    command->add_option("A", options->a, "the reference")->required();
    command->add_option("B", options->b, "the other picture")->required();
    command->add_flag("--json", options->json, "all metrics as JSON");
    command->add_option("--diff", options->difference, "write the amplified difference")->type_name("IMG");
    command->add_option("--max", options->max_error, "exit with 1 if the largest error is above this")
        ->type_name("E");
    command->add_option("--rmse", options->rmse, "exit with 1 if the root mean square error is above this")
        ->type_name("E");
    command->callback([&selected, options] { selected = [options] { return compare(*options); }; });
}

} // namespace scc::cli
