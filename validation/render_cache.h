#pragma once

#include "runtime/host/cache.h"
#include "validation/renderers.h"
#include "validation/subprocess.h"

#include <optional>
#include <string>

/// Pictures of other renderers, which need not draw again what they have drawn.
namespace scc::validation {

class RenderCache {
public:
    /// Nothing is ever found or kept.
    RenderCache() = default;
    explicit RenderCache(host::Cache cache) : cache_(std::move(cache)) {}
    /// `text`: "off", a folder, which is made if need be, or nothing, which means the user's (see
    /// host::Cache). Throws host::FileError where the folder cannot be made.
    static RenderCache from_option(const std::string& text);

    bool keeps() const { return cache_.keeps(); }
    /// What was drawn with this key; its `from_cache` is set, and its times are those of then.
    std::optional<RenderResult> find(const std::string& key) const;
    /// Keeps it if it is done; a failure may have had a reason that has gone.
    void store(const std::string& key, const RenderResult& result) const;

private:
    host::Cache cache_;
};

/// Depends on the renderer (its program's path and version), its whole command line (the picture's size,
/// samples, exposure and threads), and the content of the exported scene and of the files beside it.
std::string render_key(const RenderJob& job, const Command& command, const std::string& version);

} // namespace scc::validation
