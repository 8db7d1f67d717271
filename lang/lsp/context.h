#pragma once

#include "lang/lsp/document.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace scc::lang::lsp {

/// Where in the text a cursor stands, as far as the tokens before it tell: they do so in text that cannot be
/// parsed, too.
struct Context {
    enum class Where {
        nothing, ///< in a comment, in free text, where a new name is made up
        string,  ///< within the quotes of `field`
        member,  ///< behind a dot
        type,
        item,    ///< at the beginning of an item
        operand, ///< where a value begins
        after_operand,
    };

    Where where = Where::nothing;
    Span word;                          ///< what is written so far; empty: nothing
    const Constructor* thing = nullptr; ///< whose body the item stands in
    bool is_file = false;         ///< the item stands at the top of the file, in loops and conditions too
    bool is_function = false;     ///< the item stands in the block of a function
    const Field* field = nullptr; ///< whose value begins here, or the string is
    std::vector<std::string_view> set; ///< fields of `thing` that are set
};

Context context_at(const Analysis& analysis, std::uint32_t offset);

/// The field whose name this token is: it stands before a `=`, directly in a body. Null for other tokens.
const Field* field_at(const Analysis& analysis, std::size_t token);
/// The constructor in whose body a token stands, past loops and conditions.
const Constructor* thing_around(const Analysis& analysis, std::size_t token);
/// The token in which the offset lies, or which ends there; a name before other tokens.
std::optional<std::size_t> token_at(const Analysis& analysis, std::uint32_t offset);

} // namespace scc::lang::lsp
