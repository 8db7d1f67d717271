#include "lang/lsp/document.h"

#include "lang/parser.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

namespace scc::lang::lsp {
namespace {

constexpr std::string_view file_scheme = "file://";

std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned byte = 0;
        const char* digits = text.data() + i + 1;
        const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                               std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        result += is_escape ? static_cast<char>(byte) : text[i];
        i += is_escape ? 2 : 0;
    }
    return result;
}

bool stands_for_itself(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-._~/").find(c) != std::string_view::npos;
}

Json json_of(Place place) {
    return {{"line", place.line}, {"character", place.character}};
}

} // namespace

std::string path_of(std::string_view uri) {
    if (!uri.starts_with(file_scheme)) {
        const std::string name = percent_decoded(uri);
        return name.substr(name.find_last_of("/:\\") + 1);
    }
    uri.remove_prefix(file_scheme.size());
    uri.remove_prefix(std::min(uri.find('/'), uri.size())); // the host
    return percent_decoded(uri);
}

std::string uri_of(std::string_view path) {
    std::string uri(file_scheme);
    for (const char c : path) {
        uri += stands_for_itself(c)
                   ? std::string(1, c)
                   : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    return uri;
}

Analysis::Analysis(const std::string& path, std::string text, const Schema& known)
    : schema(known), file(sources.add(path, std::move(text))), tokens(lex(sources, file, syntax)),
      tree(std::make_shared<const ast::File>(parse(sources, file, tokens, syntax))),
      symbols(find_symbols(*tree, schema, sources)) {}

Json range_in(const Positions& positions, std::uint32_t begin, std::uint32_t end) {
    return {{"start", json_of(positions.place(begin))}, {"end", json_of(positions.place(end))}};
}

Place Document::read_place(const Json& position) {
    const auto number = [&](const char* key) {
        const auto value = position.at(key).get<std::int64_t>();
        constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
        if (!position.at(key).is_number_integer() || value < 0) {
            throw RequestError(ErrorCode::invalid_params, fmt::format("`{}` is not a whole number", key));
        }
        return static_cast<std::uint32_t>(std::min(value, most));
    };
    return {number("line"), number("character")};
}

void Document::change(const Json& changes, std::int64_t version) {
    for (const Json& part : changes) {
        const auto& replacement = part.at("text").get_ref<const std::string&>();
        const auto range = part.find("range");
        if (range == part.end()) {
            text_ = replacement;
        } else {
            const std::uint32_t begin = offset(range->at("start"));
            const std::uint32_t end = std::max(begin, offset(range->at("end")));
            text_.replace(begin, end - begin, replacement);
        }
        forget();
    }
    version_ = version;
}

void Document::forget() {
    positions_.reset();
    analysis_.reset();
    checked.reset();
}

const Analysis& Document::analysis(const Schema& schema) {
    if (!analysis_) {
        analysis_ = std::make_unique<Analysis>(path_, text_, schema);
    }
    return *analysis_;
}

const Positions& Document::positions() {
    if (!positions_) {
        positions_.emplace(text_, encoding_);
    }
    return *positions_;
}

Json Document::range(std::uint32_t begin, std::uint32_t end) {
    return range_in(positions(), begin, end);
}

} // namespace scc::lang::lsp
