#include "validation/render_cache.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <system_error>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kind = "render";
constexpr int schema = 1; ///< of an entry's head; another number is another key

struct TimeRow {
    const char* name;
    std::optional<double> RenderTimes::*time;
};
constexpr std::array time_rows{
    TimeRow{"start_up", &RenderTimes::start_up}, TimeRow{"parse", &RenderTimes::parse},
    TimeRow{"bounding", &RenderTimes::bounding}, TimeRow{"trace", &RenderTimes::trace},
    TimeRow{"saving", &RenderTimes::saving},     TimeRow{"total", &RenderTimes::total},
};

/// An entry: its head, JSON on one line, and the pixels as they are in memory.
std::string entry_of(const RenderResult& result) {
    Json head{
        {"width", result.image.width}, {"height", result.image.height}, {"channels", result.image.channels},
        {"version", result.version},   {"exposure", result.exposure},   {"warnings", result.warnings},
        {"log", result.log},           {"command", result.command}};
    for (const TimeRow& row : time_rows)
        if (const std::optional<double>& seconds = result.times.*row.time)
            head["times"][row.name] = *seconds;
    std::string text = head.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    text.append(reinterpret_cast<const char*>(result.image.pixels.data()),
                result.image.pixels.size() * sizeof(float));
    return text;
}

/// Throws Json::exception; nothing if the pixels are not all there.
std::optional<RenderResult> read_entry(std::string_view text) {
    const std::size_t head_end = text.find('\n');
    if (head_end == std::string_view::npos)
        return std::nullopt;
    const Json head = Json::parse(text.substr(0, head_end));
    const std::string_view pixels = text.substr(head_end + 1);
    RenderResult result;
    result.image = runtime::Image(head.at("width"), head.at("height"), head.at("channels"));
    if (pixels.size() != result.image.pixels.size() * sizeof(float))
        return std::nullopt;
    std::memcpy(result.image.pixels.data(), pixels.data(), pixels.size());
    result.version = head.at("version");
    result.exposure = head.at("exposure");
    result.warnings = head.at("warnings").get<std::vector<std::string>>();
    result.log = head.at("log");
    result.command = head.at("command");
    if (head.contains("times"))
        for (const TimeRow& row : time_rows)
            if (head["times"].contains(row.name))
                result.times.*row.time = head["times"][row.name].get<double>();
    result.status = RenderStatus::done;
    result.from_cache = true;
    return result;
}

} // namespace

RenderCache RenderCache::from_option(const std::string& text) {
    if (text == "off")
        return {};
    if (text.empty())
        return RenderCache(host::Cache::of_user());
    std::error_code error;
    fs::create_directories(text, error);
    if (error)
        throw host::FileError(fmt::format("cannot make the folder `{}`: {}", text, error.message()));
    return RenderCache(host::Cache::in_folder(text));
}

std::optional<RenderResult> RenderCache::find(const std::string& key) const {
    const std::optional<host::Cache::Entry> entry = cache_.find(kind, key);
    try {
        return entry ? read_entry(entry->content()) : std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt; // whole, but not of our making
    }
}

void RenderCache::store(const std::string& key, const RenderResult& result) const {
    if (cache_.keeps() && result.status == RenderStatus::done)
        cache_.store(kind, key, entry_of(result));
}

std::string render_key(const RenderJob& job, const Command& command, const std::string& version) {
    std::string key =
        host::cache_key({std::to_string(schema), find_program(command.program).value_or(""), version});
    for (const std::string& argument : command.arguments)
        key = host::cache_key({key, argument});
    key = host::cache_key({key, host::MappedFile(job.scene.string()).text()});
    for (const std::string& name : job.beside)
        key =
            host::cache_key({key, name, host::MappedFile((job.scene.parent_path() / name).string()).text()});
    return host::cache_key({key, std::to_string(job.samples_per_axis)});
}

} // namespace scc::validation
