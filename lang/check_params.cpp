#include "lang/imports.h"
#include "lang/parser.h"
#include "lang/units.h"
#include "lang/wording.h"

namespace scc::lang {
namespace {

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
        world_unit_ = length_unit(name->value).value_or(world_unit_);
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

/// `name` is what is left of the definition's when the imports before it are taken off.
void Checker::definition(const Definition& definition, std::string_view name, CheckedFile& file) {
    const std::size_t dot = name.find('.');
    std::vector<std::string> names;
    for (const auto& imported : file.imports) {
        if (dot != std::string_view::npos && imported->name == name.substr(0, dot)) {
            return this->definition(definition, name.substr(dot + 1), imported->code);
        }
        for (const ParamCode& param : imported->code.params) {
            names.push_back(fmt::format("{}.{}", imported->name, param.name));
        }
    }
    for (ParamCode& param : file.params) {
        if (param.name == name) {
            return set_param(file, param, given_value(definition, param));
        }
        names.emplace_back(param.name);
    }
    if (is_lost(name) || (import_failed_ && dot != std::string_view::npos)) {
        return;
    }
    const auto best = nearest(name, {names.begin(), names.end()});
    const std::string_view before(definition.name.data(), definition.name.size() - name.size());
    diagnostics_.report(Diag::unknown_param, Span{}, definition.name,
                        best ? did_you_mean(fmt::format("{}{}", before, *best)) : "");
}

/// The value in force; of earlier ones, the default is kept.
void Checker::set_param(CheckedFile& file, ParamCode& param, CodePtr value) {
    std::swap(file.body.cells[param.cell], value);
    if (!param.default_value) {
        param.default_value = std::move(value);
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
    Scope& scope = names_.add_scope(nullptr);
    Typed value = expression(expr, {&scope, nullptr, {}});
    if (expr) {
        expect(fmt::format("the param `{}`", param.name), param.type, value, *expr);
    }
    return std::move(value.code);
}

} // namespace scc::lang
