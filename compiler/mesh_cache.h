#pragma once

#include "compiler/mesh_file.h"
#include "runtime/accel/build.h"
#include "runtime/host/cache.h"

#include <filesystem>
#include <memory>

/// Meshes and their hierarchies as an earlier run made them. What is kept goes by the file's content, so it
/// does not matter where the file lies or when it was written.
namespace scc::compiler {

/// load_obj, unless the cache has what it gave for this content; small files are read each time.
LoadedMesh load_mesh(const std::filesystem::path& path, MeshNormals normals, const host::Cache& cache);

/// A mesh as the kernels read it.
struct BuiltMesh {
    runtime::MeshData data;
    std::shared_ptr<const void> owner; ///< of what `data` points to
};

/// The hierarchy over the mesh, unless its cache has it. The same bits either way.
BuiltMesh build_mesh(const ir::Mesh& mesh, const runtime::BuildOptions& options);

} // namespace scc::compiler
