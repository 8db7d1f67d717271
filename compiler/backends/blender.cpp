#include "compiler/backends/blender.h"

#include "compiler/backends/blender_ledger.h"
#include "compiler/backends/blender_library.h"
#include "compiler/backends/blender_mesh.h"
#include "compiler/backends/blender_needs.h"
#include "compiler/backends/blender_scene.h"
#include "compiler/backends/lattices.h"
#include "compiler/resolve_bumps.h"
#include "compiler/resolve_uv.h"
#include "compiler/writer.h"

#include <optional>

namespace scc::compiler {

namespace {

constexpr std::string_view opening = R"py(A scene for Blender 3.4 and Cycles, exported by scc.

  blender -b --factory-startup --python-exit-code 1 -P THIS.py -- --render image.exr --size 640x480

draws it; `-- --help` tells the options. To look at it in Blender: open this file in the Text editor, Run Script, then
F12. Running it again replaces what it made and nothing else. The picture of the exact look belongs to the camera and
the size below: change them here, not in Blender.
"""
import argparse
#: packed
import base64
#: end
import collections
import functools
import hashlib
import math
import os
import sys

import bpy
import mathutils
import numpy as np

)py";

} // namespace

std::string emit_blender(const ir::Scene& whole, Ledger& ledger) {
    std::optional<ir::Scene> resolved = whole.traits.uv ? std::optional(resolve_uv(whole)) : std::nullopt;
    if (whole.traits.functions) {
        resolved = with_lattices(resolved ? *resolved : whole);
    }
    if (whole.traits.bump) {
        ResolvedBumps bumps = resolve_bumps(resolved ? *resolved : whole, BumpForm::world_slope);
        for (const std::uint32_t material : bumps.flat) {
            const ir::Material& flat = bumps.scene.materials[material];
            ledger.push_back(
                {Fidelity::dropped, "phong bump", flat.name, flat.span,
                 "its slope has no formula where it reads the coordinates of a mesh or `noise` whose "
                 "arguments have no bounds, or too wide ones",
                 0});
        }
        resolved = std::move(bumps.scene);
    }
    const ir::Scene& scene = resolved ? *resolved : whole;
    BlenderNeeds needs = blender_needs(scene);
    if (needs_packing(scene, needs)) {
        needs.features.emplace("packed");
    }
    Writer out;
    write_blender_scene(out, scene, needs);
    record_blender(scene, needs, ledger);
    return "\"\"\"" + select_features(opening, needs.features) + out.take() + "\n\n" +
           blender_library(needs.features);
}

} // namespace scc::compiler
