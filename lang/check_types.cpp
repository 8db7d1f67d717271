#include "lang/checker.h"
#include "lang/wording.h"

#include <algorithm>

namespace scc::lang {
namespace {

constexpr int deepest_type = 32;

int depth_of(const Type& type) {
    int depth = 0;
    for (const Type& part : type.args) {
        depth = std::max(depth, depth_of(part));
    }
    return depth + 1;
}

bool is_literal(const ast::Expr& expr) {
    if (const auto* unary = std::get_if<ast::Unary>(&expr.node)) {
        return unary->op == ast::UnaryOp::minus && unary->operand && is_literal(*unary->operand);
    }
    const auto* number = std::get_if<ast::Number>(&expr.node);
    return number && number->unit == ast::Unit::none;
}

} // namespace

bool Checker::expect(std::string_view subject, const Type& wanted, const Type& actual, const ast::Expr& value,
                     std::string_view alternative) {
    if (fits(wanted, actual)) {
        return true;
    }
    const std::string text(sources_.text(value.span));
    if (wanted.kind == TypeKind::angle && actual.kind == TypeKind::number) {
        Diagnostic& diagnostic = diagnostics_.report(Diag::angle_expected, value.span, subject);
        if (is_literal(value)) {
            diagnostic.suggest(value.span, text + "deg");
        }
        return false;
    }
    const bool like_color = actual.kind == TypeKind::number || actual.kind == TypeKind::vec3;
    if (wanted.kind == TypeKind::color && like_color) {
        Diagnostic& diagnostic =
            diagnostics_.report(Diag::color_expected, value.span, subject, described(actual));
        if (is_literal(value)) {
            diagnostic.suggest(value.span, fmt::format("rgb({0}, {0}, {0})", text));
        } else if (std::holds_alternative<ast::Tuple>(value.node)) {
            diagnostic.suggest(value.span, "rgb" + text);
        }
        return false;
    }
    diagnostics_.report(Diag::type_mismatch, value.span, subject,
                        described(wanted) + std::string(alternative), described(actual));
    return false;
}

void Checker::not_supported(Span span, std::string_view what) {
    diagnostics_.report(Diag::not_supported_yet, span, in_code(what));
}

std::optional<std::string_view> Checker::meant_name(std::string_view name, const Place& place,
                                                    std::vector<std::string_view> others) {
    if (searches_left_ == 0) {
        return std::nullopt;
    }
    --searches_left_;
    const std::vector<std::string_view> visible = Names::visible(place.scope);
    others.insert(others.end(), visible.begin(), visible.end());
    std::sort(others.begin(),
              others.end()); // scopes are hashed; equally near names give the same message always
    return nearest(name, others);
}

Type Checker::bounded(Type type, Span span) {
    if (depth_of(type) <= deepest_type) {
        return type;
    }
    diagnostics_.report(Diag::too_deep, span);
    return {};
}

Type Checker::type(const ast::TypeExpr* written) {
    if (!written) {
        return {};
    }
    if (const auto* named = std::get_if<ast::NamedType>(&written->node)) {
        if (const TypeKind* kind = named_type(named->name.text)) {
            return *kind;
        }
        const auto best = nearest(named->name.text, type_names());
        Diagnostic& diagnostic =
            diagnostics_.report(Diag::unknown_type, named->name.span, named->name.text, did_you_mean(best));
        if (best) {
            diagnostic.suggest(named->name.span, std::string(*best));
        }
        return {};
    }
    if (const auto* list = std::get_if<ast::ListType>(&written->node)) {
        return bounded(Type::list_of(type(list->element.get())), written->span);
    }
    const auto& function = std::get<ast::FunctionType>(written->node);
    std::vector<Type> parameters;
    for (const ast::TypeExprPtr& parameter : function.parameters) {
        parameters.push_back(type(parameter.get()));
    }
    return bounded(Type::function(std::move(parameters), type(function.result.get())), written->span);
}

} // namespace scc::lang
