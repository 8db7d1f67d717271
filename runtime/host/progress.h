#pragma once

#include "runtime/host/options.h"

#include <chrono>
#include <string>

namespace scc::host {

/// One line on stderr that is rewritten on a terminal: part done, time gone, time left. `automatic` shows it
/// on a terminal once a second has gone; `always` also writes to files, a line per tenth.
class ProgressLine {
public:
    ProgressLine(std::string what, ProgressMode mode);
    ~ProgressLine(); ///< wipes the line

    void update(double done);

private:
    std::string what_;
    bool enabled_;
    bool terminal_;
    bool at_once_;
    bool shown_ = false;
    int last_tenth_ = -1;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Turns SIGINT and SIGTERM into a flag while it lives; a second signal ends the program at once.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    static bool interrupted();
};

} // namespace scc::host
