#include "compiler/program_scene.h"

#include "compiler/pipeline.h"
#include "runtime/host/values.h"

#include <filesystem>

namespace scc::compiler {

namespace fs = std::filesystem;

ProgramScene program_scene(const Loaded& loaded, const SceneOptions& options) {
    const fs::path folder = fs::path(options.file).lexically_normal().parent_path();
    ProgramScene scene{.file = fs::path(options.file).filename().string(),
                       .texts = {},
                       .definitions = options.definitions,
                       .camera = options.camera,
                       .method = loaded.scene.settings.method,
                       .frame = {}};
    if (loaded.module.frames) {
        scene.frame = loaded.module.frames->chosen;
    }
    for (lang::FileId id = 0; loaded.sources.contains(id); ++id) {
        const lang::SourceFile& file = loaded.sources.file(id);
        const fs::path path = fs::path(file.path()).lexically_normal().lexically_relative(folder);
        const bool within = !path.empty() && *path.begin() != "..";
        scene.texts.emplace((within ? path : fs::path(file.path()).filename()).string(), file.text());
    }
    return scene;
}

std::string pack(const ProgramScene& scene) {
    host::ValuesWriter values;
    const auto add_count = [&](std::size_t count) { values.add(static_cast<std::uint64_t>(count)); };
    values.add_text(scene.file);
    values.add_text(scene.camera);
    values.add(scene.method);
    add_count(scene.frame ? 1 : 0);
    values.add(scene.frame.value_or(0));
    add_count(scene.texts.size());
    for (const auto& [path, text] : scene.texts) {
        values.add_text(path);
        values.add_text(text);
    }
    add_count(scene.definitions.size());
    for (const std::string& definition : scene.definitions) {
        values.add_text(definition);
    }
    return values.take_unsealed();
}

ProgramScene unpack(std::string_view packed) {
    host::Values values = host::Values::unsealed(packed, "this program");
    const auto read_count = [&] {
        std::uint64_t count = 0;
        values.read(count);
        return count;
    };
    ProgramScene scene;
    scene.file = values.read_text();
    scene.camera = values.read_text();
    values.read(scene.method);
    const bool has_frame = read_count() != 0;
    std::int64_t frame = 0;
    values.read(frame);
    scene.frame = has_frame ? std::optional(frame) : std::nullopt;
    for (std::uint64_t left = read_count(); left > 0; --left) {
        std::string path = values.read_text();
        scene.texts.emplace(std::move(path), values.read_text());
    }
    for (std::uint64_t left = read_count(); left > 0; --left) {
        scene.definitions.push_back(values.read_text());
    }
    return scene;
}

ProgramParameters parameters_of(const Loaded& loaded, const SceneOptions& options) {
    ProgramParameters parameters{.scene = pack(program_scene(loaded, options)), .listing = {}};
    for (const lang::Param& param : loaded.module.params) {
        parameters.listing += "  " + described(param) + "\n";
    }
    return parameters;
}

} // namespace scc::compiler
