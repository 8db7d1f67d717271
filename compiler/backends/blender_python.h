#pragma once

#include "runtime/math/affine.h"
#include "runtime/math/vec.h"

#include <string>
#include <string_view>

/// Values as Python writes them.
namespace scc::compiler {

std::string python(double value);
std::string python(const runtime::Vec3<double>& v);
std::string python(const runtime::Rgb<double>& c);
std::string python(const runtime::Affine<double>& a);

/// An author's text. Bytes outside ASCII are read as UTF-8.
std::string python(std::string_view text);

} // namespace scc::compiler
