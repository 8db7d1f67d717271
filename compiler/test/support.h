#pragma once

#include "compiler/backends/pov.h"
#include "compiler/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/schema.h"
#include "lang/check.h"
#include "lang/parser.h"

#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace scc::compiler::test {

/// A scene's text on its way through the stages, and what was reported on it.
struct Compiled {
    ir::Scene scene;
    std::string messages; ///< all diagnostics as text
    bool fine = false;
};

inline Compiled compile(std::string text, LowerOptions options = {}) {
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    const lang::FileId file = sources.add("test.scn", std::move(text));
    const auto tree = lang::parse_file(sources, file, diagnostics);
    Compiled result;
    if (!diagnostics.has_errors()) {
        const lang::Module module = lang::check(tree, scene_schema(), {}, sources, diagnostics);
        if (!diagnostics.has_errors()) {
            if (options.name.empty()) {
                options.name = "test";
            }
            result.scene = lower(module, options, diagnostics);
        }
    }
    result.fine = !diagnostics.has_errors();
    for (const lang::Diagnostic& diagnostic : diagnostics.sorted()) {
        result.messages += lang::render_text(sources, diagnostic, false);
    }
    return result;
}

/// With a camera and a light, so that nothing is said about their absence.
inline Compiled compile_shapes(const std::string& shapes) {
    return compile(shapes + "\nperspective_camera { }\npoint_light { position = (0, 5, 5) }\n");
}

/// The export to POV-Ray of a scene without images.
inline std::string emit_pov(const ir::Scene& scene, Ledger& ledger,
                            const lang::SourceSet* sources = nullptr) {
    ExportFiles files{.stem = "scene"};
    return compiler::emit_pov(scene, ledger, files, sources);
}

} // namespace scc::compiler::test
