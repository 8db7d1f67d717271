#pragma once

#include "lang/ast.h"
#include "lang/schema.h"
#include "lang/source.h"
#include "lang/type.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What the names of a file stand for and where they are mentioned, for tools that show or change them.
namespace scc::lang {

struct EvaluationLimits;

enum class SymbolKind {
    let,
    param,
    function,
    variable, ///< of a loop, or a parameter of a function
    import,
    misplaced, ///< a param or an import that is not on the top level
};

/// A place where a name stands for a symbol.
struct Mention {
    Span span;
    std::uint32_t scope = 0; ///< in which it stands
};

/// A name that the file binds.
struct Symbol {
    SymbolKind kind = SymbolKind::let;
    std::string name;
    Span span;   ///< of the name where it is bound
    Span extent; ///< of the whole definition; of a variable its name's
    Type type;   ///< error: not known
    std::uint32_t scope = 0;
    std::vector<Mention> mentions; ///< all but the definition, in the order of the text
};

struct SymbolScope {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t parent = none;
    Span extent;                        ///< from where its names are seen
    std::vector<std::uint32_t> symbols; ///< what each name of it stands for
};

/// `object.member`, with the object's type.
struct MemberMention {
    Span span; ///< of the member's name
    Type object;
};

struct SymbolIndex {
    std::vector<SymbolScope> scopes; ///< the first one is the file's
    std::vector<Symbol> symbols;
    std::vector<MemberMention> members;

    /// The symbol whose name stands at the offset, or ends there.
    const Symbol* at(std::uint32_t offset) const;
    /// The innermost scope around the offset.
    std::uint32_t scope_at(std::uint32_t offset) const;
    /// What a name stands for in a scope; null: nothing that the file binds.
    const Symbol* find(std::uint32_t scope, std::string_view name) const;
    /// Whether `inner` is `outer` or lies within it.
    bool is_within(std::uint32_t inner, std::uint32_t outer) const;
};

/// The names of a file as the checker understands them, mistakes or not. The file was read by parse_file: the
/// lines of a table are not looked into.
SymbolIndex find_symbols(const ast::File& file, const Schema& schema, SourceSet& sources);

/// The value of the `let` or `param` on the top level that is bound at `name`, as the language writes it;
/// nothing for things and functions, and if its definition is wrong or needs more than the limits allow.
std::optional<std::string> evaluate_name(std::shared_ptr<const ast::File> file, Span name,
                                         const Schema& schema, SourceSet& sources,
                                         const EvaluationLimits& limits);

} // namespace scc::lang
