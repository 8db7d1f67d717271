#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/table.h"
#include "lang/source.h"
#include "validation/report.h"

#include <filesystem>
#include <vector>

namespace scc::cli {

/// Writes the files that lie in the folder of an export.
void write_beside(const std::filesystem::path& folder, const compiler::ExportFiles& beside);

/// The ledger with places in words.
std::vector<validation::LedgerRow> ledger_rows(const compiler::Ledger& ledger,
                                               const lang::SourceSet& sources);

} // namespace scc::cli
