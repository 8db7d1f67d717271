#pragma once

#include "runtime/aov.h"
#include "runtime/host/exr.h"
#include "runtime/host/scene_names.h"

#include <span>
#include <string>

/// AOVs as layers of an OpenEXR file, and what the command line calls them.
namespace scc::host {

struct AovRow {
    runtime::Aov aov;
    const char* name; ///< of the layer, too
};
/// All of them.
std::span<const AovRow> aov_rows();

/// `depth,normal`. Throws UsageError.
runtime::AovSet parse_aovs(const std::string& text);

/// Adds the layers: depth.Z, planar.Z, position.X to .Z, normal.X to .Z, uv.U and .V, and as whole numbers
/// object.X and material.X (a letter, since Blender takes no channels with longer names of their own). The
/// texts `object.manifest` and `material.manifest` are JSON objects from the names of what is in the picture
/// to these numbers. `aovs` must outlive the content.
void add_layers(const runtime::AovImage& aovs, const SceneNames& names, ExrContent& content);

} // namespace scc::host
