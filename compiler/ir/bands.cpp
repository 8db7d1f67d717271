#include "compiler/ir/bands.h"

namespace scc::compiler::ir {

Scene band_scene(const Scene& scene, std::size_t band) {
    Scene result = scene;
    for (Material& material : result.materials) {
        material.phong = material.bands[band];
        material.bands.clear();
    }
    for (Light& light : result.lights) {
        std::visit(
            [&](auto& l) {
                l.diffuse = light.bands[band].diffuse;
                l.specular = light.bands[band].specular;
            },
            light.light);
        light.bands.clear();
    }
    result.ambient = scene.bands[band].ambient;
    result.background = scene.bands[band].background;
    result.bands.clear();
    return result;
}

} // namespace scc::compiler::ir
