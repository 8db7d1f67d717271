#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/table.h"
#include "runtime/render_request.h"
#include "validation/renderers.h"

#include <filesystem>

namespace scc::cli {

/// Exports the scene into the folder and has the other renderer draw it there, with the request's settings.
/// `brightest`: the largest value that the picture has. Throws Interrupted.
validation::RenderResult run_renderer(const compiler::Exporter& exporter, const compiler::ir::Scene& scene,
                                      const runtime::RenderRequest& request,
                                      const std::filesystem::path& folder, double brightest,
                                      double timeout_seconds, compiler::Ledger& ledger);

} // namespace scc::cli
