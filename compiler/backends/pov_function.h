#pragma once

#include "compiler/backends/function_range.h"
#include "compiler/backends/ledger.h"
#include "compiler/backends/pov_expression.h"
#include "compiler/backends/pov_image.h"
#include "compiler/backends/pov_lattice.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scc::compiler {

/// A colour that is constant, or the sum over `parts` of low + t (high - low). A number stands in all
/// channels.
struct Paint {
    struct Part {
        std::string t; ///< an expression of x, y, z with values in 0..1
        runtime::Rgb<double> low{}, high{};
    };
    runtime::Rgb<double> constant{};
    std::vector<Part> parts;                      ///< none for a constant, else one, or one for each channel
    bool two_valued = false;                      ///< t of the one part is 0 or 1
    std::int32_t function = runtime::no_function; ///< where the paint comes from

    bool is_constant() const { return parts.empty(); }
    bool is_black() const { return is_constant() && constant == runtime::Rgb<double>{}; }
};

/// How faithfully something went into the export; see LedgerEntry.
struct Outcome {
    Fidelity fidelity = Fidelity::exact;
    std::string how;
    double bound = 0;
    bool is_differenced = false; ///< as LedgerEntry has it
};

/// Per-point functions as SDL functions, each declared when it is first used.
class PovFunctions {
public:
    PovFunctions(const std::vector<ir::Function>& functions, ExportFiles& files, Writer& out)
        : functions_(functions), inputs_(functions.size()), words_(functions.size()), images_(files, out),
          lattices_(files, out), out_(out) {}

    /// The function is called with inputs in these ranges, too. To be said before it is used.
    void cover(std::int32_t function, const InputRanges& inputs);

    /// Where a function is used.
    struct Place {
        InputRanges inputs;
        double largest = 0; ///< values beyond are cut where the function's own bounds are wider
        /// From a texture's x, y, z, which are the function's p; null: they are its world point as well.
        const runtime::Affine<double>* world_from_object = nullptr;
        /// Why a function that reads uv cannot be written here; empty: its texture is mapped by uv.
        std::string_view uv_obstacle{};
    };
    std::pair<Paint, Outcome> paint(std::int32_t function, const Place& place);

    struct Scaled {
        std::string t; ///< an expression of x, y, z with values in 0..1, which stand for low to high
        double low = 0, high = 0;
    };
    /// Of a function with one result.
    std::pair<Scaled, Outcome> scaled_number(std::int32_t function, const Place& place);

    struct Declared {
        std::string name; ///< empty: it cannot be written, for this reason:
        std::string obstacle;
        bool reads_p = false, reads_world = false, reads_uv = false;
    };
    /// The field of an implicit surface, as a function of x, y, z.
    const Declared& field(std::int32_t function) {
        return declare(function, functions_[static_cast<std::size_t>(function)].results[0], "");
    }

private:
    const PovExpression::Words& words(std::int32_t function);
    /// What its words cost.
    Outcome outcome_of(std::int32_t function);
    const Declared& declare(std::int32_t function, std::uint32_t node, std::string_view suffix);
    Scaled scaled(std::int32_t function, std::uint32_t node, std::string_view suffix, const Place& place,
                  Outcome& outcome);

    const std::vector<ir::Function>& functions_;
    std::vector<std::optional<InputRanges>> inputs_;         ///< of each function
    std::vector<std::optional<PovExpression::Words>> words_; ///< of each function
    PovImages images_;
    PovLattices lattices_;
    Writer& out_;
    Identifiers names_{"f_"};
    std::map<std::pair<std::int32_t, std::uint32_t>, Declared> declared_;
};

} // namespace scc::compiler
