#include "lang/evaluator.h"
#include "lang/rows.h"
#include "lang/text_table.h"

/// Rows of a table: the first one's thing with columns in the place of its numbers.
namespace scc::lang {
namespace {

ThingPtr with_columns(const Thing& first, const ast::Construct& written) {
    auto copy = std::make_shared<Thing>(first);
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < copy->fields.size(); ++i) {
        const ast::Expr& value = *std::get<ast::Field>(written.body.items[i].node).value;
        const bool has_numbers = std::holds_alternative<ast::Number>(value.node) ||
                                 std::holds_alternative<ast::Unary>(value.node) ||
                                 std::holds_alternative<ast::Tuple>(value.node);
        if (!has_numbers) {
            continue;
        }
        Components parts = components(copy->fields[i].value);
        for (std::size_t k = 0; k < parts.count; ++k) {
            parts.v[k] = {0, next++};
        }
        copy->fields[i].value = compose(parts);
    }
    return copy;
}

} // namespace

void Evaluator::item(const RowsCode& item, const FramePtr& frame, const Target& target) {
    if (recording()) {
        cannot_record();
        return;
    }
    steps_ += item.end - item.begin;
    const Value first = eval(*item.first, frame);
    if (const auto* thing = std::get_if<ThingPtr>(&first.v)) {
        add_child({make_rows({item.table->columns,
                              item.table->places,
                              item.begin,
                              item.end - item.begin,
                              {with_columns(**thing, *item.written)}})},
                  item.first->span, target);
    }
}

} // namespace scc::lang
