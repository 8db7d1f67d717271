#pragma once

#include "compiler/backends/pov_image.h"
#include "compiler/ir/function.h"
#include "compiler/writer.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

/// One result of a per-point function as SDL functions of x, y, z: the object-space point, or the world point
/// where only that is read; where both are read, the world point follows as wx, wy, wz. Of a function that
/// reads uv, x and y are u and v. SDL has no local variables: what the result needs more than once is a
/// parameter of a further function.
class PovExpression {
public:
    /// What stands for operators and images that SDL does not have.
    struct Words {
        std::vector<const PovImages::Declared*> images; ///< the function's
        std::map<std::uint32_t, std::string> functions; ///< of three numbers, by their nodes
    };
    /// The result is a node of the function; it does not read n.
    PovExpression(const ir::Function& function, std::uint32_t result, const Words& words);

    bool reads_p() const { return reads(ir::Input::p_x, ir::Input::p_z); }
    bool reads_world() const { return reads(ir::Input::world_x, ir::Input::world_z); }
    bool reads_uv() const { return reads(ir::Input::uv_x, ir::Input::uv_y); }
    bool reads_normal() const { return reads(ir::Input::n_x, ir::Input::n_z); }
    /// An operator that POV-Ray does not have, or "".
    std::string_view unspoken() const;
    /// POV-Ray's functions take a limited number of parameters and nest to a limited depth.
    bool fits() const;

    /// Writes the declarations and returns the name of the function.
    std::string declare(std::string_view name, Identifiers& names, Writer& out) const;

private:
    bool reads(ir::Input first, ir::Input last) const;
    void choose_shared();
    void assign_levels();
    std::uint64_t occurrences(std::uint32_t node, std::size_t operand) const;
    std::string text(std::uint32_t node) const;
    std::string applied(std::uint32_t node) const;
    std::string input(ir::Input input) const;
    std::vector<std::uint32_t> parameters(std::uint32_t level) const;
    std::string list(std::uint32_t level, std::uint32_t seen_from) const;

    const ir::Function& function_;
    const Words& words_;
    std::uint32_t result_;
    std::vector<bool> needed_, shared_;   ///< per node
    std::vector<std::uint32_t> level_;    ///< per node: the first function that can calculate it
    std::vector<std::uint32_t> last_use_; ///< per node: the last function that reads it
};

} // namespace scc::compiler
