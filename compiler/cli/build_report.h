#pragma once

#include "compiler/backends/precision.h"
#include "compiler/cli/native.h"
#include "compiler/pipeline.h"

#include <string>

namespace scc::cli {

enum class ReportKind { text, json };

/// What a built program holds and leaves out, and what that saves: measured on this scene, beside the generic
/// renderer and beside a program that leaves nothing out.
std::string build_report(const compiler::Loaded& loaded, const compiler::PrecisionChoice& precision,
                         const NativeOptions& options, const std::string& program, ReportKind kind);

} // namespace scc::cli
