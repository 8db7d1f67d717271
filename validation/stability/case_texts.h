#pragma once

#include <span>
#include <string_view>

namespace scc::validation {

struct CaseText {
    std::string_view scene;
    std::string_view text;
};
/// The scenes of cases/, made by cases.cmake.
extern const std::span<const CaseText> case_texts;

} // namespace scc::validation
