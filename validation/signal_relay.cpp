#include "validation/signal_relay.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <mutex>

namespace scc::validation {
namespace {

constexpr std::array relayed_signals{SIGINT, SIGTERM, SIGHUP};

// What the handler touches is lock-free and has static storage.
std::array<std::atomic<pid_t>, 64> groups{};
std::atomic<int> last_signal{0};
std::array<struct sigaction, relayed_signals.size()> previous_actions{};

std::mutex relay_mutex;
int relay_count = 0;

bool is_default(const struct sigaction& action) {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_DFL;
}

bool is_ignored(const struct sigaction& action) {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN;
}

void call(const struct sigaction& action, int signal, siginfo_t* origin, void* context) {
    if ((action.sa_flags & SA_SIGINFO) != 0)
        action.sa_sigaction(signal, origin, context);
    else if (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN)
        action.sa_handler(signal);
}

void relay(int signal, siginfo_t* origin, void* context) {
    const int saved_errno = errno;
    last_signal.store(signal);
    for (const std::atomic<pid_t>& group : groups)
        if (const pid_t id = group.load(); id > 0)
            ::kill(-id, signal);
    for (std::size_t i = 0; i < relayed_signals.size(); ++i)
        if (relayed_signals[i] == signal)
            call(previous_actions[i], signal, origin, context);
    errno = saved_errno;
}

void install() {
    last_signal.store(0);
    struct sigaction action {};
    action.sa_sigaction = relay;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < relayed_signals.size(); ++i) {
        ::sigaction(relayed_signals[i], nullptr, &previous_actions[i]);
        if (!is_ignored(previous_actions[i]))
            ::sigaction(relayed_signals[i], &action, nullptr);
    }
}

void restore() {
    for (std::size_t i = 0; i < relayed_signals.size(); ++i)
        ::sigaction(relayed_signals[i], &previous_actions[i], nullptr);
    const int signal = last_signal.load();
    for (std::size_t i = 0; i < relayed_signals.size(); ++i)
        if (relayed_signals[i] == signal && is_default(previous_actions[i]))
            ::raise(signal);
}

} // namespace

SignalRelay::SignalRelay() {
    const std::lock_guard lock(relay_mutex);
    if (relay_count++ == 0)
        install();
}

SignalRelay::~SignalRelay() {
    dismiss();
    const std::lock_guard lock(relay_mutex);
    if (--relay_count == 0)
        restore();
}

int SignalRelay::received() {
    return last_signal.load();
}

bool SignalRelay::enlist(pid_t group) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
        pid_t free = 0;
        if (groups[i].compare_exchange_strong(free, group)) {
            slot_ = static_cast<int>(i);
            // A signal between the fork and this line would have missed it.
            if (const int signal = last_signal.load(); signal != 0)
                ::kill(-group, signal);
            return true;
        }
    }
    return false;
}

void SignalRelay::dismiss() {
    if (slot_ >= 0)
        groups[static_cast<std::size_t>(slot_)].store(0);
    slot_ = -1;
}

} // namespace scc::validation
