#pragma once

#include <sys/types.h>

namespace scc::validation {

/// While one of these exists, SIGINT, SIGTERM and SIGHUP are passed on to the process groups that are
/// enlisted, before the caller's own handler runs. A signal that the caller ignores stays ignored.
class SignalRelay {
public:
    SignalRelay();
    /// The last one restores the caller's handlers; if a signal came that had none, it is raised again.
    ~SignalRelay();
    SignalRelay(const SignalRelay&) = delete;
    SignalRelay& operator=(const SignalRelay&) = delete;

    /// The signal that came, or 0.
    static int received();

    /// From here on signals reach this group too. False if too many are enlisted already.
    bool enlist(pid_t group);
    void dismiss();

private:
    int slot_ = -1;
};

} // namespace scc::validation
