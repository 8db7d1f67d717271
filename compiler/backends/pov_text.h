#pragma once

#include "compiler/writer.h"
#include "runtime/math/affine.h"
#include "runtime/math/vec.h"

#include <fmt/core.h>

#include <string>

/// Values as SDL writes them.
namespace scc::compiler {

inline std::string pov_vector(const runtime::Vec3<double>& v) {
    return fmt::format("<{}, {}, {}>", number(v.x), number(v.y), number(v.z));
}

/// A colour as one number where its channels are equal.
inline std::string pov_color(const runtime::Rgb<double>& c) {
    if (c.r == c.g && c.g == c.b) {
        return number(c.r);
    }
    return fmt::format("<{}, {}, {}>", number(c.r), number(c.g), number(c.b));
}

/// A transform as a statement; empty for the identity.
inline std::string pov_transform(const runtime::Affine<double>& a) {
    const auto& m = a.m;
    runtime::Affine<double> shift;
    for (int row = 0; row < 3; ++row) {
        shift.m[row][3] = m[row][3];
    }
    if (a == runtime::Affine<double>{}) {
        return {};
    }
    if (a == shift) {
        return "translate " + pov_vector(runtime::translation_of(a));
    }
    // Rows are the images of x, y, z and of the origin.
    std::string text = "matrix <";
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            text += fmt::format("{}{}",
                                column + row == 0 ? ""
                                : row == 0        ? ",  "
                                                  : ", ",
                                number(m[row][column]));
        }
    }
    return text + ">";
}

} // namespace scc::compiler
