#include "validation/subprocess.h"

#include "validation/signal_relay.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

extern char** environ;

namespace scc::validation {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double grace_seconds = 1;   ///< between SIGTERM and SIGKILL
constexpr double drain_seconds = 0.5; ///< for what is still in the pipes once the group is gone
constexpr int poll_slice_milliseconds =
    20; ///< a program that ends but leaves its pipes open is noticed this late

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class Descriptor {
public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }

    int get() const { return fd_; }
    bool is_open() const { return fd_ >= 0; }
    void close() {
        if (fd_ >= 0)
            ::close(fd_);
        fd_ = -1;
    }

private:
    int fd_;
};

/// Above the three standard streams, so that dup2 onto these cannot hit it.
Descriptor above_standard_streams(int fd) {
    if (fd < 0 || fd > STDERR_FILENO)
        return Descriptor(fd);
    Descriptor low(fd);
    return Descriptor(::fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

struct Pipe {
    Descriptor read;
    Descriptor write;

    bool open() {
        std::array<int, 2> ends{-1, -1};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0)
            return false;
        read = above_standard_streams(ends[0]);
        write = above_standard_streams(ends[1]);
        return read.is_open() && write.is_open();
    }
};

/// Keeps the first and the last part of a stream.
class BoundedText {
public:
    explicit BoundedText(std::size_t limit) : half_(limit / 2) {}

    void append(std::string_view text) {
        const std::size_t room = std::min(half_ - std::min(half_, head_.size()), text.size());
        head_ += text.substr(0, room);
        tail_ += text.substr(room);
        if (tail_.size() > 2 * half_ + 4096)
            trim();
    }

    std::string take() {
        trim();
        if (dropped_ == 0)
            return head_ + tail_;
        return head_ + fmt::format("\n[{} bytes left out]\n", dropped_) + tail_;
    }

private:
    void trim() {
        if (tail_.size() <= half_)
            return;
        dropped_ += tail_.size() - half_;
        tail_.erase(0, tail_.size() - half_);
    }

    std::size_t half_;
    std::size_t dropped_ = 0;
    std::string head_;
    std::string tail_;
};

/// All that the child needs, made before the fork: after it only async-signal-safe calls are allowed.
class ProgramImage {
public:
    ProgramImage(const std::string& program, const Command& command)
        : program_(program), directory_(command.directory) {
        strings_.push_back(command.program);
        strings_.insert(strings_.end(), command.arguments.begin(), command.arguments.end());
        std::map<std::string, std::string> variables;
        for (char** entry = environ; *entry != nullptr; ++entry) {
            const std::string text = *entry;
            const std::size_t equals = text.find('=');
            if (equals != std::string::npos)
                variables.emplace(text.substr(0, equals), text.substr(equals + 1));
        }
        if (!directory_.empty()) // Blender, for one, takes its word for it
            variables["PWD"] = fs::absolute(directory_).string();
        for (const auto& [name, value] : command.environment)
            variables[name] = value;
        for (const auto& [name, value] : variables)
            settings_.push_back(name + "=" + value);
        arguments_ = pointers(strings_);
        environment_ = pointers(settings_);
    }

    /// Returns only if the program could not be started, with errno.
    void exec() {
        if (!directory_.empty() && ::chdir(directory_.c_str()) != 0)
            return;
        ::execve(program_.c_str(), arguments_.data(), environment_.data());
    }

private:
    static std::vector<char*> pointers(std::vector<std::string>& strings) {
        std::vector<char*> result;
        for (std::string& text : strings)
            result.push_back(text.data());
        result.push_back(nullptr);
        return result;
    }

    std::string program_;
    std::string directory_;
    std::vector<std::string> strings_;
    std::vector<std::string> settings_;
    std::vector<char*> arguments_;
    std::vector<char*> environment_;
};

struct Streams {
    Descriptor input;
    Pipe out;
    Pipe err;
    Pipe failure; ///< carries errno if the program cannot be started; closed by a successful exec

    bool open() {
        input = above_standard_streams(::open("/dev/null", O_RDONLY | O_CLOEXEC));
        return input.is_open() && out.open() && err.open() && failure.open();
    }
};

void reset_signals() {
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD})
        ::sigaction(signal, &action, nullptr);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

[[noreturn]] void become(ProgramImage& image, const Streams& streams, pid_t parent) {
    ::setpgid(0, 0);
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // not to outlive us even if we are killed
#endif
    if (::getppid() != parent)
        ::_exit(127);
    reset_signals();
    if (::dup2(streams.input.get(), STDIN_FILENO) >= 0 &&
        ::dup2(streams.out.write.get(), STDOUT_FILENO) >= 0 &&
        ::dup2(streams.err.write.get(), STDERR_FILENO) >= 0) {
#ifdef CLOSE_RANGE_CLOEXEC
        ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
#endif
        image.exec();
    }
    const int error = errno;
    [[maybe_unused]] const ssize_t written = ::write(streams.failure.write.get(), &error, sizeof error);
    ::_exit(127);
}

/// The child's id, or -1. No signal handler of ours runs in the child.
pid_t start(ProgramImage& image, const Streams& streams) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0)
        become(image, streams, parent);
    if (child > 0)
        ::setpgid(child, child); // whoever is first; later fails harmlessly
    const int error = errno;
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    errno = error;
    return child;
}

/// errno of a failed exec, 0 once the program runs.
int start_error(Streams& streams) {
    streams.failure.write.close();
    int error = 0;
    ssize_t count = 0;
    do
        count = ::read(streams.failure.read.get(), &error, sizeof error);
    while (count < 0 && errno == EINTR);
    streams.failure.read.close();
    return count == static_cast<ssize_t>(sizeof error) ? error : 0;
}

/// Reads what there is; closes the descriptor at the end of the stream.
void drain(Descriptor& stream, BoundedText& text) {
    std::array<char, 65536> buffer;
    const ssize_t count = ::read(stream.get(), buffer.data(), buffer.size());
    if (count > 0)
        text.append({buffer.data(), static_cast<std::size_t>(count)});
    else if (count == 0 || (errno != EINTR && errno != EAGAIN))
        stream.close();
}

class Supervisor {
public:
    Supervisor(pid_t child, Streams& streams, const Command& command)
        : child_(child), out_(streams.out.read), err_(streams.err.read), out_text_(command.max_output_bytes),
          err_text_(command.max_output_bytes), timeout_(command.timeout_seconds) {}

    ProcessResult watch(SignalRelay& relay) {
        ProcessResult result;
        while (!has_ended()) {
            read_for(poll_slice_milliseconds);
            end_if_due(result);
        }
        result.wall_seconds = seconds_since(start_);
        ::kill(-child_, SIGKILL); // what it left running; its own id is not free before it is waited for
        relay.dismiss();
        const std::optional<int> status = wait_status();
        const Clock::time_point end = Clock::now();
        while ((out_.is_open() || err_.is_open()) && seconds_since(end) < drain_seconds)
            read_for(poll_slice_milliseconds);
        conclude(result, status);
        return result;
    }

private:
    bool has_ended() const {
        siginfo_t state{};
        const int error = ::waitid(P_PID, static_cast<id_t>(child_), &state, WEXITED | WNOHANG | WNOWAIT);
        return error != 0 || state.si_pid != 0;
    }

    /// Nothing if somebody else took it, as the system does where SIGCHLD is ignored.
    std::optional<int> wait_status() const {
        int status = 0;
        pid_t id = 0;
        do
            id = ::waitpid(child_, &status, 0);
        while (id < 0 && errno == EINTR);
        return id == child_ ? std::optional(status) : std::nullopt;
    }

    void read_for(int milliseconds) {
        if (!out_.is_open() && !err_.is_open()) {
            // Both streams closed: nearly always the end, so look again soon.
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return;
        }
        std::array<pollfd, 2> waits{pollfd{out_.get(), POLLIN, 0}, pollfd{err_.get(), POLLIN, 0}};
        if (::poll(waits.data(), waits.size(), milliseconds) <= 0)
            return;
        if (waits[0].revents != 0)
            drain(out_, out_text_);
        if (waits[1].revents != 0)
            drain(err_, err_text_);
    }

    void end_if_due(ProcessResult& result) {
        const double now = seconds_since(start_);
        if (!ending_since_) {
            const int signal = SignalRelay::received();
            const bool late = timeout_ > 0 && now > timeout_;
            if (signal == 0 && !late)
                return;
            result.end = signal != 0 ? ProcessEnd::interrupted : ProcessEnd::timed_out;
            result.code = signal;
            ending_since_ = now;
            if (signal == 0)
                ::kill(-child_, SIGTERM);
        } else if (now - *ending_since_ > grace_seconds) {
            ::kill(-child_, SIGKILL);
        }
    }

    void conclude(ProcessResult& result, std::optional<int> status) {
        result.out = out_text_.take();
        result.err = err_text_.take();
        if (!ending_since_ && SignalRelay::received() != 0) {
            result.end = ProcessEnd::interrupted;
            result.code = SignalRelay::received();
        } else if (!ending_since_ && status) {
            result.end = WIFEXITED(*status) ? ProcessEnd::exited : ProcessEnd::signalled;
            result.code = WIFEXITED(*status) ? WEXITSTATUS(*status) : WTERMSIG(*status);
        } else if (!ending_since_) {
            result.code = ECHILD;
        }
    }

    pid_t child_;
    Descriptor& out_;
    Descriptor& err_;
    BoundedText out_text_;
    BoundedText err_text_;
    double timeout_;
    Clock::time_point start_ = Clock::now();
    std::optional<double> ending_since_;
};

ProcessResult not_started(int error) {
    ProcessResult result;
    result.code = error;
    return result;
}

bool is_executable_file(const fs::path& path) {
    std::error_code none;
    return fs::is_regular_file(path, none) && ::access(path.c_str(), X_OK) == 0;
}

} // namespace

ProcessResult run(const Command& command) {
    const std::optional<std::string> program = find_program(command.program);
    if (!program)
        return not_started(ENOENT);
    Streams streams;
    if (!streams.open())
        return not_started(errno);
    ProgramImage image(*program, command);
    SignalRelay relay;
    if (const int signal = SignalRelay::received(); signal != 0) {
        ProcessResult result;
        result.end = ProcessEnd::interrupted;
        result.code = signal;
        return result;
    }
    const pid_t child = start(image, streams);
    if (child < 0)
        return not_started(errno);
    relay.enlist(child);
    Supervisor supervisor(child, streams, command);
    streams.input.close();
    streams.out.write.close();
    streams.err.write.close();
    const int error = start_error(streams);
    ProcessResult result = supervisor.watch(relay);
    return error != 0 ? not_started(error) : result;
}

std::string describe(const ProcessResult& result, const Command& command) {
    switch (result.end) {
    case ProcessEnd::exited:
        return fmt::format("exit status {}", result.code);
    case ProcessEnd::signalled:
        return fmt::format("ended by signal {} ({})", result.code, ::strsignal(result.code));
    case ProcessEnd::timed_out:
        return fmt::format("no end after {} s", command.timeout_seconds);
    case ProcessEnd::interrupted:
        return fmt::format("interrupted by signal {} ({})", result.code, ::strsignal(result.code));
    case ProcessEnd::not_started:
        return fmt::format("cannot start `{}`: {}", command.program, std::strerror(result.code));
    }
    return {};
}

std::optional<std::string> find_program(const std::string& name) {
    if (name.find('/') != std::string::npos)
        return is_executable_file(name) ? std::optional(fs::absolute(name).string()) : std::nullopt;
    const char* list = std::getenv("PATH");
    std::string_view folders = list != nullptr ? list : "";
    while (!name.empty() && !folders.empty()) {
        const std::size_t colon = std::min(folders.find(':'), folders.size());
        const fs::path candidate = fs::path(folders.substr(0, colon)) / name;
        folders.remove_prefix(std::min(colon + 1, folders.size()));
        if (candidate.has_parent_path() && is_executable_file(candidate))
            return fs::absolute(candidate).string();
    }
    return std::nullopt;
}

} // namespace scc::validation
