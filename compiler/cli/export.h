#pragma once

#include "compiler/backends/ledger.h"
#include "lang/source.h"
#include "validation/report.h"

#include <vector>

namespace scc::cli {

/// The ledger with places in words.
std::vector<validation::LedgerRow> ledger_rows(const compiler::Ledger& ledger,
                                               const lang::SourceSet& sources);

} // namespace scc::cli
