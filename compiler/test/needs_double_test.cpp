#include "compiler/backends/needs_double.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

namespace scc::compiler {
namespace {

std::string reason(const std::string& shapes) {
    const test::Compiled compiled = test::compile_shapes(shapes);
    EXPECT_TRUE(compiled.fine) << compiled.messages;
    return needs_double(compiled.scene).value_or("");
}

TEST(NeedsDouble, NotForOrdinaryNumbers) {
    for (const char* shapes :
         {"sphere { }", "plane { }", "sphere { center = (100, 0, 0) }", "sphere { radius = 0.01 }",
          "cylinder { from = (0, 0, 0), to = (1000, 0, 0), radius = 1 }",
          "box { transform = scale(1, 0.01, 1) then rotate_x(20deg) }",
          "sphere { material = phong { shininess = 400 } }", "torus { major = 1, minor = 0.01 }",
          "box { transform = scale(1, 1e-6, 1) }", "sphere { material = phong { transmit = rgb(1, 1, 1) } }",
          "sphere { material = phong { reflect = rgb(1, 1, 1) } }"}) {
        EXPECT_EQ(reason(shapes), "") << shapes;
    }
}

TEST(NeedsDouble, WhereFloatRunsOutOfDigitsOrRange) {
    const std::pair<const char*, const char*> cases[] = {
        {"sphere { center = (1e5, 0, 0) }", "size from the origin"},
        {"sphere { radius = 0.0001 }", "size from the origin"},
        {"sphere { }\nsphere { radius = 0.0001, center = (1, 2, 3) }", "`sphere[1]`"},
        {"sphere { radius = 1e10, center = (3e10, 0, 0) }", "too large or too small"},
        {"sphere { center = (20, 0, 0), transform = scale(1, 1e-3, 1) }", "stretches it"},
        {"torus { major = 1, minor = 0.001 }", "size from the origin"},
        {"sphere { material = phong { shininess = 1e5 } }", "shininess"},
        {"sphere { material = phong { transmit = rgb(1, 1, 1), ior = 1.5 } }", "bends rays"},
        {"sphere { material = phong { reflect = rgb(1, 1, 1) } }\nrender { method = ray { depth = 100 } }",
         "mirror rays"},
        {"sphere { }\nperspective_camera { near = 1e-5, far = 100 }\nrender { method = raster { } }",
         "near plane"}};
    for (const auto& [shapes, part] : cases) {
        EXPECT_NE(reason(shapes).find(part), std::string::npos) << shapes << ": " << reason(shapes);
    }
}

} // namespace
} // namespace scc::compiler
