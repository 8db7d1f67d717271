#pragma once

#include <span>
#include <string_view>

/// The stiff and extreme suite: scenes of one parameter, swept over decades.
namespace scc::validation {

/// What a step's pictures are compared with.
enum class Reference {
    neutral, ///< the picture at the sweep's start in double: what is seen does not depend on the parameter
    formula, ///< what the scene draws in double, at the same step, with `formula` set: by another way
};

/// A scene whose `value` goes from 10^from to 10^to, a step per decade.
struct Family {
    std::string_view name; ///< of the scene, cases/NAME.scn, or with a suffix of a sweep of the same scene
    std::string_view scene;
    std::string_view title; ///< for people: what is swept
    int from = 0, to = 0;   ///< powers of ten; `from` is the harmless end
    Reference reference = Reference::neutral;
    std::string_view against; ///< the other renderers that can take it, separated by commas
    int holds_to = 0;         ///< the recorded threshold: `--precision auto` keeps 1e-4 from `from` to here
    std::string_view bound;   ///< what bounds us there
};

std::span<const Family> families();
/// Null if there is none of that name.
const Family* find_family(std::string_view name);
/// The text of cases/SCENE.scn, which the program holds.
std::string_view scene_text(std::string_view scene);

} // namespace scc::validation
