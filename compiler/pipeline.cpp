#include "compiler/pipeline.h"

#include "compiler/file_importer.h"
#include "compiler/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/place_scene.h"
#include "compiler/scene_checks.h"
#include "compiler/schema.h"
#include "lang/parser.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <fmt/core.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace scc::compiler {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t largest_text_file = compiler::largest_scene_file;

} // namespace

std::string read_text_file(const std::string& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) {
        throw host::FileError(fmt::format("cannot read `{}`: there is no such file", path));
    }
    if (fs::is_directory(status)) {
        throw host::FileError(fmt::format("cannot read `{}`: it is a folder", path));
    }
    if (fs::is_regular_file(status) && fs::file_size(path, error) > largest_text_file) {
        throw host::FileError(fmt::format("cannot read `{}`: it is larger than 1 GiB", path));
    }
    std::ifstream stream(path, std::ios::binary);
    std::string text;
    constexpr std::size_t piece = std::size_t{1} << 22; // a pipe does not say how much it holds
    for (std::size_t size = fs::is_regular_file(status) ? fs::file_size(path, error) + 1 : piece;
         stream.good(); size = piece) {
        const std::size_t begin = text.size();
        text.resize(begin + size);
        stream.read(text.data() + begin, static_cast<std::streamsize>(size));
        text.resize(begin + static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.is_open() || stream.bad()) {
        throw host::FileError(fmt::format("cannot read `{}`", path));
    }
    return text;
}

namespace {

std::vector<lang::Definition> parse_definitions(const std::vector<std::string>& texts) {
    std::vector<lang::Definition> definitions;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos) {
            throw host::UsageError(fmt::format("`-D {}` is not name=value", text));
        }
        definitions.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    return definitions;
}

AssetPolicy asset_policy(const SceneOptions& options, const std::vector<lang::Definition>& definitions,
                         FoundFiles found) {
    AssetPolicy policy;
    policy.found = std::move(found);
    policy.scene_folder = fs::path(options.file).parent_path();
    policy.asset_paths.assign(options.asset_paths.begin(), options.asset_paths.end());
    for (const lang::Definition& definition : definitions) {
        policy.named_by_user.insert(definition.value);
    }
    return policy;
}

LowerOptions lower_options(const SceneOptions& options, const std::vector<lang::Definition>& definitions,
                           const Loaded& loaded) {
    LowerOptions result;
    result.name = fs::path(options.file).stem().string();
    result.camera = options.camera;
    result.method = options.method;
    result.keep_meshes = options.keep_meshes;
    result.assets = asset_policy(options, definitions, loaded.assets);
    for (const lang::FileId file : loaded.module.imports) {
        result.import_folders[file] = fs::path(loaded.sources.file(file).path()).parent_path();
    }
    return result;
}

// Of a scene that has mistakes, what has none is lowered for the mistakes that only show there. What depends
// on the scene as a whole is not to be trusted: a camera or a light may be among what is left out.
void lower_the_rest(Loaded& loaded, const LowerOptions& options) {
    lang::Diagnostics found;
    lower(loaded.module, options, found);
    for (const lang::Diagnostic& diagnostic : found.sorted()) {
        if (diagnostic.severity != lang::Severity::note && diagnostic.kind != lang::Diag::unknown_camera) {
            loaded.diagnostics.add(diagnostic);
        }
    }
}

void check_frame(const SceneOptions& options, Loaded& loaded) {
    const std::optional<lang::Frames>& frames = loaded.module.frames;
    if (!frames && options.frame && !loaded.diagnostics.has_errors()) {
        throw host::UsageError("the scene has no frames; its `render` has no `frames`");
    }
    if (frames && (frames->chosen < frames->begin || frames->chosen >= frames->end)) {
        throw host::UsageError(fmt::format("there is no frame {}; the scene has the frames {}..{}, the last "
                                           "one excluded",
                                           frames->chosen, frames->begin, frames->end));
    }
    if (frames && !options.frame && options.tells_frame) {
        loaded.diagnostics.report(lang::Diag::one_frame, lang::Span{}, frames->begin, frames->end,
                                  frames->chosen);
    }
}

std::string read_text(const SceneOptions& options, const std::string& path) {
    if (options.texts != nullptr) {
        if (const auto found = options.texts->find(path); found != options.texts->end()) {
            return found->second;
        }
    }
    return read_text_file(path);
}

// Runs one stage and notes how long it took.
template <class Run>
void timed(Loaded& loaded, const char* stage, Run run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::milli> gone = std::chrono::steady_clock::now() - start;
    loaded.times_ms.emplace_back(stage, gone.count());
}

} // namespace

std::unique_ptr<lang::Importer> make_importer(const SceneOptions& options, FoundFiles found) {
    if (options.only_texts) {
        return std::make_unique<TextImporter>(*options.texts);
    }
    return std::make_unique<FileImporter>(asset_policy(options, {}, std::move(found)));
}

Loaded load(const SceneOptions& options, Stage last) {
    Loaded loaded;
    const std::vector<lang::Definition> definitions = parse_definitions(options.definitions);
    timed(loaded, "parse", [&] {
        const lang::FileId file = loaded.sources.add(options.file, read_text(options, options.file));
        if (last >= Stage::module) {
            loaded.tree = lang::read_file(loaded.sources, file, loaded.diagnostics);
            return;
        }
        loaded.tokens = lang::lex(loaded.sources, file, loaded.diagnostics);
        if (last != Stage::tokens) {
            loaded.tree = std::make_shared<const lang::ast::File>(
                lang::parse(loaded.sources, file, loaded.tokens, loaded.diagnostics));
        }
    });
    if (last < Stage::module) {
        return loaded;
    }
    ImageTable images(asset_policy(options, definitions, loaded.assets), loaded.sources, loaded.diagnostics);
    timed(loaded, "check", [&] {
        const std::unique_ptr<lang::Importer> importer = make_importer(options, loaded.assets);
        loaded.module = lang::check(loaded.tree, scene_schema(), definitions, loaded.sources,
                                    loaded.diagnostics, {}, importer.get(), options.frame, &images);
    });
    check_frame(options, loaded);
    if (last < Stage::lowered) {
        return loaded;
    }
    timed(loaded, "lower", [&] {
        LowerOptions lowering = lower_options(options, definitions, loaded);
        lowering.images = &images;
        if (loaded.diagnostics.has_errors()) {
            lower_the_rest(loaded, lowering);
        } else {
            loaded.scene = lower(loaded.module, lowering, loaded.diagnostics);
            std::optional<ir::Scene> as_drawn; // which the checks are about
            if (last == Stage::lowered) {
                as_drawn = loaded.scene;
            }
            ir::Scene& drawn = as_drawn ? *as_drawn : loaded.scene;
            recenter(drawn);
            check_scene(loaded.module, drawn, loaded.diagnostics);
        }
    });
    if (last > Stage::lowered && !loaded.diagnostics.has_errors()) {
        timed(loaded, "passes", [&] { run_passes(loaded.scene); });
    }
    return loaded;
}

bool report(const Loaded& loaded) {
    const char* no_color = std::getenv("NO_COLOR");
    const bool color = isatty(STDERR_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
    std::string text;
    std::size_t errors = 0;
    for (const lang::Diagnostic& diagnostic : loaded.diagnostics.sorted()) {
        text += lang::render_text(loaded.sources, diagnostic, color);
        errors += diagnostic.severity == lang::Severity::error ? 1 : 0;
    }
    for (const std::string& print : loaded.module.prints) {
        text += print + "\n";
    }
    if (errors > 0) {
        text += fmt::format("{} error{}\n", errors, errors == 1 ? "" : "s");
    }
    fmt::print(stderr, "{}", text);
    return !loaded.diagnostics.has_errors();
}

std::string described(const lang::Param& param) {
    std::string text = fmt::format("{}: {} = {}", param.name, lang::to_string(param.type),
                                   lang::to_string(param.default_value));
    if (param.range) {
        text += fmt::format(" in {}..{}", param.range->first, param.range->second);
    }
    return text + (param.text.empty() ? "" : fmt::format("  // {}", param.text));
}

} // namespace scc::compiler
