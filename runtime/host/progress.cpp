#include "runtime/host/progress.h"

#include <csignal>
#include <cstdio>
#include <unistd.h>

namespace scc::host {

namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

extern "C" void note_interrupt(int) {
    interrupt_flag = 1;
}

template <class... T>
std::string text_of(const char* format, T... value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value...);
    return text;
}

std::string duration(double seconds) {
    if (seconds < 60) {
        return text_of("%.1f s", seconds);
    }
    const int whole = static_cast<int>(seconds + 0.5);
    return whole < 3600 ? text_of("%d:%02d", whole / 60, whole % 60)
                        : text_of("%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
}

} // namespace

ProgressLine::ProgressLine(std::string what, ProgressMode mode)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), at_once_(mode == ProgressMode::always) {
    enabled_ = mode == ProgressMode::always || (mode == ProgressMode::automatic && terminal_);
}

ProgressLine::~ProgressLine() {
    if (shown_ && terminal_) {
        std::fputs("\r\033[K", stderr);
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
    std::string line = what_ + text_of(" %3.0f %%, ", 100 * done) + duration(gone) + " gone";
    if (done > 0 && done < 1) {
        line += ", about " + duration(gone * (1 - done) / done) + " left";
    }
    std::fputs(((terminal_ ? "\r" : "") + line + (terminal_ ? "\033[K" : "\n")).c_str(), stderr);
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
