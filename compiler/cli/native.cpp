#include "compiler/cli/native.h"

#include "compiler/cli/commands.h"
#include "runtime/host/cache.h"
#include "runtime/host/file.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

namespace scc::cli {

namespace fs = std::filesystem;

namespace {

constexpr double compile_timeout_seconds = 600;

// Where the headers and the libraries of programs lie: beside an installed scc, else where scc was built.
struct RuntimeFiles {
    fs::path include;
    fs::path library;
    std::vector<fs::path> front_end; ///< libraries too, of programs whose scene has parameters
};

RuntimeFiles find_runtime() {
    std::error_code error;
    const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    const fs::path installed = prefix / "lib/scc";
    const RuntimeFiles candidates[] = {
        {prefix / "include/scc",
         installed / "libscc_host.a",
         {installed / "libscc_compiler.a", installed / "libscc_lang.a", installed / "libscc_read_image.a"}},
        {SCC_SOURCE_DIR, SCC_HOST_LIBRARY, {SCC_COMPILER_LIBRARY, SCC_LANG_LIBRARY, SCC_READ_IMAGE_LIBRARY}}};
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

/// A file's identity without its content: another compiler under the same name is another file.
std::string stamp_of(const fs::path& file) {
    const fs::path real = fs::canonical(file);
    return fmt::format("{} {} {}", real.string(), fs::file_size(real),
                       fs::last_write_time(real).time_since_epoch().count());
}

/// What -march=native depends on: the processor's name and its instructions.
std::string processor() {
    std::ifstream stream("/proc/cpuinfo");
    std::string text;
    for (std::string line; std::getline(stream, line) && !line.empty();) {
        for (const char* field :
             {"vendor_id", "cpu family", "model", "stepping", "flags", "CPU", "Features"}) {
            if (line.starts_with(field)) {
                text += line + "\n";
            }
        }
    }
    return text;
}

/// Everything but the source that decides what the compiler makes of it.
struct Toolchain {
    RuntimeFiles runtime;
    std::string compiler;
    std::vector<std::string> flags;
    std::vector<std::string> link_flags;
    std::string key;
};

std::string runtime_key(const RuntimeFiles& runtime) {
    std::vector<fs::path> files{runtime.library};
    for (const auto& entry : fs::recursive_directory_iterator(runtime.include / "runtime")) {
        if (const fs::path& path = entry.path(); path.extension() == ".h" || path.extension() == ".def") {
            files.push_back(path);
        }
    }
    std::sort(files.begin(), files.end());
    std::string key;
    for (const fs::path& file : files) {
        key = host::cache_key({key, file.string(), host::MappedFile(file.string()).text()});
    }
    return key;
}

Toolchain find_toolchain(Target target) {
    Toolchain result;
    result.runtime = find_runtime();
    result.compiler = find_compiler();
    // No contraction: the program must draw the same bits as the generic renderer. The two -fno- options
    // change no value; they let square roots and selections be compiled without calls and branches.
    result.flags = {"-std=c++20",
                    "-O3",
                    "-pipe",
                    "-ffp-contract=off",
                    "-fno-math-errno",
                    "-fno-trapping-math",
                    "-DNDEBUG",
                    "-I",
                    result.runtime.include.string()};
    if (target == Target::host) {
        result.flags.push_back("-march=native");
    }
    for (const std::string& flag : words(SCC_EXTRA_FLAGS)) {
        result.flags.push_back(flag);
    }
    result.link_flags = words(SCC_HOST_LINK_LIBRARIES);
    // A third of ld's time. Sanitizers are tested with the compiler's own choice.
    if (std::string_view(SCC_EXTRA_FLAGS).empty() && validation::find_program("ld.gold")) {
        result.link_flags.push_back("-fuse-ld=gold");
    }
    const std::string path = validation::find_program(result.compiler).value_or(result.compiler);
    result.key = host::cache_key({stamp_of(path), fmt::format("{}", fmt::join(result.flags, " ")),
                                  fmt::format("{}", fmt::join(result.link_flags, " ")),
                                  target == Target::host ? processor() : "", runtime_key(result.runtime)});
    return result;
}

/// What a program is linked with, and what of that is not in the toolchain's key.
struct Libraries {
    std::vector<std::string> arguments;
    std::string key;
};

Libraries libraries_of(const compiler::CppProgram& program, const RuntimeFiles& runtime) {
    Libraries result;
    if (!program.takes_definitions()) {
        result.arguments = {runtime.library.string()};
        return result;
    }
    for (const fs::path& library : runtime.front_end) {
        result.arguments.push_back(library.string());
        result.key += stamp_of(library) + "\n";
    }
    result.arguments.push_back(runtime.library.string());
    const std::vector<std::string> theirs = words(SCC_FRONT_END_LINK_LIBRARIES);
    result.arguments.insert(result.arguments.end(), theirs.begin(), theirs.end());
    return result;
}

void run_compiler(const Toolchain& toolchain, std::vector<std::string> arguments, const fs::path& folder) {
    validation::Command command;
    command.program = toolchain.compiler;
    command.arguments = toolchain.flags;
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    command.directory = folder;
    command.timeout_seconds = compile_timeout_seconds;
    const validation::ProcessResult result = validation::run(command);
    if (result.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
    if (!result.ok()) {
        throw EnvironmentError(fmt::format("the C++ compiler `{}` failed ({}):\n{}", toolchain.compiler,
                                           validation::describe(result, command), result.err));
    }
}

constexpr const char* common_header = "scene_runtime.h";

/// Puts a header with all that generated programs include into the folder, and beside it, where there is a
/// cache to keep it in, the same precompiled: reading it takes a tenth of what the headers take.
void provide_common_header(const Toolchain& toolchain, const host::Cache& cache, const fs::path& folder) {
    std::string text = "#pragma once\n";
    for (const std::string_view header : compiler::program_headers) {
        text += fmt::format("#include {}\n", header);
    }
    host::replace_file((folder / common_header).string(), text);
    const std::string key = host::cache_key({toolchain.key, text});
    std::optional<host::Cache::Entry> entry = cache.find("headers", key);
    if (!entry && cache.keeps()) {
        run_compiler(toolchain, {"-x", "c++-header", common_header, "-o", "precompiled"}, folder);
        cache.store("headers", key, host::MappedFile((folder / "precompiled").string()).text());
        entry = cache.find("headers", key);
    }
    if (entry) {
        fs::create_symlink(entry->path(), folder / (std::string(common_header) + ".gch"));
    }
}

std::string compile(const Toolchain& toolchain, const host::Cache& cache, const std::string& source,
                    const std::vector<std::string>& libraries) {
    const validation::ScratchFolder folder;
    provide_common_header(toolchain, cache, folder.path());
    host::replace_file((folder.path() / "scene.cpp").string(), source);
    std::vector<std::string> arguments{"-include", common_header, "scene.cpp", "-o", "program"};
    arguments.insert(arguments.end(), libraries.begin(), libraries.end());
    arguments.insert(arguments.end(), toolchain.link_flags.begin(), toolchain.link_flags.end());
    run_compiler(toolchain, arguments, folder.path());
    return std::string(host::MappedFile((folder.path() / "program").string()).text());
}

/// The program is its code with the values after it, aligned as their tables are within.
void install(std::string_view code, const std::string& values, const fs::path& output) {
    constexpr std::size_t alignment = 64;
    const std::size_t start = (code.size() + alignment - 1) / alignment * alignment;
    std::string bytes;
    bytes.reserve(start + values.size());
    bytes += code;
    bytes.resize(start);
    bytes += values;
    host::replace_file(output.string(), bytes, host::FileKind::program);
}

} // namespace

void compile_native(const compiler::CppProgram& program, const NativeOptions& options,
                    const fs::path& output) {
    const Toolchain toolchain = find_toolchain(options.target);
    const host::Cache cache = options.use_cache ? host::Cache::of_user() : host::Cache();
    const Libraries libraries = libraries_of(program, toolchain.runtime);
    const std::string key = host::cache_key({toolchain.key, libraries.key, program.source});
    if (const std::optional<host::Cache::Entry> found = cache.find("code", key)) {
        install(found->content(), program.values, output);
        return;
    }
    const std::string code = compile(toolchain, cache, program.source, libraries.arguments);
    cache.store("code", key, code);
    install(code, program.values, output);
}

} // namespace scc::cli
