#include "validation/doctor.h"
#include "validation/renderers.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;
using runtime::Image;

/// Left half of a plane of the pictures: background; right half: an emitting box. `body` may add to it.
std::string povray_scene(const std::string& body = "") {
    return "#version 3.7;\n"
           "global_settings { assumed_gamma 1.0 max_trace_level 5 adc_bailout 0 ambient_light rgb 1 }\n"
           "#ifndef (scc_exposure) #declare scc_exposure = 1; #end\n"
           "camera { orthographic location <0, 0, 5> direction -z right 4*x up 3*y }\n"
           "background { rgb scc_exposure*<.25, .5, 3> }\n"
           "box { <0.25, -9, -1>, <9, 9, 0> pigment { rgb 1 } finish { ambient 0 emission scc_exposure*.5 "
           "diffuse 0 } }\n" +
           body;
}

std::string blender_scene(const std::string& body = "") {
    return R"(import argparse, os, sys
import bpy
parser = argparse.ArgumentParser()
parser.add_argument("--render")
parser.add_argument("--size")
options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
for block in list(bpy.data.objects):
    bpy.data.objects.remove(block)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = 1
scene.cycles.use_denoising = False
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.25, 0.5, 3, 1)
scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(scene.camera)
width, height = map(int, options.size.split("x"))
scene.render.resolution_x, scene.render.resolution_y = width, height
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = os.path.abspath(options.render)
)" + body + "bpy.ops.render.render(write_still=True)\n";
}

class Renderers : public testing::Test {
protected:
    RenderJob job(const std::string& name, const std::string& text) const {
        std::ofstream(source_.path() / name) << text;
        RenderJob result;
        result.scene = source_.path() / name;
        result.folder = folder_.path();
        result.width = 32;
        result.height = 24;
        result.threads = 2;
        result.timeout_seconds = 120;
        return result;
    }
    const fs::path& folder() const { return folder_.path(); }

private:
    ScratchFolder source_;
    ScratchFolder folder_;
};

class Povray : public Renderers {
protected:
    void SetUp() override {
        if (!find_program("povray"))
            GTEST_SKIP() << "POV-Ray is not installed";
    }
};

class Blender : public Renderers {
protected:
    void SetUp() override {
        if (!find_program("blender"))
            GTEST_SKIP() << "Blender is not installed";
    }
};

constexpr double half_step = 0.5 / 65535 + 1e-7;

TEST_F(Povray, DrawsLinearLightWithThePictureTheRightWayUp) {
    RenderJob povray_job =
        job("a.pov", povray_scene("box { <-9, 0.25, -1>, <9, 9, 1> pigment { rgb 1 } finish { "
                                  "ambient 0 emission 0.125 diffuse 0 } }\n"));
    povray_job.brightest = 1;
    const RenderResult result = render_with_povray(povray_job);
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.image.width, 32);
    EXPECT_EQ(result.image.height, 24);
    EXPECT_NEAR(result.image.at(2, 2)[0], 0.125, half_step);
    EXPECT_NEAR(result.image.at(2, 20)[0], 0.25, half_step);
    EXPECT_NEAR(result.image.at(30, 20)[0], 0.5, half_step);
    EXPECT_EQ(result.image.at(2, 20)[2], 1) << "cut off without an exposure";
}

TEST_F(Povray, ExposureFollowsTheReferenceAndIsDividedOut) {
    RenderJob povray_job = job("a.pov", povray_scene());
    povray_job.brightest = 3;
    const RenderResult result = render_with_povray(povray_job);
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.exposure, 0.25);
    EXPECT_NEAR(result.image.at(2, 20)[2], 3, 4 * half_step);
    EXPECT_NEAR(result.image.at(30, 2)[1], 0.5, 4 * half_step);
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
}

TEST_F(Povray, CutOffValuesAreWarnedOf) {
    RenderJob povray_job = job("a.pov", povray_scene());
    povray_job.brightest = 0.75;
    const RenderResult result = render_with_povray(povray_job);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_NE(result.warnings[0].find("reach the end of the file's range"), std::string::npos);
}

TEST_F(Povray, SamplesAreABoxFilterOverARegularGrid) {
    RenderJob povray_job = job("a.pov", povray_scene());
    povray_job.samples_per_axis =
        4; // the box begins at x = 18, that is 2 of 32 units of 4/32: sample 72 of 128
    povray_job.brightest = 3;
    const RenderResult result = render_with_povray(povray_job);
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.image.width, 32);
    EXPECT_NEAR(result.image.at(17, 5)[0], 0.25, 4 * half_step);
    EXPECT_NEAR(result.image.at(18, 5)[0], 0.5, 4 * half_step);

    RenderJob shifted =
        job("b.pov", povray_scene("box { <-9, -9, 1>, <0.0313, 9, 2> pigment { rgb 1 } finish { ambient "
                                  "0 emission 0 diffuse 0 } }\n"));
    shifted.samples_per_axis = 4; // ends a quarter into pixel 16
    shifted.brightest = 3;
    EXPECT_NEAR(render_with_povray(shifted).image.at(16, 5)[0], 0.25 * 0.75, 4 * half_step);
}

TEST_F(Povray, TellsItsTimesVersionWarningsAndCommand) {
    RenderJob povray_job =
        job("a.pov", povray_scene("triangle { <0,0,0>, <0,0,0>, <1,0,0> pigment { rgb 1 } }\n"));
    povray_job.brightest = 2.5;
    povray_job.no_bounding = true;
    const RenderResult result = render_with_povray(povray_job);
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.command, "povray +Iscene.pov +Opovray.png +W32 +H24 +FN16 File_Gamma=1.0 -A -D +WT2 -MB "
                              "Declare=scc_exposure=0.25");
    EXPECT_EQ(result.version.find("POV-Ray 3."), 0U);
    EXPECT_EQ(result.version, povray_version());
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_NE(result.warnings[0].find("Degenerate triangle"), std::string::npos);
    EXPECT_TRUE(result.times.parse && result.times.bounding && result.times.trace && result.times.total);
    EXPECT_GT(*result.times.total, *result.times.trace);
    EXPECT_EQ(result.log.find(folder().string()), std::string::npos);
}

TEST_F(Povray, SceneErrorIsTheReason) {
    const RenderResult result = render_with_povray(job("a.pov", "#version 3.7;\nsphere { 0, 1 pigmentx }\n"));
    EXPECT_EQ(result.status, RenderStatus::failed);
    EXPECT_NE(result.reason.find("line 2: Parse Error: No matching } in 'sphere'"), std::string::npos)
        << result.reason;
    EXPECT_NE(result.reason.find("exit status 1"), std::string::npos);
    EXPECT_TRUE(result.image.pixels.empty());
}

TEST_F(Povray, EndlessSceneIsTimedOut) {
    RenderJob povray_job = job("a.pov", "#version 3.7;\n#declare I = 0;\n#while (I < 1) #end\n");
    povray_job.timeout_seconds = 1.5;
    const RenderResult result = render_with_povray(povray_job);
    EXPECT_EQ(result.status, RenderStatus::timed_out);
    EXPECT_EQ(result.reason, "no end after 1.5 s");
}

TEST_F(Povray, PictureOfAnEarlierRunIsNotTaken) {
    std::ofstream(folder() / "povray.png") << "old";
    const RenderResult result = render_with_povray(job("a.pov", "#version 3.7;\n#error \"stop\"\n"));
    EXPECT_EQ(result.status, RenderStatus::failed);
    EXPECT_FALSE(fs::exists(folder() / "povray.png"));
}

TEST_F(Blender, DrawsLinearFloatLightAndTellsItsTimes) {
    const RenderResult result = render_with_blender(job("a.py", blender_scene()));
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.image.width, 32);
    EXPECT_EQ(result.image.height, 24);
    EXPECT_NEAR(result.image.at(5, 5)[0], 0.25, 1e-6);
    EXPECT_NEAR(result.image.at(31, 23)[2], 3, 1e-6);
    EXPECT_EQ(result.command,
              "blender -b --factory-startup --python-exit-code 1 -t 2 -P scene.py -- --render "
              "blender.exr --size 32x24");
    EXPECT_EQ(result.version.find("Blender "), 0U);
    EXPECT_TRUE(result.times.trace && result.times.saving && result.times.start_up && result.times.total);
    EXPECT_EQ(result.log.find(folder().string()), std::string::npos) << result.log;
}

TEST_F(Blender, SamplesAreAveraged) {
    RenderJob blender_job = job("a.py", blender_scene("assert (width, height) == (64, 48)\n"));
    blender_job.samples_per_axis = 2;
    const RenderResult result = render_with_blender(blender_job);
    ASSERT_EQ(result.status, RenderStatus::done) << result.reason << result.log;
    EXPECT_EQ(result.image.width, 32);
}

TEST_F(Blender, ScriptErrorIsTheReason) {
    const RenderResult result = render_with_blender(job("a.py", "raise RuntimeError(\"bad thing\")\n"));
    EXPECT_EQ(result.status, RenderStatus::failed);
    EXPECT_EQ(result.reason, "RuntimeError: bad thing (exit status 1)");
}

TEST_F(Blender, MissingPictureIsAFailure) {
    const RenderResult result = render_with_blender(job("a.py", "pass\n"));
    EXPECT_EQ(result.status, RenderStatus::failed);
    EXPECT_EQ(result.reason, "cannot read `blender.exr`: No such file or directory");
}

class EmptyPath {
public:
    EmptyPath() : path_(std::getenv("PATH")) { ::setenv("PATH", "/no/such/folder", 1); }
    ~EmptyPath() { ::setenv("PATH", path_.c_str(), 1); }

private:
    std::string path_;
};

TEST_F(Renderers, ThatAreNotInstalledAreMissingNotFailed) {
    const EmptyPath nothing;
    EXPECT_EQ(render_with_povray(job("a.pov", "")).status, RenderStatus::missing);
    EXPECT_EQ(render_with_povray(job("a.pov", "")).reason, "POV-Ray is not installed");
    EXPECT_EQ(render_with_blender(job("a.py", "")).status, RenderStatus::missing);
    EXPECT_FALSE(povray_version());
    EXPECT_FALSE(blender_version());
}

TEST(Doctor, ListsEveryToolFoundOrNot) {
    const std::vector<Tool> tools = find_tools();
    ASSERT_EQ(tools.size(), 7U);
    // Ours lies beside the programs that look for it, and on the path only where it is installed.
    const auto is_ours = [](const Tool& tool) { return tool.name == "scc-opengl"; };
    for (const Tool& tool : tools) {
        EXPECT_EQ(tool.found, tool.name == "numpy" ? tool.version.starts_with("numpy ")
                              : is_ours(tool)      ? find_opengl_program().has_value()
                                                   : find_program(tool.name).has_value())
            << tool.name;
        EXPECT_EQ(tool.found, !tool.version.empty()) << tool.name;
        EXPECT_EQ(tool.version.find('/'), std::string::npos) << tool.version;
        EXPECT_EQ(tool.how_to_get.find("apt install "), 0U);
    }
    const EmptyPath nothing;
    for (const Tool& tool : find_tools())
        EXPECT_TRUE(!tool.found || is_ours(tool)) << tool.name;
    EXPECT_EQ(to_json(tools)[3]["name"], "povray");
}

TEST(Exposure, IsTheLargestPowerOfTwoThatFits) {
    EXPECT_EQ(exposure_for(0), 1);
    EXPECT_EQ(exposure_for(1), 1);
    EXPECT_EQ(exposure_for(1.01), 0.5);
    EXPECT_EQ(exposure_for(2), 0.5);
    EXPECT_EQ(exposure_for(2.1), 0.25);
    EXPECT_EQ(exposure_for(1000), 1.0 / 1024);
}

TEST(BrightestValue, IgnoresWhatIsNotFinite) {
    Image image(2, 1, 1);
    image.pixels = {std::numeric_limits<float>::infinity(), 2.5F};
    EXPECT_EQ(brightest_value(image), 2.5);
    EXPECT_EQ(brightest_value(Image(2, 2)), 0);
}

} // namespace
} // namespace scc::validation
