#pragma once

#include "compiler/assets.h"
#include "compiler/ir/image.h"
#include "lang/diagnostic.h"
#include "lang/image_source.h"
#include "lang/source.h"

#include <map>
#include <memory>

namespace scc::compiler {

/// The files behind a scene's `image { }`s, each read when it is first looked up. What is wrong with one is
/// reported then, and not again.
class ImageTable : public lang::ImageSource {
public:
    ImageTable(AssetPolicy policy, const lang::SourceSet& sources, lang::Diagnostics& diagnostics)
        : policy_(std::move(policy)), sources_(sources), diagnostics_(diagnostics) {}

    std::optional<std::array<double, 3>> color(const lang::ThingPtr& image, double u, double v) override;
    /// Null if it cannot be read.
    std::shared_ptr<const ir::Image> find(const lang::ThingPtr& image);

private:
    std::shared_ptr<const ir::Image> load(const lang::Thing& image);

    AssetPolicy policy_;
    const lang::SourceSet& sources_;
    lang::Diagnostics& diagnostics_;
    std::map<lang::ThingPtr, std::shared_ptr<const ir::Image>> images_;
    std::map<std::string, std::shared_ptr<const ir::Image>> by_key_;
};

} // namespace scc::compiler
