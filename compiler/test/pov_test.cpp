#include "compiler/backends/pov.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

/// The emitted SDL as text; pov_render_test.cpp looks at its pictures.
namespace scc::compiler {
namespace {

using testing::AssertionResult;

struct Exported {
    std::string text;
    Ledger ledger;

    const LedgerEntry* find(std::string_view feature) const {
        const auto found = std::find_if(ledger.begin(), ledger.end(),
                                        [&](const LedgerEntry& entry) { return entry.feature == feature; });
        return found == ledger.end() ? nullptr : &*found;
    }
};

Exported exported(ir::Scene scene) {
    run_passes(scene);
    Exported result;
    result.text = test::emit_pov(scene, result.ledger);
    return result;
}

Exported exported(const std::string& shapes) {
    const test::Compiled c = test::compile_shapes(shapes);
    EXPECT_TRUE(c.fine) << c.messages;
    return exported(c.scene);
}

AssertionResult has(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << "`" << part << "` is not in:\n" << text;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++n;
    }
    return n;
}

/// The scene in which one material stands on a sphere.
Exported sphere_of(const std::string& phong) {
    return exported("sphere { material = phong { " + phong + " } }");
}

TEST(Pov, VersionIsTheFirstStatement) {
    const std::string text = exported("sphere { }").text;
    std::size_t at = 0;
    while (text.compare(at, 2, "//") == 0) {
        at = text.find('\n', at) + 1;
    }
    EXPECT_EQ(text.compare(at, 12, "#version 3.7"), 0) << text;
}

TEST(Pov, SettingsFollowTheScene) {
    const std::string text =
        exported("sphere { }\nworld { ambient = rgb(0.1, 0.2, 0.3), background = rgb(0.5, 0.5, 0.5) }\n"
                 "render { method = ray { depth = 3, shadows = false } }")
            .text;
    EXPECT_TRUE(has(text, "max_trace_level 4"));
    EXPECT_TRUE(has(text, "adc_bailout 0"));
    EXPECT_TRUE(has(text, "ambient_light rgb scc_exposure*<0.1, 0.2, 0.3>"));
    EXPECT_TRUE(has(text, "background { rgb scc_exposure*0.5 }"));
    EXPECT_TRUE(has(text, "no_shadow"));
}

TEST(Pov, MoreLevelsThanItHasAreApproximated) {
    const auto mirror = [](const char* depth) {
        return exported("sphere { material = phong { reflect = rgb(1, 1, 1) } }\n"
                        "render { method = ray { depth = " +
                        std::string(depth) + " } }");
    };
    const Exported all = mirror("255"), most = mirror("256");
    EXPECT_TRUE(has(all.text, "max_trace_level 256"));
    EXPECT_EQ(all.find("depth")->fidelity, Fidelity::exact);
    EXPECT_TRUE(has(most.text, "max_trace_level 256"));
    EXPECT_EQ(most.find("depth")->fidelity, Fidelity::approximated);
}

TEST(Pov, ShadowsAreOnByDefault) {
    EXPECT_FALSE(has(exported("sphere { }").text, "no_shadow"));
}

TEST(Pov, CameraFollowsTheSizeOfThePictureAtHand) {
    EXPECT_TRUE(has(exported("sphere { }").text, "*image_width/image_height"));
}

TEST(Pov, ObjectsAreNamedInComments) {
    EXPECT_TRUE(has(exported("let table = group { sphere { name = \"leg\" } }\ntable").text, "// "));
}

TEST(Pov, SourceLinesStandInTheComments) {
    const test::Compiled c = test::compile_shapes("\n\nsphere { }");
    lang::SourceSet sources;
    sources.add("/home/somebody/scenes/test.scn", "\n\nsphere { }\nperspective_camera { }\n");
    Ledger ledger;
    const std::string text = test::emit_pov(c.scene, ledger, &sources);
    EXPECT_TRUE(has(text, "(test.scn:3)"));
    EXPECT_FALSE(has(text, "somebody"));
}

// ---- materials -------------------------------------------------------------------------------------------

TEST(Pov, WhiteHighlightsNeedOneLayer) {
    const std::string text =
        sphere_of("diffuse = rgb(0.5, 0.25, 0), ambient = rgb(0.25, 0.25, 0), specular = rgb(0.5, 0.5, 0.5), "
                  "shininess = 16, reflect = rgb(0.25, 0.5, 0)")
            .text;
    EXPECT_EQ(count(text, "pigment"), 1U) << text;
    EXPECT_TRUE(has(text, "pigment { rgb <0.5, 0.25, 0.0> }"));
    EXPECT_TRUE(has(text, "ambient rgb <0.5, 1.0, 0.0> diffuse 1.0 specular 0.5 roughness 0.0625"));
    EXPECT_TRUE(has(text, "reflection { rgb <0.25, 0.5, 0.0> }"));
}

TEST(Pov, WhatAMaterialLacksIsLeftOut) {
    const std::string text = sphere_of("diffuse = rgb(0.5, 0.5, 0.5), ambient = rgb(0, 0, 0)").text;
    EXPECT_TRUE(has(text, "finish { diffuse 1.0 }"));
    EXPECT_FALSE(has(text, "reflection"));
    EXPECT_FALSE(has(text, "emission"));
}

TEST(Pov, ColoredHighlightsAreFilteredFromBelow) {
    const std::string text =
        sphere_of("diffuse = rgb(0.5, 0.5, 0.5), ambient = rgb(0, 0, 0), specular = rgb(0.5, 0.25, 0)").text;
    EXPECT_TRUE(has(text, "pigment { rgb 0.0 } finish { specular 1.0 roughness 0.03125 }"));
    EXPECT_TRUE(has(text, "pigment { rgb <1.0, 0.5, 0.0> filter 1 }"));
    EXPECT_TRUE(has(text, "pigment { rgb 0.5 transmit 0.5 } finish { diffuse 2.0 }"));
}

TEST(Pov, WhatIsBehindIsFilteredByTheBottomLayer) {
    const std::string half =
        sphere_of("diffuse = rgb(0.5, 0.5, 1), ambient = rgb(0, 0, 0), opacity = 0.5").text;
    EXPECT_TRUE(has(half, "texture { pigment { rgb 1.0 filter 1 } }")) << half;
    EXPECT_TRUE(has(half, "pigment { rgb <0.25, 0.25, 0.5> transmit 0.5 } finish { diffuse 2.0 }"));
    EXPECT_FALSE(has(half, "interior"));
    const std::string water = sphere_of("diffuse = rgb(0, 0, 0), transmit = rgb(1, 0.5, 0.25), ior = 1.33, "
                                        "specular = rgb(0.5, 0.5, 0.5), shininess = 16")
                                  .text;
    EXPECT_TRUE(
        has(water, "pigment { rgb <1.0, 0.5, 0.25> filter 1 } finish { specular 0.5 roughness 0.0625 }"))
        << water;
    EXPECT_TRUE(has(water, "interior { ior 1.33 }"));
}

TEST(Pov, AmbientOfADarkChannelGetsALayerOfItsOwn) {
    const std::string text = sphere_of("diffuse = rgb(0.5, 0.5, 0), ambient = rgb(0.25, 0.25, 0.25)").text;
    EXPECT_TRUE(has(text, "pigment { rgb 1.0 } finish { ambient rgb 0.5 }"));
    EXPECT_TRUE(has(text, "pigment { rgb <0.5, 0.5, 0.0> transmit 0.5 } finish { diffuse 2.0 }"));
}

TEST(Pov, EmissionIsExposed) {
    EXPECT_TRUE(has(sphere_of("diffuse = rgb(0, 0, 0), emission = rgb(1, 0.5, 0)").text,
                    "emission rgb scc_exposure*<1.0, 0.5, 0.0>"));
}

TEST(Pov, AMaterialOfManyObjectsIsDeclaredOnce) {
    const std::string text =
        exported("let red = phong { diffuse = rgb(0.75, 0, 0) }\n"
                 "sphere { material = red }\nbox { material = red, transform = translate(3, 0, 0) }")
            .text;
    EXPECT_EQ(count(text, "#declare m_red"), 1U) << text;
    EXPECT_EQ(count(text, "texture { m_red }"), 2U) << text;
}

TEST(Pov, ABackMaterialIsTheInteriorTexture) {
    const Exported e =
        exported("let a = phong { diffuse = rgb(1, 0, 0) }\nlet b = phong { diffuse = rgb(0, 1, 0) }\n"
                 "disc { material = two_sided { front = a, back = b } }");
    EXPECT_TRUE(has(e.text, "\n    texture { m_a }\n    interior_texture { m_b }\n"));
    ASSERT_NE(e.find("two_sided"), nullptr);
    EXPECT_EQ(e.find("two_sided")->fidelity, Fidelity::exact);
}

TEST(Pov, FlatTrianglesKeepTheirFrontInMirrorImages) {
    const auto corners = [](const std::string& transform) {
        const test::Compiled c = test::compile_shapes(
            "triangle { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], transform = " + transform + " }");
        EXPECT_TRUE(c.fine) << c.messages;
        Ledger ledger;
        return test::emit_pov(c.scene, ledger);
    };
    EXPECT_TRUE(has(corners("scale(2, 1, 1)"), "<0.0, 0.0, 0.0>, <0.0, 1.0, 0.0>, <2.0, 0.0, 0.0>"));
    EXPECT_TRUE(has(corners("scale(-2, 1, 1)"), "<0.0, 0.0, 0.0>, <-2.0, 0.0, 0.0>, <0.0, 1.0, 0.0>"));
}

// ---- per-point functions ---------------------------------------------------------------------------------

constexpr const char* checker = "fn checker(s: surface) -> color =\n"
                                "  if ((floor(s.p.x) + floor(s.p.z)) % 2 == 0) rgb(0.8, 0.7, 0.6) else "
                                "rgb(0.1, 0.2, 0.3)\n";

TEST(Pov, CheckersAreOneConditionAndTwoColors) {
    const std::string text =
        exported(std::string(checker) + "plane { material = phong { diffuse = checker } }").text;
    EXPECT_TRUE(has(text, "#declare f_checker = function(x, y, z)"));
    EXPECT_TRUE(has(text,
                    "function { f_checker(x, y, z) } color_map { [0 rgb <0.1, 0.2, 0.3>] [1 rgb <0.8, 0.7, "
                    "0.6>] }") ||
                has(text, "color_map { [0 rgb <0.1, 0.2, 0.3>] [1 rgb <0.8, 0.7, 0.6>] }"));
    EXPECT_FALSE(has(text, "average"));
}

TEST(Pov, ObjectSpaceFunctionsMoveWithTheShape) {
    const std::string text =
        exported(std::string(checker) +
                 "box { material = phong { diffuse = checker }, transform = rotate_y(30deg) }")
            .text;
    EXPECT_LT(text.find("texture { m_", text.find("\nbox {")), text.find("matrix <"));
}

TEST(Pov, WorldSpaceFunctionsStayWhereTheyAre) {
    const std::string text =
        exported("fn stripes(s: surface) -> color = if (s.world.x > 0) rgb(1, 0, 0) else rgb(0, 1, 0)\n"
                 "box { material = phong { diffuse = stripes }, transform = rotate_y(30deg) }")
            .text;
    EXPECT_GT(text.find("texture { m_", text.find("\nbox {")), text.find("matrix <"));
}

TEST(Pov, ColorsOfThreeFunctionsAreAveraged) {
    const std::string text =
        exported("fn waves(s: surface) -> color = rgb(0.5 + 0.5 * sin(s.p.x), 0.5 + 0.5 * sin(s.p.y), 0.25)\n"
                 "sphere { material = phong { diffuse = waves } }")
            .text;
    EXPECT_TRUE(has(text, "average pigment_map"));
    EXPECT_TRUE(has(text, "#declare f_waves_red = "));
    EXPECT_TRUE(has(text, "#declare f_waves_green = "));
}

TEST(Pov, SharedValuesAreCalculatedOnce) {
    const std::string text =
        exported("fn f(s: surface) -> number {\n  let a = sin(s.p.x * 3 + s.p.y)\n  a * a + 2\n}\n"
                 "sphere { material = phong { specular = rgb(1, 1, 1), shininess = f } }")
            .text;
    EXPECT_EQ(count(text, "sin("), 1U) << text;
}

TEST(Pov, FunctionsOfTheNormalAreDroppedWithTheReason) {
    const Exported e = exported("fn f(s: surface) -> color = rgb(abs(s.n.x), abs(s.n.y), abs(s.n.z))\n"
                                "sphere { material = phong { diffuse = f, ambient = rgb(0, 0, 0) } }");
    ASSERT_NE(e.find("phong diffuse"), nullptr);
    EXPECT_EQ(e.find("phong diffuse")->fidelity, Fidelity::dropped);
    EXPECT_TRUE(has(e.find("phong diffuse")->how, "normal"));
}

TEST(Pov, UnboundedFunctionsAreCutAndSaySo) {
    const Exported e = exported("fn f(s: surface) -> color = rgb(abs(s.p.x), 0.5, abs(s.p.z))\n"
                                "plane { material = phong { diffuse = f, ambient = rgb(0, 0, 0) } }");
    ASSERT_NE(e.find("phong diffuse"), nullptr);
    EXPECT_EQ(e.find("phong diffuse")->fidelity, Fidelity::approximated);
    EXPECT_GT(e.find("phong diffuse")->bound, 0);
}

TEST(Pov, BoundsOfTheShapeBoundTheFunction) {
    const Exported e =
        exported("fn f(s: surface) -> color = rgb(abs(s.p.x), 0.5, abs(s.p.z))\n"
                 "sphere { radius = 0.5, material = phong { diffuse = f, ambient = rgb(0, 0, 0) } }");
    ASSERT_NE(e.find("phong diffuse"), nullptr);
    EXPECT_EQ(e.find("phong diffuse")->fidelity, Fidelity::exact);
}

// ---- lights ----------------------------------------------------------------------------------------------

std::string light(const std::string& fields) {
    return "sphere { material = phong { specular = rgb(1, 1, 1) } }\nperspective_camera { }\npoint_light { "
           "position = "
           "(0, 5, 5), " +
           fields + " }\n";
}

Exported lit(const std::string& fields) {
    const test::Compiled c = test::compile(light(fields));
    EXPECT_TRUE(c.fine) << c.messages;
    return exported(c.scene);
}

TEST(Pov, LightsAreExposed) {
    EXPECT_TRUE(has(lit("color = rgb(0.5, 1, 2)").text, "rgb scc_exposure*<0.5, 1.0, 2.0> }"));
}

TEST(Pov, QuadraticAttenuationIsOneLight) {
    const Exported e = lit("attenuation = (1, 0, 0.25)");
    EXPECT_EQ(count(e.text, "light_source"), 1U) << e.text;
    EXPECT_TRUE(has(e.text, "rgb scc_exposure*0.5 fade_distance 2.0 fade_power 2.0"));
    EXPECT_EQ(e.find("point_light attenuation")->fidelity, Fidelity::exact);
}

TEST(Pov, AttenuationWithComplexRootsStatesItsBound) {
    const Exported e = lit("attenuation = (1, 0.05, 0.01)");
    const LedgerEntry* entry = e.find("point_light attenuation");
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->fidelity, Fidelity::approximated);
    EXPECT_GT(entry->bound, 0);
    EXPECT_LT(entry->bound, 2e-6);
}

TEST(Pov, AHighlightColorOfItsOwnNeedsShadowlessLights) {
    const std::string text = lit("color = rgb(1, 1, 1), specular = rgb(0, 0.5, 1)").text;
    EXPECT_TRUE(has(text, "rgb scc_exposure*<1.0, 0.5, 0.0> shadowless }"));
    EXPECT_TRUE(
        has(text, "rgb scc_exposure*<-1.0, -0.5, -0.0> shadowless projected_through { scc_objects }"));
    EXPECT_TRUE(has(text, "#declare scc_objects = union {"));
    EXPECT_FALSE(has(lit("color = rgb(1, 1, 1)").text, "union"));
}

// ---- frames ----------------------------------------------------------------------------------------------

TEST(Pov, ScenesOfOrdinarySizeKeepTheirNumbers) {
    const std::string text = exported("sphere { center = (0.1, 0.2, 0.3), radius = 0.7 }").text;
    EXPECT_TRUE(has(text, "<0.1, 0.2, 0.3>, 0.7"));
    EXPECT_FALSE(has(text, "tolerances"));
}

TEST(Pov, TinyScenesAreEnlargedByAPowerOfTwo) {
    const test::Compiled c =
        test::compile("sphere { radius = 0.0001 }\npoint_light { position = (0, 0, 0.001), "
                      "attenuation = (1, 100, 0) }\n"
                      "perspective_camera { eye = (0, 0, 0.001) }\n");
    ASSERT_TRUE(c.fine) << c.messages;
    const Exported e = exported(c.scene);
    EXPECT_TRUE(has(e.text, "written as 8192.0 (p - <0.0, 0.0, 0.0>)"));
    EXPECT_TRUE(has(e.text, "location <0.0, 0.0, 8.192>"));
    EXPECT_TRUE(has(e.text, "<0.0, 0.0, 0.0>, 0.8192"));
    EXPECT_TRUE(has(e.text, "fade_distance 81.92"));
    EXPECT_NE(e.find("world"), nullptr);
}

TEST(Pov, ScenesFarFromTheOriginAreBroughtBack) {
    const test::Compiled c =
        test::compile("sphere { center = (8000000, 0, 0) }\n"
                      "point_light { position = (8000000, 0, 5) }\n"
                      "perspective_camera { eye = (8000000, 0, 5), target = (8000000, 0, 0) }\n");
    ASSERT_TRUE(c.fine) << c.messages;
    EXPECT_TRUE(has(exported(c.scene).text, "location <0.0, 0.0, 5.0>"));
}

// ---- names -----------------------------------------------------------------------------------------------

TEST(Pov, NamesCannotLeaveTheirPlace) {
    const std::string bad = "x\" } #include \"/etc/passwd\" */ /* \\\n#declare y = 1;\r\n";
    test::Compiled c =
        test::compile_shapes(std::string(checker) + "box { material = phong { diffuse = checker } }");
    ASSERT_TRUE(c.fine) << c.messages;
    run_passes(c.scene);
    c.scene.name = bad;
    c.scene.objects[0].path = bad;
    c.scene.materials[0].name = bad;
    c.scene.lights[0].name = bad;
    c.scene.functions[0].name = bad;
    Ledger ledger;
    const std::string text = test::emit_pov(c.scene, ledger);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        const std::string line = text.substr(at, text.find('\n', at) - at);
        if (const auto found = line.find("passwd"); found != std::string::npos) {
            const bool comment = line.find("//") < found;
            const bool identifier = line.find("x_include_etc_passwd_declare_y_1") != std::string::npos;
            EXPECT_TRUE(comment || identifier) << line;
        }
    }
    EXPECT_FALSE(has(text, "\n#include"));
    EXPECT_FALSE(has(text, "*/"));
    EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Pov, ReservedWordsAreNoIdentifiers) {
    const std::string text =
        exported("let sphere2 = phong { }\nlet torus = phong { diffuse = rgb(0.25, 0, 0) }\n"
                 "sphere { material = torus }")
            .text;
    EXPECT_TRUE(has(text, "#declare m_torus = "));
}

TEST(Pov, EveryObjectLightAndMaterialIsInTheLedger) {
    const Exported e = exported("sphere { }\nbox { }\nplane { }");
    for (const char* feature : {"sphere", "box", "plane", "point_light", "phong", "perspective_camera"}) {
        EXPECT_NE(e.find(feature), nullptr) << feature;
    }
}

} // namespace
} // namespace scc::compiler
