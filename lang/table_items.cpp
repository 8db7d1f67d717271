#include "lang/parser.h"
#include "lang/text_table.h"

#include <algorithm>
#include <optional>

namespace scc::lang {
namespace {

bool is_plain_number(const ast::Expr& expr) {
    const auto* minus = std::get_if<ast::Unary>(&expr.node);
    const ast::Expr& unsigned_part = minus && minus->op == ast::UnaryOp::minus ? *minus->operand : expr;
    const auto* number = std::get_if<ast::Number>(&unsigned_part.node);
    return number && number->unit == ast::Unit::none;
}

/// How many numbers stand in a field's value, all of which mean themselves; none if it holds anything else
/// whose place matters.
std::optional<std::size_t> numbers_in(const ast::Expr& value) {
    if (is_plain_number(value)) {
        return 1;
    }
    if (const auto* tuple = std::get_if<ast::Tuple>(&value.node)) {
        const auto& all = tuple->elements;
        const bool plain = std::all_of(all.begin(), all.end(),
                                       [](const auto& element) { return is_plain_number(*element); });
        return plain ? std::optional(all.size()) : std::nullopt;
    }
    const bool is_fixed = std::holds_alternative<ast::NameRef>(value.node) ||
                          std::holds_alternative<ast::Bool>(value.node) ||
                          std::holds_alternative<ast::HexColor>(value.node);
    return is_fixed ? std::optional<std::size_t>(0) : std::nullopt;
}

bool is_first_row(const ast::Item& item, const TextTable& table) {
    const auto* child = std::get_if<ast::Child>(&item.node);
    const auto* thing = child ? std::get_if<ast::Construct>(&child->value->node) : nullptr;
    if (!thing || item.span != table.first) {
        return false;
    }
    std::size_t numbers = 0;
    for (const ast::Item& inside : thing->body.items) {
        const auto* field = std::get_if<ast::Field>(&inside.node);
        const auto count = field ? numbers_in(*field->value) : std::nullopt;
        if (!count) {
            return false;
        }
        numbers += *count;
    }
    return numbers == table.columns->size();
}

using Tables = std::vector<std::shared_ptr<const TextTable>>;

/// Puts each table behind its first row; those that have none here stay null in `placed`.
void place(std::vector<ast::Item>& items, const Tables& tables, std::vector<bool>& placed) {
    std::vector<ast::Item> result;
    const auto before = [](const ast::Item& item, const auto& table) {
        return item.span.begin < table->first.begin;
    };
    for (ast::Item& item : items) {
        const auto* child = std::get_if<ast::Child>(&item.node);
        auto* thing = child ? std::get_if<ast::Construct>(&child->value->node) : nullptr;
        if (thing) {
            place(thing->body.items, tables, placed);
        }
        const auto at = std::partition_point(tables.begin(), tables.end(), [&](const auto& table) {
            return table->first.begin < item.span.begin;
        });
        const bool is_row = at != tables.end() && !before(item, *at) && is_first_row(item, **at);
        result.push_back(std::move(item));
        if (is_row) {
            placed[static_cast<std::size_t>(at - tables.begin())] = true;
            result.push_back({ast::Table{*at, thing}, (*at)->rest});
        }
    }
    items = std::move(result);
}

} // namespace

std::shared_ptr<const ast::File> read_file(const SourceSet& sources, FileId file, Diagnostics& diagnostics) {
    Tables tables;
    for (TextTable& table : find_tables(sources.file(file).text(), file)) {
        tables.push_back(std::make_shared<const TextTable>(std::move(table)));
    }
    // What looked like a table may be the inside of something else: then it is read without it.
    while (!tables.empty()) {
        std::vector<Span> left_out;
        for (const auto& table : tables) {
            left_out.push_back(table->rest);
        }
        Diagnostics found;
        ast::File tree = parse(sources, file, lex_around(sources, file, left_out, found), found);
        std::vector<bool> placed(tables.size());
        place(tree.items, tables, placed);
        if (found.has_errors()) {
            break;
        }
        if (std::all_of(placed.begin(), placed.end(), [](bool is_placed) { return is_placed; })) {
            for (const Diagnostic& diagnostic : found.sorted()) {
                diagnostics.add(diagnostic);
            }
            return std::make_shared<const ast::File>(std::move(tree));
        }
        Tables rest;
        for (std::size_t i = 0; i < tables.size(); ++i) {
            if (placed[i]) {
                rest.push_back(tables[i]);
            }
        }
        tables = std::move(rest);
    }
    return parse_file(sources, file, diagnostics);
}

} // namespace scc::lang
