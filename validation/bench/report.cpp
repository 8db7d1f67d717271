#include "validation/bench/report.h"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <stdexcept>

namespace scc::bench {

namespace {

bool reaches(const Target& target, double figure, double mark) {
    return target.at_most ? figure <= mark : figure >= mark;
}

const char* verdict(const Row& row) {
    if (row.reached.values.empty()) {
        return "skipped";
    }
    if (!row.target) {
        return "";
    }
    const double figure = row.reached.median();
    if (reaches(*row.target, figure, row.target->goal)) {
        return "goal";
    }
    if (row.target->bar == 0) {
        return "below the goal";
    }
    return reaches(*row.target, figure, row.target->bar) ? "bar" : "missed";
}

std::string figure_text(const Row& row) {
    if (row.reached.values.empty()) {
        return row.skipped;
    }
    return fmt::format("{:.2f} ({:.2f}..{:.2f})", row.reached.median(), row.reached.min(), row.reached.max());
}

std::string mark_text(const Target& target, double mark) {
    if (mark == 0) {
        return "-";
    }
    return fmt::format("{}{:g}{}{}", target.at_most ? "<= " : "", mark, *target.unit == 'x' ? "" : " ",
                       target.unit);
}

std::string table_line(const Row& row) {
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", row.line, row.detail, row.threads,
                       row.target ? mark_text(*row.target, row.target->bar) : "",
                       row.target ? mark_text(*row.target, row.target->goal) : "", figure_text(row),
                       verdict(row));
}

constexpr const char* table_head =
    "| comparison | detail | threads | bar | goal | median (spread) | reached |\n"
    "| --- | --- | ---: | ---: | ---: | ---: | --- |\n";

/// Of the rows of one line and number of threads with a target and a figure the worst, for each in order.
std::vector<const Row*> worst_rows(const std::vector<Row>& rows) {
    std::vector<const Row*> result;
    for (const Row& row : rows) {
        if (!row.target) {
            continue;
        }
        const auto same = std::find_if(result.begin(), result.end(), [&](const Row* other) {
            return other->line == row.line && other->threads == row.threads;
        });
        if (same == result.end()) {
            result.push_back(&row);
            continue;
        }
        if (row.reached.values.empty() || (*same)->reached.values.empty()) {
            *same = row.reached.values.empty() ? &row : *same;
        } else if (!reaches(*row.target, row.reached.median(), (*same)->reached.median())) {
            *same = &row;
        }
    }
    return result;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path);
    file << text;
    if (!file.flush()) {
        throw std::runtime_error(fmt::format("cannot write `{}`", path.string()));
    }
}

} // namespace

void Report::add(Row row) {
    std::cout << table_line(row) << std::flush;
    rows_.push_back(std::move(row));
}

void Report::describe(const std::string& what, const std::string& value) {
    setting_.emplace_back(what, value);
}

void Report::write(const std::filesystem::path& folder) const {
    write_file(folder / "bench.json", json().dump(2) + "\n");
    write_file(folder / "bench.md", markdown());
}

nlohmann::json Report::json() const {
    nlohmann::json rows = nlohmann::json::array(), setting;
    for (const Row& row : rows_) {
        nlohmann::json one{
            {"line", row.line}, {"detail", row.detail}, {"threads", row.threads}, {"facts", row.facts}};
        if (row.target) {
            one["target"] = {{"bar", row.target->bar},
                             {"goal", row.target->goal},
                             {"at_most", row.target->at_most},
                             {"unit", row.target->unit}};
            one["verdict"] = verdict(row);
        }
        if (row.reached.values.empty()) {
            one["skipped"] = row.skipped;
        } else {
            one["reached"] = row.reached.json();
        }
        rows.push_back(std::move(one));
    }
    for (const auto& [what, value] : setting_) {
        setting[what] = value;
    }
    return {{"schema", 1}, {"setting", std::move(setting)}, {"rows", std::move(rows)}};
}

std::string Report::markdown() const {
    std::string text =
        "# Side by side\n\nRatios are theirs over ours, so more is better, except where a bar says "
        "`<=`. Each is the median of the ratios of\nneighbouring runs, with the smallest and the "
        "largest. A peer that is not installed is skipped and counts as nothing.\n\n";
    for (const auto& [what, value] : setting_) {
        text += fmt::format("- {}: {}\n", what, value);
    }
    text += fmt::format("\n## The worst of each comparison\n\n{}", table_head);
    for (const Row* row : worst_rows(rows_)) {
        text += table_line(*row);
    }
    text += fmt::format("\n## All figures\n\n{}", table_head);
    for (const Row& row : rows_) {
        text += table_line(row);
    }
    return text;
}

} // namespace scc::bench
