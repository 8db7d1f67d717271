#pragma once

#include "compiler/ir/scene.h"
#include "compiler/lower.h"
#include "compiler/mesh_cache.h"
#include "lang/diagnostic.h"
#include "lang/rows.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

namespace scc::compiler {

/// Gives the meshes of a scene their places in the IR's table. What several things show is stored once.
class MeshTable {
public:
    MeshTable(const LowerOptions& options, ir::Scene& scene, lang::Diagnostics& diagnostics)
        : options_(options), scene_(scene), diagnostics_(diagnostics) {}

    /// Of a `mesh`: a file, or one part of it. None: it has been said why.
    std::optional<std::uint32_t> of_file(const lang::Thing& mesh);
    /// Of a `heightfield`, under this name; one value is one mesh. None: it has been said why.
    std::optional<std::uint32_t> of_heights(const lang::Thing& heightfield, const std::string& name);
    /// Where a mesh is open, in words; empty: it is closed. Each mesh is looked at once.
    const std::string& opening(std::uint32_t mesh);

private:
    /// Folder and name of a file.
    using FileKey = std::tuple<std::filesystem::path, std::string, MeshNormals>;
    /// And which part of it, with texture coordinates or without.
    using MeshKey = std::tuple<FileKey, std::string, bool>;

    const LoadedMesh* file(const FileKey& key, lang::Span place);
    std::optional<LoadedMesh> load(const FileKey& key, lang::Span place);
    std::optional<ir::Mesh> part(const LoadedMesh& whole, const lang::Thing& mesh);
    std::optional<std::uint32_t> make_heights(const lang::Thing& heightfield, const std::string& name);
    std::uint32_t add(ir::Mesh mesh);

    const LowerOptions& options_;
    ir::Scene& scene_;
    lang::Diagnostics& diagnostics_;
    std::map<FileKey, std::optional<LoadedMesh>> files_;
    std::map<MeshKey, std::optional<std::uint32_t>> meshes_;
    std::map<const lang::Thing*, std::optional<std::uint32_t>> heightfields_;
    std::map<std::uint32_t, std::string> openings_;
    std::set<std::string> names_;
    std::optional<host::Cache> cache_; ///< once a mesh asks for it
};

} // namespace scc::compiler
