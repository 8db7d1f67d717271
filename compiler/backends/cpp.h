#pragma once

#include "compiler/backends/precision.h"
#include "compiler/ir/scene.h"

#include <string>

namespace scc::compiler {

/// A program that draws one scene: data and one type over the runtime's headers.
struct CppProgram {
    std::string source;
    std::string
        blob; ///< large tables and meshes as bytes, which the source takes in by `.incbin`; may be empty
};

/// `blob_name`: the name under which the blob will lie beside the source. Its letters, digits, `_`, `-` and
/// `.` only.
CppProgram emit_cpp(const ir::Scene& scene, Precision precision, const std::string& blob_name);

} // namespace scc::compiler
