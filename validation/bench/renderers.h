#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Programs that draw one picture, each run as a process of its own.
namespace scc::bench {

/// One run. With a failure the rest means nothing.
struct Drawing {
    double trace = 0; ///< seconds, by the renderer's own account: without reading, building and writing
    double parse =
        0; ///< seconds, by its own account: from the file to the scene, without building hierarchies
    double wall = 0;      ///< seconds, of the process
    nlohmann::json stats; ///< as `--stats` writes them; of peers nothing
    std::string version;  ///< of a peer, as it names itself
    std::string failure;  ///< in words; empty: none
};

inline Drawing failed(const std::string& why) {
    Drawing drawing;
    drawing.failure = why;
    return drawing;
}

struct PictureJob {
    std::filesystem::path folder; ///< an existing one, for all files
    int threads = 1;
    int width = 0, height = 0;            ///< for POV-Ray, whose scenes do not say
    std::vector<std::string> arguments{}; ///< further ones, for ours
    std::string image = "picture.png";    ///< of ours; the peers put their names before it
};

/// `scc render SCENE`.
Drawing draw_with_scc(const std::filesystem::path& scc, const std::filesystem::path& scene, PictureJob job);
/// A program of `scc build`.
Drawing draw_with_program(const std::filesystem::path& program, PictureJob job);
/// 8-bit PNG, one sample per pixel at its centre.
Drawing draw_with_povray(const std::filesystem::path& scene, const PictureJob& job);
Drawing draw_with_tachyon(const std::filesystem::path& scene, const PictureJob& job);

} // namespace scc::bench
