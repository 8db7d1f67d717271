#include "compiler/backends/function_program.h"
#include "compiler/backends/lattices.h"
#include "compiler/derivative.h"
#include "compiler/function_builder.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace scc::compiler {
namespace {

using D = runtime::Dual<double, 3>;

/// Values and slopes of a function against those that the tracer has, at points of a box.
void expect_same(const ir::Function& function, const ir::Function& derived, double value_error,
                 double slope_error) {
    const auto program = program_of<double>(function), all = program_of<double>(derived);
    ASSERT_EQ(all.results.size(), 4U);
    for (int i = 0; i < 200; ++i) {
        const double x = std::sin(7.0 * i), y = std::sin(11.0 * i + 1), z = std::sin(13.0 * i + 2);
        const D expected =
            run(program, runtime::SurfacePoint<D>{{D::variable(x, 0), D::variable(y, 1), D::variable(z, 2)},
                                                  {},
                                                  {}})[program.results[0]];
        const double* found = run(all, runtime::SurfacePoint<double>{{x, y, z}, {}, {}});
        EXPECT_NEAR(found[all.results[0]], expected.v, value_error) << x << ' ' << y << ' ' << z;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(found[all.results[k + 1]], expected.d[k], slope_error) << "by " << k;
        }
    }
}

ir::Scene scene_of(const std::string& text) {
    const test::Compiled c = test::compile_shapes(text);
    EXPECT_TRUE(c.fine) << c.messages;
    return c.scene;
}

TEST(Lattices, HaveTheSameNoiseAndItsSlopes) {
    for (const char* field : {"noise(p * 3) - 0.5", "noise((2 * p.x, p.y - 4)) - 0.5 * noise(p.z * 7)",
                              "p.y + random(floor(p.x * 4), floor(p.z * 3) - 2, 7) - 0.5"}) {
        SCOPED_TRACE(field);
        const ir::Scene scene =
            scene_of("implicit { field = fn(p: vec3) = " + std::string(field) + ", within = box { } }");
        const ir::Function looked_up = field_with_lattices(scene, 0);
        EXPECT_TRUE(has_lattice(scene.functions[0]));
        EXPECT_FALSE(has_lattice(looked_up));
        const auto derived = with_gradient(looked_up);
        ASSERT_TRUE(derived);
        expect_same(scene.functions[0], *derived, 1e-7, 3e-6); // texels are floats
    }
}

TEST(Lattices, AreThoseOfAllObjectsWithTheMaterial) {
    const ir::Scene scene = scene_of(R"(
let clouds = phong { diffuse = fn(s: surface) = rgb(noise(s.p * 3), 0, 0) }
sphere { material = clouds }
sphere { center = (4, 0, 0), material = clouds }
)");
    const ir::Scene made = with_lattices(scene);
    ASSERT_EQ(made.functions.size(), 1U);
    ASSERT_EQ(made.functions[0].images.size(), 1U);
    const runtime::ImageData& image = made.functions[0].images[0]->data;
    EXPECT_EQ(image.width, 3 * 20U); // cells from -3 - 1 to 15, of nine numbers each
    EXPECT_EQ(image.height, 8U * 8U);
}

TEST(Lattices, AreNotMadeOfWhatHasNoBoundsOrTooWideOnes) {
    for (const char* scene :
         {"plane { material = phong { diffuse = fn(s: surface) = rgb(noise(s.p), 0, 0) } }",
          "sphere { material = phong { diffuse = fn(s: surface) = rgb(noise(s.p * 1000), 0, 0) } }",
          "sphere { material = phong { diffuse = fn(s: surface) = rgb(random(s.p.x), 0, 0) } }"}) {
        EXPECT_TRUE(has_lattice(with_lattices(scene_of(scene)).functions.at(0))) << scene;
    }
}

TEST(Derivative, OfAnImageIsThatOfDualNumbers) {
    const auto texels = std::make_shared<std::vector<float>>();
    for (int i = 0; i < 5 * 4 * 3; ++i) {
        texels->push_back(static_cast<float>(0.5 + 0.5 * std::sin(37.0 * i)));
    }
    for (const runtime::Filter filter : {runtime::Filter::bilinear, runtime::Filter::nearest}) {
        for (const runtime::Wrap wrap : {runtime::Wrap::repeat, runtime::Wrap::clamp}) {
            auto image = std::make_shared<ir::Image>();
            image->data.values = texels->data();
            image->data.width = 5;
            image->data.height = 4;
            image->data.filter = filter;
            image->data.wrap = wrap;
            image->data.max = {1, 1, 1};
            FunctionBuilder builder;
            const std::uint32_t u = builder.apply("mul", {builder.input("p.x"), builder.input("p.y")}),
                                v = builder.apply("sin", {builder.input("p.z")});
            const ir::Function function = builder.finish({{0, builder.look_up(image, 1, u, v)}});
            const auto derived = with_gradient(function);
            ASSERT_TRUE(derived);
            expect_same(function, *derived, 1e-12, 1e-9);
        }
    }
}

} // namespace
} // namespace scc::compiler
