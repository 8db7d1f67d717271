#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Running other programs: with an argument list, never through a shell.
namespace scc::validation {

struct Command {
    std::string program; ///< a path, or a name that is looked up on PATH
    std::vector<std::string> arguments;
    std::filesystem::path directory;                              ///< working directory; empty: ours
    std::vector<std::pair<std::string, std::string>> environment; ///< set on top of ours
    double timeout_seconds = 0;                                   ///< 0: none
    std::size_t max_output_bytes = std::size_t{4} << 20;          ///< kept of each stream, see ProcessResult
};

enum class ProcessEnd {
    exited,      ///< code is the exit status
    signalled,   ///< code is the signal that ended it
    timed_out,   ///< we ended it
    interrupted, ///< we got SIGINT, SIGTERM or SIGHUP (code) and passed it on
    not_started, ///< code is errno
};

struct ProcessResult {
    ProcessEnd end = ProcessEnd::not_started;
    int code = 0;
    std::string
        out; ///< of a longer stream the first and the last half of what is kept, with a line between them
    std::string err;
    double wall_seconds = 0;

    bool ok() const { return end == ProcessEnd::exited && code == 0; }
};

/// Runs the program to its end, with no standard input. It leads a process group of its own, which is ended
/// as a whole (SIGTERM, then SIGKILL) by the time-out, by a signal to ourselves, and when the program itself
/// has ended but left others behind. Thread-safe.
///
/// While a program runs, SIGINT, SIGTERM and SIGHUP are passed on to it; then the caller's own handler is
/// called, or, if there is none, the signal ends us once the program is gone.
ProcessResult run(const Command& command);

/// What became of it, in words: "exit status 1", "ended by signal 11 (Segmentation fault)", "no end after 5
/// s", ...
std::string describe(const ProcessResult& result, const Command& command);

/// The absolute path of an executable file; a name without `/` is looked up on PATH.
std::optional<std::string> find_program(const std::string& name);

} // namespace scc::validation
