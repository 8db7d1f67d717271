#include "compiler/lower_mesh.h"

#include "compiler/function_builder.h"
#include "compiler/heightfield.h"
#include "compiler/shape_rules.h"
#include "compiler/values.h"

#include <fmt/core.h>

#include <functional>
#include <utility>
#include <vector>

namespace scc::compiler {

using lang::Diag;
using lang::Thing;

std::optional<std::uint32_t> MeshTable::of_file(const Thing& mesh) {
    static const std::map<std::string, MeshNormals, std::less<>> kinds{
        {"file", MeshNormals::file}, {"smooth", MeshNormals::smooth}, {"flat", MeshNormals::flat}};
    const lang::Span place = place_of(mesh, "file");
    const auto folder = options_.import_folders.find(place.file); // of the file in which the mesh is written
    const FileKey key{folder == options_.import_folders.end() ? options_.assets.scene_folder : folder->second,
                      to_text(*mesh.get("file")), kinds.at(to_text(*mesh.get("normals")))};
    const bool with_uv = to_bool(*mesh.get("uv"));
    auto [known, is_new] = meshes_.try_emplace({key, to_text(*mesh.get("part")), with_uv});
    if (!is_new) {
        return known->second;
    }
    if (const LoadedMesh* whole = file(key, place)) {
        if (std::optional<ir::Mesh> found = part(*whole, mesh)) {
            if (!with_uv) {
                found->uvs = {};
                found->uv_indices = {};
            }
            known->second = add(std::move(*found));
        }
    }
    return known->second;
}

const LoadedMesh* MeshTable::file(const FileKey& key, lang::Span place) {
    auto [known, is_new] = files_.try_emplace(key);
    if (is_new) {
        known->second = load(key, place);
    }
    return known->second ? &*known->second : nullptr;
}

std::optional<LoadedMesh> MeshTable::load(const FileKey& key, lang::Span place) {
    const auto& [folder, file, normals] = key;
    const std::string quoted = fmt::format("`{}`", file);
    const Asset asset = find_asset(options_.assets, folder, file);
    if (asset.status == AssetStatus::outside) {
        diagnostics_.report(Diag::asset_outside, place, quoted);
        return std::nullopt;
    }
    if (asset.status == AssetStatus::missing) {
        diagnostics_.report(Diag::missing_asset, place, quoted,
                            "there is no such file in the scene's folder");
        return std::nullopt;
    }
    try {
        if (options_.keep_meshes && !cache_) {
            cache_ = host::Cache::of_user();
        }
        LoadedMesh loaded = load_mesh(asset.path, normals, cache_.value_or(host::Cache()));
        for (const std::string& warning : loaded.warnings) {
            diagnostics_.report(Diag::suspect_mesh, place, quoted, warning);
        }
        return loaded;
    } catch (const MeshError& error) {
        diagnostics_.report(Diag::broken_mesh, place, quoted, error.what());
        return std::nullopt;
    }
}

/// All of it, unless the thing says otherwise.
std::optional<ir::Mesh> MeshTable::part(const LoadedMesh& whole, const Thing& mesh) {
    const std::string& wanted = to_text(*mesh.get("part"));
    if (wanted.empty()) {
        return whole.mesh;
    }
    try {
        return select_part(whole, wanted);
    } catch (const MeshError& error) {
        diagnostics_.report(Diag::broken_mesh, place_of(mesh, "part"),
                            fmt::format("`{}`", to_text(*mesh.get("file"))), error.what());
        return std::nullopt;
    }
}

std::uint32_t MeshTable::add(ir::Mesh mesh) {
    const std::string wanted = mesh.name;
    for (int i = 2; !names_.insert(mesh.name).second; ++i) {
        mesh.name = fmt::format("{} {}", wanted, i);
    }
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
}

std::optional<std::uint32_t> MeshTable::of_heights(const Thing& heightfield, const std::string& name) {
    auto [known, is_new] = heightfields_.try_emplace(&heightfield);
    if (is_new) {
        known->second = make_heights(heightfield, name);
    }
    return known->second;
}

std::optional<std::uint32_t> MeshTable::make_heights(const Thing& heightfield, const std::string& name) {
    const lang::FieldValue& field = *heightfield.find("field");
    FunctionBuilder builder(options_.images);
    const std::vector<lang::Scalar> results = lang::trace_at_pair(std::get<lang::ClosurePtr>(field.value.v),
                                                                  builder, diagnostics_, options_.images);
    if (results.size() != 1) {
        return std::nullopt;
    }
    const auto& size = std::get<lang::Vec2Value>(heightfield.get("size")->v).v;
    const auto& cells = std::get<lang::Vec2Value>(heightfield.get("cells")->v).v;
    HeightfieldMesh made = heightfield_mesh(
        name, builder.finish(results),
        {size[0].value, size[1].value, to_number(*heightfield.get("height")),
         static_cast<std::size_t>(cells[0].value), static_cast<std::size_t>(cells[1].value)});
    if (made.bad) {
        diagnostics_.report(Diag::not_finite, field.value_span,
                            fmt::format("the height at ({:.6g}, {:.6g})", made.bad->u, made.bad->v),
                            fmt::format("{:.6g}", made.bad->value));
        return std::nullopt;
    }
    return add(std::move(made.mesh));
}

const std::string& MeshTable::opening(std::uint32_t mesh) {
    const auto [known, is_new] = openings_.try_emplace(mesh);
    if (is_new) {
        known->second = open_part(scene_.meshes[mesh]);
    }
    return known->second;
}

} // namespace scc::compiler
