#pragma once

#include "compiler/backends/function_range.h"
#include "compiler/backends/table.h"
#include "compiler/writer.h"

#include <array>
#include <string>
#include <string_view>

namespace scc::compiler {

/// `noise` and `random` as SDL functions of a density file beside the export, which holds what our integer
/// hash gives at whole numbers, in 32 bits; POV-Ray has other noise. Between whole numbers noise is blended
/// by its own curve: POV-Ray interpolates linearly, from where the curve puts the point.
class PovLattices {
public:
    PovLattices(ExportFiles& files, Writer& out) : files_(files), out_(out) {}

    /// What 32 bits make of a value in 0..1, at most.
    static constexpr double error = 0x1p-33;
    /// A density file has no more points.
    static constexpr double most_points = 4e6;

    /// Writes a function of three numbers within these ranges and returns its name; "" where they are too
    /// wide for a file. `random` is that of whole numbers.
    std::string declare(std::string_view name, ir::Op op, const std::array<Range, 3>& ranges);

private:
    ExportFiles& files_;
    Writer& out_;
    Identifiers names_{"hash_"};
    bool has_curve_ = false;
};

} // namespace scc::compiler
