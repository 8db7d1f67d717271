#pragma once

#include "runtime/host/file.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace scc::cli::test {

/// Runs scc as a person would, in a folder of its own.
class CommandLine : public testing::Test {
protected:
    validation::ProcessResult scc(std::vector<std::string> arguments,
                                  std::vector<std::pair<std::string, std::string>> environment = {}) {
        return start(SCC_PROGRAM, std::move(arguments), std::move(environment));
    }
    validation::ProcessResult start(const std::string& program, std::vector<std::string> arguments,
                                    std::vector<std::pair<std::string, std::string>> environment = {}) {
        validation::Command command;
        command.program = program;
        command.arguments = std::move(arguments);
        command.directory = folder();
        command.environment = std::move(environment);
        command.timeout_seconds = 280;
        return validation::run(command);
    }

    const std::filesystem::path& folder() const { return scratch_.path(); }
    std::string path(const std::string& name) const { return (folder() / name).string(); }
    void write(const std::string& name, const std::string& text) const {
        host::replace_file(path(name), text);
    }
    std::string read(const std::string& name) const {
        std::ifstream stream(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
    /// No file but these in the folder: nothing half-written was left behind.
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder())) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    static std::string example(const std::string& name) {
        return std::string(SCC_SOURCE_DIR "/examples/") + name;
    }

private:
    validation::ScratchFolder scratch_;
};

inline constexpr const char* small_scene =
    "sphere { }\nperspective_camera { }\npoint_light { position = (3, 4, 5) }\n";

inline constexpr const char* spheres_only =
    "sphere { center = (0, 0, 0), material = phong { diffuse = rgb(0.8, 0.2, 0.2) } }\n"
    "sphere { center = (2, 0, 0), material = phong { diffuse = rgb(0.2, 0.8, 0.2) } }\n"
    "perspective_camera { eye = (0, 0, 9) }\npoint_light { position = (3, 4, 5) }\n";

} // namespace scc::cli::test
