#include "compiler/cli/native.h"

#include "compiler/cli/commands.h"
#include "runtime/host/file.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <fmt/core.h>

#include <cstdlib>
#include <sstream>
#include <unistd.h>
#include <vector>

namespace scc::cli {

namespace fs = std::filesystem;

namespace {

constexpr double compile_timeout_seconds = 600;

// Where the runtime's headers and the host library lie: beside an installed scc, else where scc was built.
struct RuntimeFiles {
    fs::path include;
    fs::path library;
};

RuntimeFiles find_runtime() {
    std::error_code error;
    const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    const RuntimeFiles candidates[] = {{prefix / "include/scc", prefix / "lib/scc/libscc_host.a"},
                                       {SCC_SOURCE_DIR, SCC_HOST_LIBRARY}};
    for (const RuntimeFiles& files : candidates) {
        if (fs::exists(files.include / "runtime/render.h", error) && fs::exists(files.library, error)) {
            return files;
        }
    }
    throw EnvironmentError(
        "cannot find the runtime's headers and library, neither beside scc nor where it was built");
}

std::string find_compiler() {
    if (const char* chosen = std::getenv("CXX"); chosen != nullptr && *chosen != '\0') {
        if (!validation::find_program(chosen)) {
            throw EnvironmentError(
                fmt::format("there is no C++ compiler `{}` (from the variable CXX)", chosen));
        }
        return chosen;
    }
    for (const char* name : {"c++", "g++", "clang++"}) {
        if (validation::find_program(name)) {
            return name;
        }
    }
    throw EnvironmentError("there is no C++ compiler; on Debian: apt install g++");
}

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> result;
    for (std::string word; stream >> word;) {
        result.push_back(word);
    }
    return result;
}

std::vector<std::string> arguments(const RuntimeFiles& runtime) {
    // No contraction: the program must draw the same bits as the generic renderer. The two -fno- options
    // change no value; they let square roots and selections be compiled without calls and branches.
    std::vector<std::string> list{
        "-std=c++20",         "-O3",     "-march=native", "-ffp-contract=off", "-fno-math-errno",
        "-fno-trapping-math", "-DNDEBUG"};
    for (const std::string& flag : words(SCC_EXTRA_FLAGS)) {
        list.push_back(flag);
    }
    for (const std::string& argument :
         {std::string("-I"), runtime.include.string(), std::string("scene.cpp"), std::string("-o"),
          std::string("program"), runtime.library.string()}) {
        list.push_back(argument);
    }
    for (const std::string& library : words(SCC_HOST_LINK_LIBRARIES)) {
        list.push_back(library);
    }
    return list;
}

/// The program is its code with the values after it, aligned as their tables are within.
void install(const fs::path& code, const std::string& values, const fs::path& output) {
    constexpr std::size_t alignment = 64;
    std::string bytes(host::MappedFile(code.string()).text());
    bytes.resize((bytes.size() + alignment - 1) / alignment * alignment);
    bytes += values;
    host::replace_file(output.string(), bytes, host::FileKind::program);
}

} // namespace

void compile_native(const compiler::CppProgram& program, const fs::path& output) {
    const RuntimeFiles runtime = find_runtime();
    const std::string compiler = find_compiler();
    const validation::ScratchFolder folder;
    host::replace_file((folder.path() / "scene.cpp").string(), program.source);
    validation::Command command;
    command.program = compiler;
    command.arguments = arguments(runtime);
    command.directory = folder.path();
    command.timeout_seconds = compile_timeout_seconds;
    const validation::ProcessResult result = validation::run(command);
    if (result.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
    if (!result.ok()) {
        throw EnvironmentError(fmt::format("the C++ compiler `{}` failed ({}):\n{}", compiler,
                                           validation::describe(result, command), result.err));
    }
    install(folder.path() / "program", program.values, output);
}

} // namespace scc::cli
