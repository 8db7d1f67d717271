#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/pov_function.h"
#include "compiler/backends/pov_texture.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace scc::compiler {

/// The scene's materials as declared textures, each written when an object first needs it.
class PovMaterials {
public:
    /// Only on meshes do the materials' functions read uv (see resolve_uv.h).
    /// `scale`: by which the world is written larger (see pov_frame.h).
    PovMaterials(const ir::Scene& scene, double scale, ExportFiles& files, Writer& functions,
                 Writer& textures, Ledger& ledger);

    struct Use {
        std::string texture;
        bool varies = false;   ///< it depends on x, y, z
        bool in_world = false; ///< which are world coordinates, not the object's
        bool by_uv = false;    ///< it depends on uv as x and y
    };
    Use use(std::uint32_t material, const ir::Object& object);

    PovFunctions& functions() { return functions_; }

private:
    Use declare(std::uint32_t material, const std::string& name,
                const runtime::Affine<double>* world_from_object);
    Paint color(const runtime::Varying<runtime::Rgb<double>>& value, std::string_view field,
                std::uint32_t material, const runtime::Affine<double>* world_from_object);
    Paint shininess(const runtime::Varying<double>& value, std::uint32_t material,
                    const runtime::Affine<double>* world_from_object);
    std::string normal(std::int32_t bump, std::uint32_t material,
                       const runtime::Affine<double>* world_from_object);
    std::pair<Paint, Fidelity> paint(std::int32_t function, std::string_view field, std::uint32_t material,
                                     double largest, const runtime::Affine<double>* world_from_object);
    void note(std::uint32_t material, std::string_view feature, const Outcome& outcome);

    const ir::Scene& scene_;
    double scale_;
    PovFunctions functions_;
    PovTextures textures_;
    Ledger& ledger_;
    std::vector<InputRanges> ranges_; ///< per material, over the objects that have it
    std::map<std::uint32_t, Use> shared_;
    std::vector<bool> noted_; ///< per material: the ledger has it
};

} // namespace scc::compiler
