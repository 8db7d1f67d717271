#include "lang/test/toy_schema.h"
#include "lang/test/trace_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace scc::lang {
namespace {

/// The shortest scene for every diagnostic that the checker and the evaluator have.
const std::map<Diag, std::string>& scenes() {
    static const std::map<Diag, std::string> rows{
        {Diag::duplicate_name, "let a = 1\nlet a = 2"},
        {Diag::shadowed_name, "let sin = 1\nprint(sin)"},
        {Diag::unused_let, "let a = 1"},
        {Diag::unused_param, "param a: number = 1"},
        {Diag::cyclic_definition, "let a = a"},
        {Diag::result_type_needed, "fn f(x: number) = f(x)"},
        {Diag::misplaced_item, "pile { param a: number = 1 }"},
        {Diag::unknown_name, "print(a)"},
        {Diag::unknown_type, "let a: vec4 = 1"},
        {Diag::unknown_constructor, "sphere { }"},
        {Diag::unknown_field, "ball { size = 1 }"},
        {Diag::unknown_member, "print((1, 2).z)"},
        {Diag::duplicate_field, "ball { radius = 1, radius = 2 }"},
        {Diag::missing_field, "chain { }"},
        {Diag::field_in_loop, "ball { for (i in 0..1) { radius = 1 } }"},
        {Diag::unexpected_item, "1"},
        {Diag::misplaced_statement, "let a = print(1)"},
        {Diag::type_mismatch, "ball { radius = true }"},
        {Diag::angle_expected, "eye { fov_y = 40 }"},
        {Diag::color_expected, "lamp { tone = 1 }"},
        {Diag::operand_mismatch, "print(1 + true)"},
        {Diag::branch_mismatch, "print(if (true) 1 else true)"},
        {Diag::element_mismatch, "print([1, true])"},
        {Diag::not_callable, "let a = 1\nprint(a(2))"},
        {Diag::not_iterable, "for (i in 3) { }"},
        {Diag::not_indexable, "print((1, 2)[0])"},
        {Diag::argument_count, "print(sqrt(1, 2))"},
        {Diag::no_overload, "print(dot(1, 2))"},
        {Diag::unknown_argument, "fn f(x: number = 1) = x\nprint(f(y = 1))"},
        {Diag::duplicate_argument, "fn f(x: number) = x\nprint(f(1, x = 1))"},
        {Diag::unnamed_argument, "fn f(x: number, y: number) = x + y\nprint(f(x = 1, 2))"},
        {Diag::missing_argument, "fn f(x: number) = x\nprint(f())"},
        {Diag::named_argument, "print(sqrt(x = 1))"},
        {Diag::called_constructor, "ball()"},
        {Diag::braces_on_function, "sin { }"},
        {Diag::bare_constructor, "ball"},
        {Diag::bare_builtin, "print(map([1], sqrt))"},
        {Diag::param_type, "param a: shape = ball { }"},
        {Diag::param_range, "param a: bool = true in 0..1"},
        {Diag::unknown_param, ""},
        {Diag::unknown_choice, "output { shading = \"round\" }"},
        {Diag::degrees_suspected, "print(sin(90))"},
        {Diag::unit_not_literal, "let u = \"m\"\nworld { unit = u }"},
        {Diag::too_deep, "let a0 = [1]\n"},
        {Diag::not_supported_yet, "knot { }"},
        {Diag::value_out_of_range, "ball { radius = 0 }"},
        {Diag::not_finite, "ball { radius = sqrt(-1) }"},
        {Diag::division_by_zero, "print(1 / 0)"},
        {Diag::zero_vector, "print(normalize((0, 0)))"},
        {Diag::index_out_of_range, "print([1][1])"},
        {Diag::fractional_range, "for (i in 0..0.5) { }"},
        {Diag::assertion_failed, "assert(false, \"no\")"},
        {Diag::no_inverse, "print(scale(0))"},
        {Diag::ill_conditioned_transform, "ball { transform = scale(1, 1, 1e-9) }"},
        {Diag::bad_matrix, "print(matrix([1]))"},
        {Diag::steps_exceeded, "for (i in 0..10000) { }"},
        {Diag::calls_too_deep, "fn f(x: number) -> number = f(x)\nprint(f(1))"},
        {Diag::list_too_long, "print([for (i in 0..200) i])"},
        {Diag::string_too_long, "print(\"" + std::string(200, 'x') + "\")"},
        {Diag::depends_on_surface,
         "let m = paint { gloss = fn(s: surface) = [1, 2][s.p.x] }\nball { material = m }"},
        {Diag::surface_recursion, "fn f(x: number) -> number = if (x > 0) f(x - 1) else 0\n"
                                  "ball { material = paint { gloss = fn(s: surface) = f(s.p.x) } }"},
        {Diag::shape_per_point, "ball { material = paint { gloss = fn(s: surface) = len([ball { }]) } }"},
    };
    return rows;
}

std::vector<Diag> reported_by(Diag kind, std::string text) {
    if (kind == Diag::too_deep) {
        for (int i = 1; i < 40; ++i) {
            text += fmt::format("let a{} = [a{}]\n", i, i - 1);
        }
        text += "print(a39)";
    }
    const std::vector<Definition> definitions =
        kind == Diag::unknown_param ? std::vector<Definition>{{"n", "1"}} : std::vector<Definition>{};
    EvaluationLimits limits;
    limits.steps = 5000;
    limits.list_length = 100;
    limits.string_length = 100;
    test::Scene scene(text, definitions, limits);
    test::trace_all(scene);
    std::vector<Diag> kinds;
    for (const Diagnostic& diagnostic : scene.diagnostics.sorted()) {
        kinds.push_back(diagnostic.kind);
    }
    return kinds;
}

TEST(CheckCoverage, EveryDiagnosticOfCheckerAndEvaluatorHasAScene) {
    for (int kind = static_cast<int>(Diag::duplicate_name); kind <= static_cast<int>(Diag::shape_per_point);
         ++kind) {
        EXPECT_TRUE(scenes().contains(static_cast<Diag>(kind))) << row(static_cast<Diag>(kind)).kind;
    }
}

TEST(CheckCoverage, EverySceneGivesItsDiagnosticAndNoOther) {
    for (const auto& [kind, text] : scenes()) {
        for (Diag reported : reported_by(kind, text)) {
            EXPECT_EQ(row(reported).kind, row(kind).kind) << text;
        }
        EXPECT_FALSE(reported_by(kind, text).empty()) << row(kind).kind;
    }
}

} // namespace
} // namespace scc::lang
