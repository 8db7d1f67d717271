#pragma once

#include "lang/rows.h"
#include "lang/source.h"

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

/// Long runs of lines that differ in numbers only, as other programs write them: read by comparing each with
/// the first, not token by token.
namespace scc::lang {

struct TextTable {
    Span first; ///< the first row's item, which is read like any other
    Span rest;  ///< the lines after it
    std::shared_ptr<const std::vector<Column>>
        columns;                          ///< the numbers in the order of the text; the first row's too
    std::shared_ptr<const Places> places; ///< of each row's item

    std::size_t rows() const { return places->size(); }
};

/// Runs of lines `word ... }` with the same text but for the numbers in it. Whether the first one is an item
/// of its own, so that all are, shows when it has been parsed.
std::vector<TextTable> find_tables(std::string_view text, FileId file);

} // namespace scc::lang
