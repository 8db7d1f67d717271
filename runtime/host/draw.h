#pragma once

#include "runtime/aov.h"
#include "runtime/host/options.h"
#include "runtime/host/scene_names.h"
#include "runtime/image.h"
#include "runtime/render_request.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace scc::host {

/// A scene that is ready to be drawn, and what the statistics say of it.
struct Drawable {
    std::string scene;
    std::string precision;        ///< "float" or "double"
    std::string precision_reason; ///< why that one
    std::string isa;              ///< what the kernels were compiled for
    std::vector<std::string> features;
    runtime::RenderSettings settings;
    std::vector<std::pair<std::string, double>> times_ms; ///< of the stages before
    std::function<runtime::RenderResult(const runtime::RenderRequest&, runtime::Image&)> render;
    /// Called only where RenderOptions::aovs names some. False if the request's progress ended it.
    std::function<bool(const runtime::RenderRequest&, runtime::AovImage&)> draw_aovs{};
    std::function<SceneNames()> names{}; ///< likewise
};

/// Draws, writes the picture and the statistics. Returns the exit code (fine, interrupted); an interrupted
/// render leaves no file. Throws FileError and UsageError.
int draw(const Drawable& drawable, const RenderOptions& options);

} // namespace scc::host
