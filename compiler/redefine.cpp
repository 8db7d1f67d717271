#include "compiler/redefine.h"

#include "compiler/backends/cpp.h"
#include "compiler/pipeline.h"
#include "compiler/program_scene.h"
#include "runtime/host/options.h"

namespace scc::compiler {

std::string redefine(const host::Redefinition& wanted) {
    const ProgramScene kept = unpack(wanted.scene);
    SceneOptions options{.file = kept.file,
                         .definitions = kept.definitions,
                         .asset_paths = wanted.asset_paths,
                         .camera = kept.camera,
                         .method = kept.method,
                         .frame = kept.frame,
                         .texts = &kept.texts,
                         .only_texts = true};
    options.definitions.insert(options.definitions.end(), wanted.definitions.begin(),
                               wanted.definitions.end());
    const Loaded loaded = load(options, Stage::scene);
    if (!report(loaded)) {
        throw host::SceneError("the scene is wrong with these values");
    }
    const Precision precision =
        wanted.precision == name_of(Precision::single) ? Precision::single : Precision::full;
    const ProgramParameters parameters = parameters_of(loaded, options);
    CppProgram program =
        emit_cpp(loaded.scene, precision, Numbers::as_values, "", &parameters, wanted.draws_aovs);
    if (program.structure != wanted.structure) {
        throw host::UsageError(
            "with these values the scene needs other code than this program has; `scc build` "
            "with the same -D makes a program that has it");
    }
    return std::move(program.values);
}

} // namespace scc::compiler
