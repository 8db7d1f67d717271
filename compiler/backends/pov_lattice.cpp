#include "compiler/backends/pov_lattice.h"

#include "runtime/math/noise.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>

namespace scc::compiler {

namespace {

struct Lattice {
    std::array<double, 3> first{};
    std::array<double, 3> size{}; ///< in points
};

/// All points about the ranges, which rounding may leave by a little.
Lattice around(const std::array<Range, 3>& ranges) {
    Lattice lattice;
    for (std::size_t i = 0; i < 3; ++i) {
        const double slack = 1e-6 * (1 + std::abs(ranges[i].min) + std::abs(ranges[i].max));
        lattice.first[i] = std::floor(ranges[i].min - slack);
        lattice.size[i] = std::floor(ranges[i].max + slack) + 2 - lattice.first[i];
    }
    return lattice;
}

template <class Unsigned>
void append_big_endian(std::string& bytes, Unsigned value) {
    for (std::size_t i = sizeof(Unsigned); i-- > 0;) {
        bytes += static_cast<char>((value >> (8 * i)) & 0xff);
    }
}

/// The file format df3: three sizes in 16 bits, then the values, x first.
std::string density_file(ir::Op op, const Lattice& lattice) {
    std::string bytes;
    for (const double size : lattice.size) {
        append_big_endian(bytes, static_cast<std::uint16_t>(size));
    }
    for (double k = 0; k < lattice.size[2]; ++k) {
        for (double j = 0; j < lattice.size[1]; ++j) {
            for (double i = 0; i < lattice.size[0]; ++i) {
                const double x = lattice.first[0] + i, y = lattice.first[1] + j, z = lattice.first[2] + k;
                const double value =
                    op == ir::Op::noise ? runtime::noise_number(x, y, z) : runtime::random_number(x, y, z);
                append_big_endian(bytes, static_cast<std::uint32_t>(std::llround(value * 4294967295.0)));
            }
        }
    }
    return bytes;
}

} // namespace

std::string PovLattices::declare(std::string_view name, ir::Op op, const std::array<Range, 3>& ranges) {
    const Lattice lattice = around(ranges);
    const double points = lattice.size[0] * lattice.size[1] * lattice.size[2];
    if (!(points <= most_points) || lattice.size[0] > 65535 || lattice.size[1] > 65535 ||
        lattice.size[2] > 65535) {
        return "";
    }
    const bool blends = op == ir::Op::noise;
    const std::string table = names_.make(fmt::format("{}_table", name));
    const std::string file = fmt::format("{}_{}.df3", files_.stem, table);
    files_.files.push_back({file, density_file(op, lattice)});
    if (blends && !has_curve_) {
        out_.line("#declare hash_curve = function(x) {{ x*x*x*(x*(x*6 - 15) + 10) }}");
        has_curve_ = true;
    }
    out_.line("#declare {} = function {{ pattern {{ density_file df3 {} interpolate {} }} }}", table,
              quote(Language::sdl, file), blends ? 1 : 0);
    std::string arguments;
    for (std::size_t i = 0; i < 3; ++i) {
        const char x = "xyz"[i];
        const std::string within = blends ? fmt::format("hash_curve({0} - floor({0}))", x) : "0.5";
        arguments += fmt::format("{}(floor({}) - ({}) + {})/{}", i == 0 ? "" : ", ", x,
                                 number(lattice.first[i]), within, number(lattice.size[i]));
    }
    const std::string function = names_.make(name);
    out_.line("#declare {} = function(x, y, z) {{ {}({}) }}", function, table, arguments);
    return function;
}

} // namespace scc::compiler
