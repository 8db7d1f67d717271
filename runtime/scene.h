#pragma once

#include "runtime/camera.h"
#include "runtime/light.h"
#include "runtime/material.h"
#include "runtime/math/affine.h"
#include "runtime/shapes/list.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace scc::runtime {

/// What a scene needs. A kernel compiled for a scene contains nothing else; the generic renderer uses `everything`.
struct SceneTraits {
    std::uint32_t bare_shapes = 0;   ///< bit per row of Shapes: present without a transform
    std::uint32_t placed_shapes = 0; ///< bit per row of Shapes: present with a transform
    bool point_lights = false;
    bool directional_lights = false;
    bool attenuation = false;      ///< some point light has kl or kq other than 0, or kc other than 1
    bool separate_specular = false; ///< some light has Is other than Id
    bool specular = false;         ///< some material has a highlight
    bool emission = false;
    bool reflection = false;
    bool two_sided = false;        ///< some shape has a back material of its own
    bool functions = false;        ///< some material field is a per-point function
    bool smooth_normals = false;   ///< some triangle or mesh has vertex normals
    bool shadows = false;
    bool accelerator = false;      ///< enough bounded shapes that a hierarchy over them pays
    bool perspective = false;
    bool orthographic = false;

    friend constexpr bool operator==(const SceneTraits&, const SceneTraits&) = default;
};

inline constexpr SceneTraits everything{~0U, ~0U, true, true, true, true, true, true,
                                        true, true, true, true, true, true, true, true};

/// What every shape in a scene carries.
struct Tag {
    std::uint32_t id = 0; ///< order in the source; of two hits at equal distance the smaller id counts
    Sides sides{};
};

/// A shape given in world coordinates.
template <class Shape>
struct Bare {
    Shape shape{};
    Tag tag{};
};

/// A shape given in its own coordinates, with the map to the world (L13).
template <class Shape, class R>
struct Placed {
    Shape shape{};
    Affine<R> world_from_object{};
    Affine<R> object_from_world{};
    Tag tag{};
};

/// The picture's settings that a scene states and a command line may override.
struct RenderSettings {
    int width = 800;
    int height = 600;
    int samples_per_axis = 1; ///< n of n x n sub-pixel centres
    int depth = 5;            ///< mirror bounces
    bool shadows = true;
};

} // namespace scc::runtime
