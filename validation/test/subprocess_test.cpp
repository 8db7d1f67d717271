#include "validation/jobs.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;

ProcessResult shell(const std::string& script, double timeout_seconds = 20) {
    Command command;
    command.program = "sh";
    command.arguments = {"-c", script};
    command.timeout_seconds = timeout_seconds;
    return run(command);
}

std::size_t open_descriptors() {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

/// True while a process runs whose command line holds the text.
bool is_running(const std::string& text) {
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "cmdline");
        const std::string line{std::istreambuf_iterator<char>(file), {}};
        if (line.find(text) != std::string::npos && entry.path().filename() != std::to_string(::getpid()))
            return true;
    }
    return false;
}

bool ends_soon(const std::string& text) {
    for (int i = 0; i < 100 && is_running(text); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return !is_running(text);
}

TEST(Subprocess, GivesStatusAndBothStreams) {
    const ProcessResult result = shell("echo out; echo err >&2; exit 3");
    EXPECT_EQ(result.end, ProcessEnd::exited);
    EXPECT_EQ(result.code, 3);
    EXPECT_FALSE(result.ok());
    EXPECT_EQ(result.out, "out\n");
    EXPECT_EQ(result.err, "err\n");
    EXPECT_EQ(describe(result, {}), "exit status 3");
}

TEST(Subprocess, ArgumentsAreNotInterpreted) {
    Command command;
    command.program = "printf";
    command.arguments = {"%s|", "$HOME", "a b", "`id`", "x; exit 9", "*", ""};
    const ProcessResult result = run(command);
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.out, "$HOME|a b|`id`|x; exit 9|*||");
}

TEST(Subprocess, MissingProgramIsToldApartFromAFailingOne) {
    Command command;
    command.program = "scc-no-such-program";
    ProcessResult result = run(command);
    EXPECT_EQ(result.end, ProcessEnd::not_started);
    EXPECT_EQ(result.code, ENOENT);
    EXPECT_EQ(describe(result, command), "cannot start `scc-no-such-program`: No such file or directory");
    EXPECT_EQ(shell("exit 127").end, ProcessEnd::exited);
}

TEST(Subprocess, MissingDirectoryAndForeignFileFormatAreStartErrors) {
    Command command;
    command.program = "true";
    command.directory = "/no/such/folder";
    EXPECT_EQ(run(command).end, ProcessEnd::not_started);
    EXPECT_EQ(run(command).code, ENOENT);

    const ScratchFolder folder;
    const fs::path text = folder.path() / "text";
    std::ofstream(text) << "neither a script nor a binary";
    fs::permissions(text, fs::perms::owner_all);
    command.directory.clear();
    command.program = text.string();
    EXPECT_EQ(run(command).end, ProcessEnd::not_started);
    EXPECT_EQ(run(command).code, ENOEXEC);
}

TEST(Subprocess, RunsInTheDirectoryWithTheAddedEnvironmentAndNoInput) {
    const ScratchFolder folder;
    Command command;
    command.program = "sh";
    command.arguments = {"-c", "pwd -P; printenv PWD; echo $SCC_TEST_VALUE; cat; test -n \"$PATH\""};
    command.directory = folder.path();
    command.environment = {{"SCC_TEST_VALUE", "a=b c"}};
    const ProcessResult result = run(command);
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.out,
              fs::canonical(folder.path()).string() + "\n" + folder.path().string() + "\na=b c\n");
}

TEST(Subprocess, TimeOutEndsTheWholeGroup) {
    const ProcessResult result = shell("sleep 61.25 & sleep 61.25; echo late", 0.3);
    EXPECT_EQ(result.end, ProcessEnd::timed_out);
    EXPECT_EQ(result.out, "");
    EXPECT_GT(result.wall_seconds, 0.29);
    EXPECT_LT(result.wall_seconds, 5);
    EXPECT_TRUE(ends_soon("61.25"));
}

TEST(Subprocess, TimeOutAlsoEndsWhatIgnoresTermination) {
    const ProcessResult result = shell("trap '' TERM; while :; do sleep 0.05; done", 0.2);
    EXPECT_EQ(result.end, ProcessEnd::timed_out);
    EXPECT_LT(result.wall_seconds, 10);
}

TEST(Subprocess, OutputBeforeATimeOutIsKept) {
    const ProcessResult result = shell("echo early; sleep 62", 0.3);
    EXPECT_EQ(result.end, ProcessEnd::timed_out);
    EXPECT_EQ(result.out, "early\n");
}

TEST(Subprocess, WhatAProgramLeavesRunningIsEndedAndNotWaitedFor) {
    const ProcessResult result = shell("sleep 63.75 & echo done");
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.out, "done\n");
    EXPECT_LT(result.wall_seconds, 5);
    EXPECT_TRUE(ends_soon("63.75"));
}

TEST(Subprocess, ProgramMayCloseItsStreamsAndGoOn) {
    const ProcessResult result = shell("exec >&- 2>&-; sleep 0.3; exit 4");
    EXPECT_EQ(result.end, ProcessEnd::exited);
    EXPECT_EQ(result.code, 4);
    EXPECT_GE(result.wall_seconds, 0.29);
}

TEST(Subprocess, SignalThatEndsItIsNamed) {
    const ProcessResult result = shell("kill -SEGV $$");
    EXPECT_EQ(result.end, ProcessEnd::signalled);
    EXPECT_EQ(result.code, SIGSEGV);
    EXPECT_EQ(describe(result, {}), "ended by signal 11 (Segmentation fault)");
}

TEST(Subprocess, BigOutputOnBothStreamsDoesNotBlock) {
    const ProcessResult result =
        shell("(head -c 3000000 /dev/zero | tr '\\0' a >&2) & head -c 3000000 /dev/zero | tr '\\0' b; wait");
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.out, std::string(3000000, 'b'));
    EXPECT_EQ(result.err, std::string(3000000, 'a'));
}

TEST(Subprocess, LongOutputKeepsItsBeginningAndEnd) {
    Command command;
    command.program = "sh";
    command.arguments = {"-c", "echo first; head -c 5000000 /dev/zero | tr '\\0' x; echo last"};
    command.max_output_bytes = 1000;
    const ProcessResult result = run(command);
    EXPECT_TRUE(result.ok());
    const std::string note = "\n[4999011 bytes left out]\n";
    EXPECT_EQ(result.out.size(), 1000 + note.size());
    EXPECT_EQ(result.out.find("first\n"), 0U);
    EXPECT_EQ(result.out.substr(500, note.size()), note);
    EXPECT_EQ(result.out.substr(result.out.size() - 6), "xlast\n");
}

TEST(Subprocess, LeavesNoDescriptorsAndNoZombies) {
    const std::size_t before = open_descriptors();
    for (int i = 0; i < 20; ++i)
        shell("echo x");
    Command missing;
    missing.program = "scc-no-such-program";
    run(missing);
    missing.program = "true";
    missing.directory = "/no/such/folder";
    run(missing);
    EXPECT_EQ(open_descriptors(), before);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

TEST(Subprocess, ProgramInheritsOnlyTheStandardStreams) {
    const int leaky = ::dup(STDERR_FILENO); // without close-on-exec
    const ProcessResult result = shell("ls /proc/self/fd | wc -l");
    ::close(leaky);
    EXPECT_EQ(std::stoi(result.out), 4); // 0, 1, 2 and the folder that ls reads
}

TEST(Subprocess, ManyRunAtOnce) {
    std::vector<std::thread> threads;
    std::atomic<int> right{0};
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&right, i] {
            for (int j = 0; j < 5; ++j)
                right += shell("echo " + std::to_string(i)).out == std::to_string(i) + "\n";
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(right, 40);
}

TEST(Subprocess, IsFoundOnPathOrNot) {
    EXPECT_TRUE(find_program("sh").value_or("").ends_with("/sh"));
    EXPECT_TRUE(fs::path(find_program("sh").value_or("")).is_absolute());
    EXPECT_FALSE(find_program("scc-no-such-program"));
    EXPECT_FALSE(find_program(""));
    EXPECT_FALSE(find_program("/etc/passwd"));
    EXPECT_FALSE(find_program("/etc"));
}

volatile std::sig_atomic_t handled_signal = 0;
void remember(int signal) {
    handled_signal = signal;
}

std::thread signal_ourselves_after(int milliseconds, int signal) {
    return std::thread([=] {
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(::getpid(), signal);
    });
}

TEST(Subprocess, SignalToUsReachesTheProgramAndTheCallersHandler) {
    const ScratchFolder folder;
    const std::string mark = (folder.path() / "mark").string();
    const auto previous = std::signal(SIGINT, remember);
    std::thread sender = signal_ourselves_after(300, SIGINT);
    const ProcessResult result = shell("trap 'touch " + mark + "; exit' INT; while :; do sleep 0.02; done");
    sender.join();
    EXPECT_EQ(std::signal(SIGINT, previous), remember) << "the caller's handler is not restored";
    EXPECT_EQ(result.end, ProcessEnd::interrupted);
    EXPECT_EQ(result.code, SIGINT);
    EXPECT_EQ(handled_signal, SIGINT);
    EXPECT_TRUE(fs::exists(mark));
}

TEST(Subprocess, ProgramThatIgnoresTheInterruptIsEndedAllTheSame) {
    const auto previous = std::signal(SIGTERM, remember);
    std::thread sender = signal_ourselves_after(200, SIGTERM);
    const ProcessResult result = shell("trap '' TERM; while :; do sleep 0.05; done");
    sender.join();
    std::signal(SIGTERM, previous);
    EXPECT_EQ(result.end, ProcessEnd::interrupted);
    EXPECT_LT(result.wall_seconds, 10);
    EXPECT_TRUE(shell("exit 0").ok()) << "an old signal ends a new program";
}

TEST(Subprocess, WithoutAHandlerTheSignalEndsUsAfterTheProgram) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGINT, SIG_DFL);
        shell("sleep 64.5");
        ::_exit(0);
    }
    for (int i = 0; i < 200 && !is_running("64.5"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::kill(child, SIGINT);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGINT);
    EXPECT_TRUE(ends_soon("64.5"));
}

TEST(ScratchFolder, IsPrivateAndGoesWithItsContents) {
    fs::path path;
    {
        const ScratchFolder folder;
        path = folder.path();
        EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
        fs::create_directories(path / "a" / "b");
        std::ofstream(path / "a" / "b" / "c") << "x";
        EXPECT_NE(ScratchFolder().path(), path);
    }
    EXPECT_FALSE(fs::exists(path));
}

TEST(Jobs, AllRunAndNoMoreThanAskedForAtOnce) {
    std::atomic<int> running{0};
    std::atomic<int> most{0};
    std::atomic<int> done{0};
    const Job job = [&] {
        const int now = ++running;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        --running;
        ++done;
    };
    for (const int parallel : {0, 1, 3, 100}) {
        most = 0;
        run_jobs(std::vector<Job>(12, job), parallel);
        EXPECT_LE(most, std::max(parallel, 1));
    }
    EXPECT_EQ(done, 48);
    run_jobs({}, 2);
}

TEST(Jobs, TheFirstExceptionEndsThem) {
    std::atomic<int> done{0};
    std::vector<Job> jobs(100, [&] { ++done; });
    jobs[3] = [] { throw std::runtime_error("third"); };
    EXPECT_THROW(run_jobs(jobs, 1), std::runtime_error);
    EXPECT_EQ(done, 3);
    EXPECT_THROW(run_jobs(jobs, 4), std::runtime_error);
}

} // namespace
} // namespace scc::validation
