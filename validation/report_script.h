#pragma once

namespace scc::validation {

/// The page's script: viewers (wipe, flip, heat map with its scale, zoom with read-out) in every `.viewer`,
/// and tables that are sorted by a click on a head. Without it the page shows the same pictures side by side.
extern const char* const report_script;

/// What differences are multiplied by in a viewer's numbers, so that small ones are not rounded away.
inline constexpr double viewer_difference_scale = 1024;

} // namespace scc::validation
