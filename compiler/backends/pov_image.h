#pragma once

#include "compiler/backends/table.h"
#include "compiler/ir/image.h"
#include "compiler/writer.h"

#include <map>
#include <string>

namespace scc::compiler {

/// Images as SDL functions of their pigments, each with a PNG file beside the export. An 8-bit image keeps
/// its codes; another one is stretched to 16 bits between its least and its greatest value.
class PovImages {
public:
    PovImages(ExportFiles& files, Writer& out) : files_(files), out_(out) {}

    struct Declared {
        std::string name;         ///< of a vector function of the unit square
        double low = 0, span = 1; ///< a channel is low + span times what the function gives
        double error = 0;         ///< of that, at most
        const ir::Image* image = nullptr;

        /// A channel at (u, v), both expressions.
        std::string channel(std::uint32_t which, const std::string& u, const std::string& v) const;
    };
    /// Writes it when it is first used.
    const Declared& declare(const ir::Image& image);

private:
    ExportFiles& files_;
    Writer& out_;
    Identifiers names_{"image_"};
    std::map<const ir::Image*, Declared> declared_;
};

} // namespace scc::compiler
