#pragma once

#include "runtime/image.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Other renderers, run on exported scenes.
namespace scc::validation {

class RenderCache;

/// POV-Ray's own supersampling: +A<threshold> +AM<method> -J +R<depth>.
struct PovrayAntialiasing {
    int method = 1; ///< 1: depth x depth samples and the centre, where neighbours differ; 2: recursive
    int depth = 1;
    double threshold = 0; ///< 0: everywhere
};

struct RenderJob {
    std::filesystem::path scene; ///< the exported `.pov` or `.py`
    /// An existing folder for the renderer's files. The scene is copied there (unless it lies there already)
    /// and the renderer runs in it; files that the scene names relatively must be there too.
    std::filesystem::path folder;
    int width = 0;
    int height = 0;
    int samples_per_axis = 1; ///< n: drawn n times larger, then averaged
    int threads = 0;          ///< 0: as many as the renderer likes
    double timeout_seconds = 600;
    double brightest =
        1; ///< the reference's largest value; POV-Ray's file ends at 1, so its exposure follows
    bool no_bounding = false;                       ///< POV-Ray's -MB, for scenes beyond 1e6 from the origin
    std::optional<PovrayAntialiasing> antialiasing; ///< instead of `samples_per_axis`, which then is 1
    std::vector<std::string> beside;                ///< names of files beside the scene that it reads
    const RenderCache* cache = nullptr;             ///< null: it draws in any case
};

enum class RenderStatus { done, missing, failed, timed_out, interrupted };

/// Seconds; what a renderer does not tell is empty.
struct RenderTimes {
    std::optional<double> start_up; ///< total less the others
    std::optional<double> parse;
    std::optional<double> bounding;
    std::optional<double> trace;
    std::optional<double> saving;
    std::optional<double> total; ///< wall time of the process
};

/// What there is, by the members' names.
nlohmann::ordered_json to_json(const RenderTimes& times);

struct RenderResult {
    RenderStatus status = RenderStatus::failed;
    std::string reason; ///< why there is no image; empty when done
    runtime::Image image;
    std::string version; ///< "POV-Ray 3.7.0.10.unofficial"
    double exposure = 1; ///< the factor that the file was drawn with; already divided out of the image
    RenderTimes times;
    std::vector<std::string> warnings;
    std::string log;         ///< the renderer's talk, without its progress lines
    std::string command;     ///< as one could type it in the folder
    bool from_cache = false; ///< drawn and timed at some earlier time
};

/// povray +Iscene.pov +Oimage.png +W640 +H480 +FN16 File_Gamma=1.0 -A -D [+WT2] [-MB]
/// [Declare=scc_exposure=0.5]
RenderResult render_with_povray(const RenderJob& job);

/// blender -b --factory-startup --python-exit-code 1 [-t 2] -P scene.py -- --render image.exr --size 640x480
RenderResult render_with_blender(const RenderJob& job);

/// "POV-Ray 3.7.0.10.unofficial"; nothing if it is not installed.
std::optional<std::string> povray_version();
/// "Blender 3.4.1"
std::optional<std::string> blender_version();

/// scc-opengl, which draws raster pictures: beside this program or on the path.
std::optional<std::string> find_opengl_program();

/// The largest power of two, at most 1, that brings `brightest` to 1 or below.
double exposure_for(double brightest);

/// The largest finite value of an image, at least 0.
double brightest_value(const runtime::Image& image);

} // namespace scc::validation
