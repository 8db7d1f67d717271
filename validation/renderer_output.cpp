#include "validation/renderer_output.h"

#include <fmt/core.h>

#include <charconv>
#include <string_view>

namespace scc::validation {
namespace {

constexpr std::size_t povray_columns = 79; ///< a longer line is broken, if need be inside a word

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<double> number_at(std::string_view text, std::size_t position) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data() + position, text.data() + text.size(), value);
    return error == std::errc() ? std::optional(value) : std::nullopt;
}

/// "  Trace Time:       0 hours  0 minutes  0 seconds (0.002 seconds)"
void read_povray_time(std::string_view line, std::string_view name, std::optional<double>& time) {
    const std::size_t open = line.rfind('(');
    if (trimmed(line).starts_with(name) && open != std::string_view::npos)
        if (const std::optional<double> seconds = number_at(line, open + 1))
            time = time.value_or(0) + *seconds;
}

bool starts_povray_warning(std::string_view line) {
    return contains(line, "Warning:") || contains(line, "Possible Parse Error:");
}

bool starts_povray_error(std::string_view line) {
    return contains(line, " Error:") || line.starts_with("Fatal error") || line.starts_with("Problem with");
}

/// The message that begins at this line, with what was wrapped joined again.
std::string povray_message(const std::vector<std::string>& lines, std::size_t line) {
    std::string message = lines[line];
    for (; line + 1 < lines.size(); ++line) {
        const bool broken_in_a_word = lines[line].size() >= povray_columns;
        const std::string& next = lines[line + 1];
        const bool is_wrapped =
            next.size() > 1 && next[0] == ' ' && next[1] != ' '; // two begin a table's row
        if (!is_wrapped && !broken_in_a_word)
            break;
        message += next;
    }
    return message;
}

std::string joined(const std::vector<std::string>& lines, std::size_t from) {
    std::string text;
    for (std::size_t i = from; i < lines.size(); ++i)
        text += lines[i] + "\n";
    return text;
}

std::string word_after(std::string_view line, std::string_view mark) {
    const std::string_view rest = line.substr(line.find(mark) + mark.size());
    return std::string(rest.substr(0, rest.find(' ')));
}

/// "01:02.50", also with hours.
std::optional<double> clock_seconds(std::string_view text) {
    double seconds = 0;
    for (;;) {
        const std::optional<double> part = number_at(text, 0);
        if (!part)
            return std::nullopt;
        seconds = 60 * seconds + *part;
        const std::size_t colon = text.find(':');
        const std::size_t end = text.find_first_not_of("0123456789.");
        if (colon == std::string_view::npos || end != colon)
            return seconds;
        text.remove_prefix(colon + 1);
    }
}

/// " Time: 00:00.10 (Saving: 00:00.02)", once per rendered frame.
void read_blender_time(std::string_view line, BlenderOutput& output) {
    constexpr std::string_view time_mark = " Time: ";
    constexpr std::string_view saving_mark = "(Saving: ";
    const std::size_t saving_at = line.find(saving_mark);
    if (!line.starts_with(time_mark) || saving_at == std::string_view::npos)
        return;
    const std::optional<double> time = clock_seconds(line.substr(time_mark.size()));
    const std::optional<double> saving = clock_seconds(line.substr(saving_at + saving_mark.size()));
    if (!time || !saving)
        return;
    output.render = output.render.value_or(0) + *time - *saving;
    output.saving = output.saving.value_or(0) + *saving;
}

} // namespace

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::string line;
    bool overwrite = false;
    for (const char c : text) {
        if (c == '\n') {
            lines.push_back(line);
            line.clear();
            overwrite = false;
        } else if (c == '\r') {
            overwrite = true;
        } else {
            if (overwrite)
                line.clear();
            overwrite = false;
            line += c;
        }
    }
    if (!line.empty())
        lines.push_back(line);
    return lines;
}

PovrayOutput read_povray_output(const std::string& err) {
    PovrayOutput output;
    const std::vector<std::string> lines = lines_of(err);
    std::size_t banner_end = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string& line = lines[i];
        if (contains(line, "Ray Tracer Version "))
            output.version = "POV-Ray " + word_after(line, "Ray Tracer Version ");
        if (banner_end == 0 && line.starts_with("Parser Options"))
            banner_end = i;
        read_povray_time(line, "Parse Time:", output.parse);
        read_povray_time(line, "Bounding Time:", output.bounding);
        read_povray_time(line, "Trace Time:", output.trace);
        if (starts_povray_warning(line))
            output.warnings.push_back(povray_message(lines, i));
        else if (starts_povray_error(line))
            output.errors.push_back(povray_message(lines, i));
    }
    output.log = joined(lines, banner_end);
    return output;
}

BlenderOutput read_blender_output(const std::string& out, const std::string& err) {
    BlenderOutput output;
    std::string last;
    for (const std::string& line : lines_of(out)) {
        if (line.starts_with("Fra:"))
            continue;
        if (output.version.empty() && line.starts_with("Blender "))
            output.version = "Blender " + word_after(line, "Blender ");
        read_blender_time(line, output);
        if (line.starts_with("Error: script failed"))
            output.error = last;
        if (!trimmed(line).empty())
            last = trimmed(line);
        output.log += line + "\n";
    }
    if (!err.empty())
        output.log += err;
    return output;
}

} // namespace scc::validation
