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

bool Checker::expect(std::string_view subject, const Type& wanted, Typed& value, const ast::Expr& expr,
                     std::string_view alternative) {
    const Type& actual = value.type;
    if (wanted.kind != TypeKind::error && fits(wanted, actual)) {
        return true;
    }
    value.code = make_code(code::Failed{}, expr.span);
    if (wanted.kind == TypeKind::error) {
        return true;
    }
    const std::string text(sources_.text(expr.span));
    if (wanted.kind == TypeKind::angle && actual.kind == TypeKind::number) {
        Diagnostic& diagnostic = diagnostics_.report(Diag::angle_expected, expr.span, subject);
        if (is_literal(expr)) {
            diagnostic.suggest(expr.span, text + "deg");
        }
        return false;
    }
    const bool like_color = actual.kind == TypeKind::number || actual.kind == TypeKind::vec3;
    if (wanted.kind == TypeKind::color && like_color) {
        Diagnostic& diagnostic =
            diagnostics_.report(Diag::color_expected, expr.span, subject, described(actual));
        if (is_literal(expr)) {
            diagnostic.suggest(expr.span, fmt::format("rgb({0}, {0}, {0})", text));
        } else if (std::holds_alternative<ast::Tuple>(expr.node)) {
            diagnostic.suggest(expr.span, "rgb" + text);
        }
        return false;
    }
    diagnostics_.report(Diag::type_mismatch, expr.span, subject, described(wanted) + std::string(alternative),
                        described(actual));
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

/// Reports a name that means nothing, unless it may be defined in text that could not be read.
Typed Checker::unknown(std::string_view name, Span span, const Place& place,
                       std::vector<std::string_view> others) {
    unused_is_known_ = false;
    if (is_lost(name)) {
        return {};
    }
    const auto best = meant_name(name, place, std::move(others));
    Diagnostic& diagnostic = diagnostics_.report(Diag::unknown_name, span, name, did_you_mean(best));
    if (best) {
        diagnostic.suggest(span, std::string(*best));
    }
    return {};
}

Type Checker::bounded(Type type, Span span) {
    if (depth_of(type) <= deepest_type) {
        return type;
    }
    diagnostics_.report(Diag::too_deep, span);
    return {};
}

/// The error type if any part of it is not known.
Type Checker::type(const ast::TypeExpr* written) {
    if (!written) {
        return {};
    }
    if (const auto* named = std::get_if<ast::NamedType>(&written->node)) {
        if (named->name.text.empty()) { // could not be read
            return {};
        }
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
    std::vector<Type> parts;
    TypeKind kind = TypeKind::list;
    if (const auto* list = std::get_if<ast::ListType>(&written->node)) {
        parts.push_back(type(list->element.get()));
    } else {
        const auto& function = std::get<ast::FunctionType>(written->node);
        kind = TypeKind::function;
        for (const ast::TypeExprPtr& parameter : function.parameters) {
            parts.push_back(type(parameter.get()));
        }
        parts.push_back(type(function.result.get()));
    }
    const bool is_known = std::none_of(parts.begin(), parts.end(),
                                       [](const Type& part) { return part.kind == TypeKind::error; });
    return is_known ? bounded({kind, std::move(parts)}, written->span) : Type{};
}

} // namespace scc::lang
