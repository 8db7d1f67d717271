#include "runtime/host/progress.h"

#include <fmt/core.h>

#include <csignal>
#include <cstdio>
#include <unistd.h>

namespace scc::host {

namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

extern "C" void note_interrupt(int) {
    interrupt_flag = 1;
}

std::string duration(double seconds) {
    if (seconds < 60) {
        return fmt::format("{:.1f} s", seconds);
    }
    const int whole = static_cast<int>(seconds + 0.5);
    return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                        : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

} // namespace

ProgressLine::ProgressLine(std::string what, ProgressMode mode)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), at_once_(mode == ProgressMode::always) {
    enabled_ = mode == ProgressMode::always || (mode == ProgressMode::automatic && terminal_);
}

ProgressLine::~ProgressLine() {
    if (shown_ && terminal_) {
        fmt::print(stderr, "\r\033[K");
    }
}

void ProgressLine::update(double done) {
    const double gone = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const int tenth = static_cast<int>(done * 10);
    if (!enabled_ || (!at_once_ && gone < 1) || (!terminal_ && tenth == last_tenth_)) {
        return;
    }
    last_tenth_ = tenth;
    shown_ = true;
    std::string line = fmt::format("{} {:3.0f} %, {} gone", what_, 100 * done, duration(gone));
    if (done > 0 && done < 1) {
        line += fmt::format(", about {} left", duration(gone * (1 - done) / done));
    }
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
}

InterruptGuard::InterruptGuard() {
    interrupt_flag = 0;
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::interrupted() {
    return interrupt_flag != 0;
}

} // namespace scc::host
