#include "compiler/backends/blender_python.h"

#include "compiler/writer.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::compiler {

std::string python(double value) {
    return number(value);
}

std::string python(const runtime::Vec3<double>& v) {
    return fmt::format("({}, {}, {})", number(v.x), number(v.y), number(v.z));
}

std::string python(const runtime::Rgb<double>& c) {
    return fmt::format("({}, {}, {})", number(c.r), number(c.g), number(c.b));
}

std::string python(const runtime::Affine<double>& a) {
    std::string rows;
    for (const auto& row : a.m) {
        rows += fmt::format("{}({}, {}, {}, {})", rows.empty() ? "" : ", ", number(row[0]), number(row[1]),
                            number(row[2]), number(row[3]));
    }
    return "(" + rows + ")";
}

std::string python(std::string_view text) {
    const bool ascii =
        std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    const std::string literal = quote(Language::python, text);
    return ascii ? literal : "b" + literal + ".decode(errors=\"replace\")";
}

} // namespace scc::compiler
