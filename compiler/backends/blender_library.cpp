#include "compiler/backends/blender_library.h"

#include <algorithm>
#include <vector>

namespace scc::compiler {

/// blender/*.py joined; written by CMake from blender_text.cpp.in.
extern const std::string_view blender_text;

namespace {

std::string_view trimmed(std::string_view text) {
    const auto begin = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(begin);
}

bool names_one_of(std::string_view words, const BlenderFeatures& features) {
    while (!words.empty()) {
        const auto end = std::min(words.find(' '), words.size());
        if (features.contains(words.substr(0, end))) {
            return true;
        }
        words = trimmed(words.substr(end));
    }
    return false;
}

} // namespace

std::string select_features(std::string_view text, const BlenderFeatures& features) {
    std::string result;
    std::vector<bool> open; // of each surrounding part, whether it is wanted
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
        const std::string_view line = text.substr(0, end);
        text = text.substr(end);
        const std::string_view words = trimmed(line.substr(0, line.find_last_not_of('\n') + 1));
        if (words == "#: end") {
            open.pop_back();
        } else if (words.starts_with("#: ")) {
            open.push_back(names_one_of(words.substr(3), features));
        } else if (std::find(open.begin(), open.end(), false) == open.end()) {
            result += line;
        }
    }
    return result;
}

std::string blender_library(const BlenderFeatures& features) {
    return select_features(blender_text, features);
}

} // namespace scc::compiler
