#include "lang/checker.h"
#include "lang/limits.h"
#include "lang/parser.h"
#include "lang/text_table.h"

#include <algorithm>

/// Rows of a table. The first one has been checked; the others differ from it in numbers only.
namespace scc::lang {
namespace {

/// The rows with numbers that their fields do not take.
std::vector<bool> wrong_rows(const TextTable& table, const ast::Construct& first,
                             const Constructor& constructor) {
    std::vector<bool> wrong(table.rows());
    std::size_t column = 0;
    for (const ast::Item& item : first.body.items) {
        const auto& written = std::get<ast::Field>(item.node);
        const auto* tuple = std::get_if<ast::Tuple>(&written.value->node);
        const bool is_number = std::holds_alternative<ast::Number>(written.value->node) ||
                               std::holds_alternative<ast::Unary>(written.value->node);
        const std::size_t count = tuple ? tuple->elements.size() : is_number ? 1 : 0;
        const Limits& limits = constructor.find(written.name.text)->limits;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            bool fits = true;
            bool nonzero = !limits.nonzero_vector || count == 0;
            for (std::size_t i = column; i < column + count; ++i) {
                const double number = (*table.columns)[i][row];
                fits = fits && component_within(limits, number);
                nonzero = nonzero || number != 0;
            }
            if (!fits || !nonzero) {
                wrong[row] = true;
            }
        }
        column += count;
    }
    return wrong;
}

/// A name stands for the same in every row, but what is wrong with its value is said at each.
bool names_only_materials(const ast::Construct& first, const Constructor& constructor) {
    return std::all_of(first.body.items.begin(), first.body.items.end(), [&](const ast::Item& item) {
        const auto& written = std::get<ast::Field>(item.node);
        return !std::holds_alternative<ast::NameRef>(written.value->node) ||
               constructor.find(written.name.text)->type.kind == TypeKind::material;
    });
}

} // namespace

/// Checks rows as if each had been parsed in the first place.
void Checker::rows_one_by_one(const TextTable& table, std::size_t begin, std::size_t end, const Into& into) {
    if (begin == end) {
        return;
    }
    const Span span{table.rest.file, (*table.places)[begin].first, (*table.places)[end - 1].second};
    const std::vector<Token> tokens = lex_within(sources_, span, diagnostics_);
    const ast::File& file = expanded_.emplace_back(parse(sources_, span.file, tokens, diagnostics_));
    for (const ast::Item& written : file.items) {
        std::visit([&](const auto& node) { item(node, written.span, into); }, written.node);
    }
}

void Checker::item(const ast::Table& item, Span, const Into& into) {
    const TextTable& table = *item.rows;
    const auto* first = into.out.empty() ? nullptr : std::get_if<ChildCode>(&into.out.back().node);
    const Constructor* constructor = schema_.find(item.first->constructor.text);
    const bool is_checked = first && constructor && first->value->span == table.first && !item_reported_;
    if (!is_checked || !names_only_materials(*item.first, *constructor)) {
        return rows_one_by_one(table, 1, table.rows(), into);
    }
    const std::vector<bool> wrong = wrong_rows(table, *item.first, *constructor);
    if (wrong[0]) {
        return rows_one_by_one(table, 1, table.rows(), into);
    }
    const Code* code = first->value.get();
    for (std::size_t row = 1; row < table.rows();) {
        std::size_t end = row + 1;
        while (end < table.rows() && wrong[end] == wrong[row]) {
            ++end;
        }
        if (wrong[row]) {
            rows_one_by_one(table, row, end, into);
        } else {
            into.out.push_back({RowsCode{item.rows, code, item.first, row, end}});
        }
        row = end;
    }
}

} // namespace scc::lang
