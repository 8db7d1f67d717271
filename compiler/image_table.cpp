#include "compiler/image_table.h"

#include "compiler/image_file.h"
#include "compiler/values.h"

#include <fmt/core.h>

namespace scc::compiler {

using lang::Diag;

std::optional<std::array<double, 3>> ImageTable::color(const lang::ThingPtr& image, double u, double v) {
    const std::shared_ptr<const ir::Image> found = find(image);
    if (!found) {
        return std::nullopt;
    }
    const auto channel = [&](std::uint32_t i) { return runtime::image_channel(found->data, i, u, v); };
    return std::array{channel(0), channel(1), channel(2)};
}

std::shared_ptr<const ir::Image> ImageTable::find(const lang::ThingPtr& image) {
    const auto [place, is_new] = images_.try_emplace(image);
    if (is_new) {
        place->second = load(*image);
    }
    return place->second;
}

std::shared_ptr<const ir::Image> ImageTable::load(const lang::Thing& image) {
    const lang::Span place = place_of(image, "file");
    const std::string& file = to_text(*image.get("file"));
    const std::string quoted = fmt::format("`{}`", file);
    const std::filesystem::path folder =
        std::filesystem::path(sources_.file(place.file).path()).parent_path();
    const Asset asset = find_asset(policy_, folder, file);
    if (asset.status == AssetStatus::outside) {
        diagnostics_.report(Diag::asset_outside, place, quoted);
        return nullptr;
    }
    if (asset.status == AssetStatus::missing) {
        diagnostics_.report(Diag::missing_asset, place, quoted,
                            "there is no such file in the scene's folder");
        return nullptr;
    }
    const auto is = [&](std::string_view field, std::string_view choice) {
        return to_text(*image.get(field)) == choice;
    };
    try {
        LoadedImage loaded =
            load_image(asset.path, is("encoding", "srgb") ? ImageEncoding::srgb : ImageEncoding::linear,
                       is("wrap", "repeat") ? runtime::Wrap::repeat : runtime::Wrap::clamp,
                       is("filter", "bilinear") ? runtime::Filter::bilinear : runtime::Filter::nearest);
        if (loaded.holds_floats && image.find("encoding") != nullptr && is("encoding", "srgb")) {
            diagnostics_.report(Diag::linear_image, place_of(image, "encoding"), quoted);
        }
        const auto [known, is_new] = by_key_.try_emplace(loaded.image.key);
        if (is_new) {
            known->second = std::make_shared<const ir::Image>(std::move(loaded.image));
        }
        return known->second;
    } catch (const ImageError& error) {
        diagnostics_.report(Diag::broken_image, place, quoted, error.what());
        return nullptr;
    }
}

} // namespace scc::compiler
