#include "lang/test/toy_schema.h"
#include "lang/test/trace_recorder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace scc::lang {
namespace {

std::string repeat(std::string_view text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i) {
        out += text;
    }
    return out;
}

/// The shortest scene for every diagnostic of the front end.
const std::map<Diag, std::string>& scenes() {
    static const std::map<Diag, std::string> rows{
        {Diag::unexpected_character, "print(@)"},
        {Diag::unterminated_string, "print(\"a)"},
        {Diag::unterminated_comment, "/* a"},
        {Diag::bad_escape, "print(\"\\q\")"},
        {Diag::bad_number, "print(.5)"},
        {Diag::unknown_unit, "print(3degrees)"},
        {Diag::bad_hex_color, "print(#fc0)"},
        {Diag::number_out_of_range, "print(1e999)"},
        {Diag::bad_utf8, "// \xff"},
        {Diag::unexpected_token, "print(1,)"},
        {Diag::missing_separator, "ball { } ball { }"},
        {Diag::unit_apart, "print(40 deg)"},
        {Diag::reserved_word, "let in = 3"},
        {Diag::field_assignment, "ball { radius: 3 }"},
        {Diag::field_outside, "a = 3"},
        {Diag::brace_on_new_line, "ball\n{ }"},
        {Diag::chained_operator, "print(1 < 2 < 3)"},
        {Diag::vector_size, "print((1, 2, 3, 4))"},
        {Diag::missing_result, "fn f() { let a = 1 }"},
        {Diag::after_result, "fn f() {\n  1\n  2\n}"},
        {Diag::else_without_if, "else { }"},
        {Diag::language_not_first, "print(1)\nlanguage 1"},
        {Diag::unknown_language, "language 2"},
        {Diag::unclosed_bracket, "ball {"},
        {Diag::unopened_bracket, "ball { } }"},
        {Diag::wrong_bracket, "print((1, 2])"},
        {Diag::nesting_too_deep, "print(" + repeat("(", 200) + "1" + repeat(")", 200) + ")"},
        {Diag::chain_too_long, "print(1" + repeat(" + 1", 600) + ")"},
        {Diag::duplicate_name, "let a = 1\nlet a = 2"},
        {Diag::shadowed_name, "let sin = 1\nprint(sin)"},
        {Diag::unused_let, "let a = 1"},
        {Diag::unused_param, "param a: number = 1"},
        {Diag::unused_import, "import \"part.scn\" as part"},
        {Diag::cyclic_definition, "let a = a"},
        {Diag::result_type_needed, "fn f(x: number) = f(x)"},
        {Diag::cyclic_import, "import \"round.scn\" as round\nround.scene"},
        {Diag::too_many_imports, "import \"part.scn\" as a\nimport \"part.scn\" as b\n"
                                 "import \"part.scn\" as c\na.scene\nb.scene\nc.scene"},
        {Diag::unreadable_import, "import \"none.scn\" as none\nnone.scene"},
        {Diag::import_outside, "import \"/part.scn\" as part\npart.scene"},
        {Diag::bare_import, "import \"part.scn\" as part\npart"},
        {Diag::unknown_import_param, "import \"part.scn\" as part with { sise = 2 }\npart.scene"},
        {Diag::unit_differs, "import \"inches.scn\" as part\npart.scene"},
        {Diag::frame_without_frames, "ball { radius = frame }"},
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
        {Diag::named_argument, "print(len(list = [1]))"},
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
        {Diag::spectral_color, "print(abs(metal(\"gold\")))"},
        {Diag::bad_spectrum, "print(spectrum([]))"},
        {Diag::no_inverse, "print(scale(0))"},
        {Diag::ill_conditioned_transform, "ball { transform = scale(1, 1, 1e-9) }"},
        {Diag::bad_matrix, "print(matrix([1]))"},
        {Diag::frame_too_early, "render { frames = 0..time }"},
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

test::Scene scene_of(Diag kind) {
    std::string text = scenes().at(kind);
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
    limits.imports = 2;
    const test::MemoryImporter::Files files{
        {"part.scn", "param size: number = 1\nball { radius = size }"},
        {"round.scn", "import \"a.scn\" as a\na.scene"},
        {"inches.scn", "world { unit = \"inch\" }\nball { }"},
    };
    test::Scene scene(text, definitions, limits, false, files);
    test::trace_all(scene);
    return scene;
}

TEST(CheckCoverage, EveryDiagnosticOfTheFrontEndHasAScene) {
    for (int kind = static_cast<int>(Diag::unexpected_character);
         kind <= static_cast<int>(Diag::shape_per_point); ++kind) {
        EXPECT_TRUE(scenes().contains(static_cast<Diag>(kind))) << row(static_cast<Diag>(kind)).kind;
    }
}

TEST(CheckCoverage, EverySceneGivesItsDiagnosticAndNoOther) {
    for (const auto& [kind, text] : scenes()) {
        const std::vector<Diagnostic> found = scene_of(kind).diagnostics.sorted();
        EXPECT_FALSE(found.empty()) << row(kind).kind;
        for (const Diagnostic& reported : found) {
            EXPECT_EQ(row(reported.kind).kind, row(kind).kind) << text;
        }
    }
}

/// The whole text of each, as an author sees it. SCC_UPDATE_GOLDEN=1 rewrites the file, to be reviewed like
/// code.
TEST(CheckCoverage, EveryDiagnosticReadsAsItShould) {
    std::string text;
    for (const auto& [kind, scene] : scenes()) {
        text += fmt::format("==== {}\n{}", row(kind).name, scene_of(kind).messages());
    }
    const std::string file = SCC_SOURCE_DIR "/lang/test/golden/messages.txt";
    if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
        std::ofstream(file, std::ios::binary) << text;
        return;
    }
    std::ifstream in(file, std::ios::binary);
    EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(in), {}));
}

} // namespace
} // namespace scc::lang
