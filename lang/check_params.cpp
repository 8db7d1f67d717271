#include "lang/checker.h"
#include "lang/parser.h"
#include "lang/wording.h"

#include <array>

namespace scc::lang {
namespace {

constexpr std::array units{
    std::pair{std::string_view("mm"), ast::Unit::mm},     std::pair{std::string_view("cm"), ast::Unit::cm},
    std::pair{std::string_view("m"), ast::Unit::m},       std::pair{std::string_view("km"), ast::Unit::km},
    std::pair{std::string_view("inch"), ast::Unit::inch},
};

bool can_be_param(TypeKind kind) {
    switch (kind) {
    case TypeKind::error:
    case TypeKind::number:
    case TypeKind::angle:
    case TypeKind::boolean:
    case TypeKind::string:
    case TypeKind::vec2:
    case TypeKind::vec3:
    case TypeKind::color:
        return true;
    default:
        return false;
    }
}

const ast::Field* find_field(const ast::Construct& thing, std::string_view name) {
    for (const ast::Item& item : thing.body.items) {
        const auto* field = std::get_if<ast::Field>(&item.node);
        if (field && field->name.text == name) {
            return field;
        }
    }
    return nullptr;
}

} // namespace

/// The unit scales literals, so it is read from the text of the file's top level before anything is
/// evaluated.
void Checker::find_unit(const ast::File& file) {
    for (const ast::Item& item : file.items) {
        const auto* child = std::get_if<ast::Child>(&item.node);
        const auto* thing =
            child && child->value ? std::get_if<ast::Construct>(&child->value->node) : nullptr;
        const ast::Field* unit =
            thing && thing->constructor.text == "world" ? find_field(*thing, "unit") : nullptr;
        if (!unit || !unit->value) {
            continue;
        }
        const auto* name = std::get_if<ast::String>(&unit->value->node);
        if (!name) {
            continue; // reported with the field
        }
        unit_fields_.push_back(unit);
        for (const auto& [word, value] : units) {
            world_unit_ = word == name->value ? value : world_unit_;
        }
    }
}

/// Finds the type; the default and the range are checked when the file's items are.
void Checker::param(Binding& binding) {
    binding.state = Binding::State::checked;
    binding.type_known = true;
    const Type written = type(binding.param->type.get());
    if (can_be_param(written.kind)) {
        binding.type = written;
    } else {
        diagnostics_.report(Diag::param_type, binding.param->type->span, binding.name, described(written));
    }
}

ParamCode Checker::param_code(Binding& binding) {
    const ast::Param& item = *binding.param;
    ParamCode code;
    code.name = binding.name;
    code.type = binding.type;
    code.text = item.text.value_or("");
    code.span = binding.span;
    code.cell = binding.cell;
    const Place place{binding.scope, &binding, {}};
    Typed value = expression(item.default_value, place);
    if (item.default_value) {
        expect(fmt::format("the param `{}`", binding.name), binding.type, value, *item.default_value);
    }
    binding.code = std::move(value.code);
    if (item.range) {
        param_range(item, binding.type, place, code);
    }
    return code;
}

void Checker::param_range(const ast::Param& item, const Type& type, const Place& place, ParamCode& code) {
    const auto* range = std::get_if<ast::Binary>(&item.range->node);
    const bool has_ends = range && range->op == ast::BinaryOp::range;
    if (!has_ends || (type.kind != TypeKind::number && type.kind != TypeKind::angle)) {
        if (type.kind != TypeKind::error) {
            diagnostics_.report(Diag::param_range, item.range->span, item.name.text, described(type));
        }
        return;
    }
    Typed begin = expression(range->left, place);
    Typed end = expression(range->right, place);
    const std::string subject = fmt::format("the range of `{}`", item.name.text);
    expect(subject, type, begin, *range->left);
    expect(subject, type, end, *range->right);
    code.begin = std::move(begin.code);
    code.end = std::move(end.code);
}

void Checker::definitions(const std::vector<Definition>& definitions, const Scope& scope,
                          std::vector<ParamCode>& params) {
    for (const Definition& definition : definitions) {
        ParamCode* found = nullptr;
        std::vector<std::string_view> names;
        for (ParamCode& param : params) {
            found = param.name == definition.name ? &param : found;
            names.push_back(param.name);
        }
        if (!found && is_lost(definition.name)) {
            continue;
        }
        if (!found) {
            diagnostics_.report(Diag::unknown_param, Span{}, definition.name,
                                did_you_mean(nearest(definition.name, names)));
            continue;
        }
        CodePtr value = given_value(definition, *found);
        std::swap(scope.cells[found->cell]->code, value);
        if (!found->default_value) { // else the value of an earlier -D is dropped
            found->default_value = std::move(value);
        }
    }
}

CodePtr Checker::given_value(const Definition& definition, const ParamCode& param) {
    const FileId file = sources_.add("-D " + definition.name, definition.value);
    const Span all{file, 0, static_cast<std::uint32_t>(definition.value.size())};
    if (param.type.kind == TypeKind::string) {
        if (definition.value.size() > limits_.string_length) {
            diagnostics_.report(Diag::string_too_long, all, limits_.string_length);
        }
        return make_code(code::Constant{{definition.value}}, all);
    }
    const ast::ExprPtr& expr = given_.emplace_back(parse_expression(sources_, file, diagnostics_));
    Scope& scope = names_.add_scope(nullptr, all);
    Typed value = expression(expr, {&scope, nullptr, {}});
    if (expr) {
        expect(fmt::format("the param `{}`", param.name), param.type, value, *expr);
    }
    return std::move(value.code);
}

} // namespace scc::lang
