#pragma once

#include <functional>
#include <vector>

namespace scc::validation {

using Job = std::function<void()>;

/// Runs the jobs, at most `parallel` at a time (at least 1), starting them in their order. The first one that
/// throws keeps those that have not begun from starting; once the running ones are done, what it threw is
/// thrown.
void run_jobs(const std::vector<Job>& jobs, int parallel);

} // namespace scc::validation
