#include "compiler/cli/test/support.h"
#include "runtime/host/png.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <unistd.h>

namespace scc::cli::test {
namespace {

using Lines = std::vector<std::string>;

TEST_F(CommandLine, BuildSaysWhatItsOutputDependsOn) {
    std::filesystem::create_directory(path("my parts"));
    write("my parts/ball.scn", "let ball = mesh { file = \"one.obj\" }\n");
    write("my parts/one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("s.scn", "import \"my parts/ball.scn\" as parts\nparts.ball\n");
    ASSERT_TRUE(scc({"build", "s.scn", "--emit", "ir", "-o", "out$1.ir", "-d", "s.d"}).ok());
    EXPECT_EQ(read("s.d"), "out$$1.ir: s.scn \\\n  my\\ parts/ball.scn \\\n  my\\ parts/one.obj\n"
                           "\nmy\\ parts/ball.scn:\n\nmy\\ parts/one.obj:\n");
    EXPECT_EQ(scc({"build", "s.scn", "--emit", "ir", "-o", "-", "-d", "t.d"}).code, 2);
    write("s.scn", "sphere { radius = -1 }\n");
    EXPECT_EQ(scc({"build", "s.scn", "--emit", "ir", "-o", "o", "-d", "t.d"}).code, 1);
    EXPECT_FALSE(exists("t.d"));
}

TEST_F(CommandLine, HelpNamesEveryCommand) {
    const auto result = scc({"--help"});
    EXPECT_TRUE(result.ok());
    for (const char* command : {"check", "fmt", "params", "render", "build", "export", "import", "validate",
                                "stability", "explain", "compare", "doctor", "reference"}) {
        EXPECT_NE(result.out.find(command), std::string::npos) << command;
    }
}

TEST_F(CommandLine, UsageMistakesExitWith2) {
    write("s.scn", small_scene);
    for (const Lines& arguments :
         std::vector<Lines>{{},
                            {"paint", "s.scn"},
                            {"render", "s.scn"},
                            {"render", "s.scn", "-o", "a.jpeg"},
                            {"render", "s.scn", "-o", "-"},
                            {"render", "s.scn", "-o", "a.png", "--size", "640"},
                            {"render", "s.scn", "-o", "a.png", "--size", "0x5"},
                            {"render", "s.scn", "-o", "a.png", "--samples", "5"},
                            {"render", "s.scn", "-o", "a.png", "--samples", "4097"},
                            {"render", "s.scn", "-o", "a.png", "--filter", "tent"},
                            {"render", "s.scn", "-o", "a.png", "--crop", "5,5,1,1"},
                            {"render", "s.scn", "-o", "a.png", "--crop", "0,0,5000,10"},
                            {"render", "s.scn", "-o", "a.png", "--bits", "12"},
                            {"render", "s.scn", "-o", "a.png", "--threads", "0"},
                            {"render", "s.scn", "-o", "a.png", "-D", "x"},
                            {"render", "s.scn", "-o", "a.png", "--no-such-option"},
                            {"export", "maya", "s.scn", "-o", "a"},
                            {"import", "maya", "s.scn", "-o", "a"},
                            {"import", "nff", "s.scn"},
                            {"import", "obj"},
                            {"validate", "s.scn", "--against", "maya", "--report", "r"},
                            {"stability", "s.scn", "--against", "maya"},
                            {"stability", "no_such_case"}}) {
        const auto result = scc(arguments);
        std::string line;
        for (const std::string& argument : arguments) {
            line += argument + " ";
        }
        EXPECT_EQ(result.code, 2) << line << result.err;
        EXPECT_FALSE(result.err.empty()) << line;
    }
    EXPECT_EQ(files(), (Lines{"s.scn"}));
}

TEST_F(CommandLine, WrongScenesExitWith1AndSayWhere) {
    const std::pair<const char*, const char*> cases[] = {
        {"sphere { radios = 1 }",
         "s.scn:1:10: error: sphere has no field `radios`; did you mean `radius`? [unknown-field]"},
        {"perspective_camera { fov_y = 40 }",
         "s.scn:1:30: error: `fov_y` takes an angle, this is a number [angle-expected]"},
        {"mesh { file = \"none.obj\" }", "s.scn:1:15: error: cannot read `none.obj`"},
        {"print(\"abc)\n", "s.scn:1:7: error: "},
        {"sky_light { }", "not supported yet"},
    };
    for (const auto& [text, message] : cases) {
        write("s.scn", text);
        const auto result = scc({"render", "s.scn", "-o", "a.png"});
        EXPECT_EQ(result.code, 1) << text << "\n" << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    }
    EXPECT_EQ(files(), (Lines{"s.scn"}));
}

TEST_F(CommandLine, DeepNestingIsAClearError) {
    write("s.scn", "let a = " + std::string(200, '(') + "1" + std::string(200, ')') + "\n" + small_scene);
    const auto result = scc({"check", "s.scn"});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("[nesting-too-deep]"), std::string::npos) << result.err;
}

TEST_F(CommandLine, MissingSceneFileExitsWith3) {
    const auto result = scc({"check", "none.scn"});
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.err, "scc: error: cannot read `none.scn`: there is no such file\n");
}

TEST_F(CommandLine, UnwritableOutputsExitWith3) {
    write("s.scn", small_scene);
    for (const char* output : {"no/such/folder/a.png", "/proc/a.png", "/dev/full.png/a.png"}) {
        EXPECT_EQ(scc({"render", "s.scn", "-o", output, "--size", "8x8"}).code, 3) << output;
    }
    EXPECT_EQ(scc({"export", "pov", "s.scn", "-o", "no/such/folder/a.pov"}).code, 3);
    EXPECT_EQ(scc({"build", "s.scn", "--emit", "ir", "-o", "/dev/full"}).code, 3);
}

TEST_F(CommandLine, NoCompilerExitsWith3) {
    write("s.scn", small_scene);
    const auto chosen = scc({"build", "s.scn", "-o", "prog"}, {{"CXX", "no-such-compiler"}});
    EXPECT_EQ(chosen.code, 3);
    EXPECT_NE(chosen.err.find("there is no C++ compiler `no-such-compiler`"), std::string::npos)
        << chosen.err;
    const auto none = scc({"build", "s.scn", "-o", "prog"}, {{"PATH", "/nowhere"}, {"CXX", ""}});
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("apt install g++"), std::string::npos) << none.err;
    EXPECT_FALSE(exists("prog"));
}

TEST_F(CommandLine, MissingRenderersAreSkippedAndNeverPassed) {
    write("s.scn", small_scene);
    const auto result =
        scc({"validate", "s.scn", "--against", "pov,blender", "--report", "out", "--size", "16x12"},
            {{"PATH", "/nowhere"}});
    EXPECT_EQ(result.code, 3) << result.out << result.err;
    EXPECT_NE(result.out.find("0 passed, 0 failed, 2 skipped"), std::string::npos) << result.out;
}

TEST_F(CommandLine, CheckReportsAllMistakesOfAllFilesInOneRun) {
    write("a.scn", "sphere { radios = 1 }\nbox { mim = (0, 0, 0) }\n");
    write("b.scn", "plane { normal = 3 }\n");
    const auto result = scc({"check", "a.scn", "b.scn"});
    EXPECT_EQ(result.code, 1);
    for (const char* place : {"a.scn:1:10: error", "a.scn:2:7: error", "b.scn:1:18: error"}) {
        EXPECT_NE(result.err.find(place), std::string::npos) << place << "\n" << result.err;
    }
}

// Exactly these, each at its place, and nothing that follows from them.
TEST_F(CommandLine, CheckTellsTwentyMistakesApart) {
    const std::string mistakes = SCC_SOURCE_DIR "/compiler/cli/test/mistakes/";
    std::filesystem::copy(mistakes + "twenty.scn", path("twenty.scn"));
    std::filesystem::copy(mistakes + "twenty.txt", path("twenty.txt"));
    const auto result = scc({"check", "twenty.scn"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, read("twenty.txt"));
    const auto json = nlohmann::json::parse(scc({"check", "--json", "twenty.scn"}).out);
    EXPECT_EQ(json["diagnostics"].size(), 20U);
}

TEST_F(CommandLine, CheckWritesJson) {
    write("a.scn", std::string("sphere { radios = 1 }\n") + small_scene);
    const auto result = scc({"check", "--json", "a.scn"});
    EXPECT_EQ(result.code, 1);
    const auto json = nlohmann::json::parse(result.out);
    ASSERT_EQ(json["diagnostics"].size(), 1U);
    EXPECT_EQ(json["diagnostics"][0]["name"], "unknown-field");
    EXPECT_EQ(json["diagnostics"][0]["place"]["line"], 1);
    EXPECT_EQ(json["diagnostics"][0]["fix"]["replacement"], "radius");
}

TEST_F(CommandLine, StrictTurnsWarningsIntoErrors) {
    write("a.scn", std::string("let unused = 3\n") + small_scene);
    EXPECT_EQ(scc({"check", "a.scn"}).code, 0);
    EXPECT_EQ(scc({"check", "--strict", "a.scn"}).code, 1);
}

TEST_F(CommandLine, FixesAreMadeInTheFile) {
    const std::string mended =
        "sphere { radius = 1, transform = rotate_x(30deg) then rotate_y(2deg) }\n" + std::string(small_scene);
    write("a.scn",
          "sphere { radios: 1, transform = rotate_x(30) then rotate_y(2 deg) }\n" + std::string(small_scene));
    const auto result = scc({"check", "--fix", "a.scn"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "a.scn: 4 fixes made\n");
    EXPECT_EQ(read("a.scn"), mended);
    EXPECT_EQ(scc({"check", "--fix", "a.scn"}).err, "");
    EXPECT_EQ(read("a.scn"), mended);
    EXPECT_EQ(files(), (Lines{"a.scn"}));
}

TEST_F(CommandLine, WhatHasNoFixStaysAndIsSaid) {
    write("a.scn", std::string("sphere { radios = -1 }\nlet unused = sin(90)\n") + small_scene);
    const auto result = scc({"check", "--fix", "--json", "a.scn"});
    EXPECT_EQ(result.code, 1);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["fixed"], 2);
    ASSERT_EQ(json["diagnostics"].size(), 2U);
    EXPECT_EQ(json["diagnostics"][0]["name"], "value-out-of-range");
    EXPECT_EQ(json["diagnostics"][1]["name"], "unused-let");
    EXPECT_EQ(read("a.scn"), std::string("sphere { radius = -1 }\nlet unused = sin(90deg)\n") + small_scene);
}

TEST_F(CommandLine, LayoutIsMadeInPlaceAndChecked) {
    const std::string laid_out = "sphere { radius = 1 }  // round\n";
    write("a.scn", "sphere{radius=1} // round");
    write("b.scn", laid_out);
    write("c.scn", "sphere{");
    const auto checked = scc({"fmt", "--check", "a.scn", "b.scn"});
    EXPECT_EQ(checked.code, 1);
    EXPECT_EQ(checked.out, "a.scn\n");
    EXPECT_EQ(read("a.scn"), "sphere{radius=1} // round");
    EXPECT_EQ(scc({"fmt", "a.scn", "b.scn"}).code, 0);
    EXPECT_EQ(read("a.scn"), laid_out);
    EXPECT_EQ(read("b.scn"), laid_out);
    EXPECT_EQ(scc({"fmt", "--check", "a.scn", "b.scn"}).code, 0);
    const auto wrong = scc({"fmt", "c.scn", "a.scn"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.err.find("c.scn:1:7: error: this `{` is never closed"), std::string::npos) << wrong.err;
    EXPECT_EQ(read("c.scn"), "sphere{");
    EXPECT_EQ(scc({"fmt", "none.scn"}).code, 3);
    const auto piped = start("/bin/sh", {"-c", "printf 'sphere{}' | " SCC_PROGRAM " fmt -"});
    EXPECT_EQ(piped.out, "sphere { }\n");
    EXPECT_EQ(files(), (Lines{"a.scn", "b.scn", "c.scn"}));
}

TEST_F(CommandLine, ParamsAreListedAndSet) {
    write("a.scn", std::string("param size: number = 1 in 0..5 \"of the ball\"\nsphere { center = (9, 0, 0), "
                               "radius = size + 0.1 }\n") +
                       small_scene);
    EXPECT_EQ(scc({"params", "a.scn"}).out, "size: number = 1 in 0..5  // of the ball\n");
    const auto json = nlohmann::json::parse(scc({"params", "--json", "a.scn", "-D", "size=2"}).out);
    EXPECT_EQ(json["params"][0]["value"], "2");
    EXPECT_NE(scc({"build", "a.scn", "--emit", "ir", "-o", "-", "-D", "size=2"}).out.find("radius = 2.1"),
              std::string::npos);
    EXPECT_EQ(scc({"check", "a.scn", "-D", "size=7"}).code, 1);
    EXPECT_EQ(scc({"check", "a.scn", "-D", "sise=2"}).code, 1);
}

TEST_F(CommandLine, RendersEveryImageTypeWithStatistics) {
    write("s.scn", small_scene);
    for (const char* file : {"a.png", "a.exr", "a.pfm"}) {
        const auto result = scc({"render", "s.scn", "-o", file, "--size", "32x24", "--stats", "-"});
        ASSERT_TRUE(result.ok()) << result.err;
        EXPECT_TRUE(exists(file));
        const auto stats = nlohmann::json::parse(result.out);
        EXPECT_EQ(stats["rays"]["primary"], 32 * 24);
        EXPECT_EQ(stats["size"], nlohmann::json({32, 24}));
        for (const char* key : {"schema", "scene", "samples", "threads", "precision", "isa", "times_ms",
                                "mrays_per_s", "peak_rss_mb", "features"}) {
            EXPECT_TRUE(stats.contains(key)) << key;
        }
    }
}

// Float where an 8-bit picture does not show it.
TEST_F(CommandLine, AutoPrecisionDependsOnSceneAndFile) {
    const std::string ball = "sphere { center = (C, 0, 0), material = phong { shininess = 50 } }\n"
                             "perspective_camera { eye = (C, 1, 5), target = (C, 0, 0) }\n"
                             "point_light { position = (C, 4, 5) }\n";
    write("near.scn", "let C = 0\n" + ball);
    write("far.scn", "let C = 1e6\nsphere { }\n" + ball);
    const auto choice = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", "--stats", "-"});
        const auto result = scc(options);
        EXPECT_TRUE(result.ok()) << result.err;
        const auto stats = nlohmann::json::parse(result.out);
        return std::string(stats["precision"]) + ": " + std::string(stats["precision_reason"]);
    };
    const auto expect = [&](const std::string& chosen, const char* precision, const char* reason) {
        EXPECT_TRUE(chosen.starts_with(precision)) << chosen;
        EXPECT_NE(chosen.find(reason), std::string::npos) << chosen;
    };
    const std::string chosen = choice({"near.scn", "-o", "a.png"});
    expect(chosen, "float", "steps off in a trial");
    EXPECT_EQ(chosen, choice({"near.scn", "-o", "a.PNG", "--threads", "3", "--crop", "0,0,8,8"}));
    EXPECT_EQ(chosen, choice({"near.scn", "-o", "a.png", "--precision", "auto"}));
    expect(choice({"near.scn", "-o", "a.png", "--bits", "16"}), "double", "more than 8 bits");
    expect(choice({"near.scn", "-o", "a.exr"}), "double", "more than 8 bits");
    expect(choice({"near.scn", "-o", "a.png", "--size", "80x60"}), "double", "too small");
    expect(choice({"far.scn", "-o", "a.png"}), "double", "size from the origin");
    expect(choice({"far.scn", "-o", "a.png", "--precision", "float"}), "float", "asked for");

    expect(choice({example("mesh.scn"), "-o", "a.png", "--size", "320x240"}), "float",
           "steps off in a trial");

    // A trial finds what no single number shows: float digits that run out in a function of the point.
    write("stripes.scn", "let C = 0\n" + ball +
                             "plane { material = phong { diffuse = fn(s: surface) = "
                             "rgb(0.5 + 0.5 * sin(1e6 * s.p.x), 0.5, 0.5) } }\n");
    expect(choice({"stripes.scn", "-o", "a.png"}), "double", "steps off in a trial");
}

TEST_F(CommandLine, ThreadsCropAndRepetitionGiveTheSameBits) {
    const std::string scene = example("lecture.scn");
    ASSERT_TRUE(
        scc({"render", scene, "-o", "one.pfm", "--size", "80x60", "--samples", "4", "--threads", "1"}).ok());
    ASSERT_TRUE(
        scc({"render", scene, "-o", "two.pfm", "--size", "80x60", "--samples", "4", "--threads", "3"}).ok());
    ASSERT_TRUE(
        scc({"render", scene, "-o", "crop.pfm", "--size", "80x60", "--samples", "4", "--crop", "10,20,50,21"})
            .ok());
    const std::string one = read("one.pfm");
    EXPECT_EQ(one, read("two.pfm"));
    // A PFM has its rows from the bottom, 12 bytes a pixel.
    const std::string crop = read("crop.pfm");
    const std::size_t row_bytes = 40 * 12;
    EXPECT_EQ(crop.substr(crop.size() - row_bytes), one.substr(one.size() - (21 * 80 - 10) * 12, row_bytes));
}

// Also where a loop or a table of text became columns of numbers.
TEST_F(CommandLine, ChecksEveryObjectOfColumns) {
    std::string table;
    for (int i = 0; i < 100; ++i) {
        table += "sphere { center = (1e7, " + std::to_string(i) + ", 0), radius = 1 }\n";
    }
    const std::string camera =
        "perspective_camera { eye = (1e7, 1, 9), target = (1e7, 0, 0), near = 1e-5 }\nsphere { }\n";
    write("loop.scn", camera + "for (i in 0..100) { sphere { center = (1e7, i, 0), radius = 1 } }\n");
    write("table.scn", camera + table);
    for (const char* file : {"loop.scn", "table.scn"}) {
        const auto result = scc({"check", file});
        EXPECT_TRUE(result.ok());
        EXPECT_NE(result.err.find("[far-from-origin]"), std::string::npos) << file << result.err;
        EXPECT_NE(result.err.find("[depth-precision]"), std::string::npos) << file << result.err;
    }
    EXPECT_NE(scc({"check", "loop.scn"}).err.find("the first of 100 such objects"), std::string::npos);
}

TEST_F(CommandLine, InterruptedRenderLeavesNoPicture) {
    // As a person would: the signal comes while the picture is being drawn.
    std::thread interrupter([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(1500));
        kill(getpid(), SIGINT);
    });
    struct sigaction ignore {};
    struct sigaction before {};
    ignore.sa_handler = [](int) {};
    sigaction(SIGINT, &ignore, &before);
    const auto result =
        scc({"render", example("lecture.scn"), "-o", "a.exr", "--size", "8000x8000", "--samples", "400"});
    sigaction(SIGINT, &before, nullptr);
    interrupter.join();
    EXPECT_EQ(result.end, validation::ProcessEnd::interrupted);
    EXPECT_EQ(files(), Lines{});
}

TEST_F(CommandLine, BuiltProgramTakesTheRenderOptions) {
    write("s.scn", small_scene);
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "prog"}).ok());
    EXPECT_NE(start(path("prog"), {"--help"}).out.find("--size"), std::string::npos);
    EXPECT_EQ(start(path("prog"), {}).code, 2);
    EXPECT_EQ(start(path("prog"), {"-o", "a.xyz"}).code, 2);
    EXPECT_EQ(start(path("prog"), {"-o", "no/a.png"}).code, 3);
    const auto result = start(
        path("prog"), {"-o", "a.exr", "--size", "20x10", "--samples", "4", "--threads", "2", "--stats", "-"});
    ASSERT_TRUE(result.ok()) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["rays"]["primary"], 20 * 10 * 4);
}

TEST_F(CommandLine, ComparesPictures) {
    write("s.scn", small_scene);
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "a.exr", "--size", "32x24"}).ok());
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "b.exr", "--size", "32x24", "--samples", "4"}).ok());
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "c.exr", "--size", "16x24"}).ok());
    EXPECT_EQ(scc({"compare", "a.exr", "a.exr", "--max", "0"}).code, 0);
    EXPECT_EQ(scc({"compare", "a.exr", "b.exr", "--max", "1e-9"}).code, 1);
    EXPECT_EQ(scc({"compare", "a.exr", "b.exr", "--rmse", "0.5", "--diff", "d.png"}).code, 0);
    EXPECT_TRUE(exists("d.png"));
    EXPECT_GT(nlohmann::json::parse(scc({"compare", "a.exr", "b.exr", "--json"}).out)["all"]["max_error"]
                  .get<double>(),
              0);
    EXPECT_EQ(scc({"compare", "a.exr", "c.exr"}).code, 1);
    EXPECT_EQ(scc({"compare", "a.exr", "none.exr"}).code, 3);
}

TEST_F(CommandLine, MeshesFromTheCacheGiveTheSamePicture) {
    std::string obj;
    for (int i = 0; i < 1600; ++i) {
        obj += fmt::format("v {} {} {}\n", i % 40 - 20, (i * i) % 7 * 0.2, i / 40 - 20);
    }
    for (int i = 0; i < 1559; ++i) {
        obj += i % 40 == 39 ? "" : fmt::format("f {} {} {} {}\n", i + 1, i + 41, i + 42, i + 2);
    }
    write("m.obj", obj + "f 1 1 2\n");
    write("s.scn", "mesh { file = \"m.obj\", normals = \"smooth\" }\npoint_light { position = (3, 9, 5) }\n"
                   "perspective_camera { eye = (2, 12, 30) }\n");
    std::string first, warning;
    const auto expect_same = [&](const char* when, const std::string& cache, const char* accel) {
        const auto result =
            scc({"render", "s.scn", "-o", "a.png", "--size", "64x48", "--accel", accel},
                {{"XDG_CACHE_HOME", path("cache")}, {"SCC_CACHE", cache}, {"SCC_CACHE_SIZE", ""}});
        ASSERT_TRUE(result.ok()) << when << result.err;
        first = first.empty() ? read("a.png") : first;
        warning = warning.empty() ? result.err : warning;
        EXPECT_EQ(read("a.png"), first) << when;
        EXPECT_EQ(result.err, warning) << when;
    };
    expect_same("without", "off", "sah");
    EXPECT_FALSE(exists("cache"));
    EXPECT_NE(warning.find("suspect-mesh"), std::string::npos) << warning;
    expect_same("quickly built", "off", "quick");
    expect_same("kept", "", "sah");
    expect_same("kept, quickly built", "", "quick");
    expect_same("found", "", "sah");
    expect_same("found, quickly built", "", "quick");
    std::size_t entries = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path("cache/scc"))) {
        if (entry.is_regular_file()) {
            std::filesystem::resize_file(entry.path(), entry.file_size() - 100);
            ++entries;
        }
    }
    EXPECT_EQ(entries, 3U); // the mesh, and a hierarchy of each quality
    expect_same("damaged", "", "sah");
    write("not a folder", "");
    std::filesystem::remove_all(path("cache"));
    std::filesystem::rename(path("not a folder"), path("cache"));
    expect_same("nowhere to keep it", "", "sah");
}

TEST_F(CommandLine, EmitsEveryStage) {
    write("s.scn", small_scene);
    for (const char* stage : {"tokens", "ast", "ir", "cpp"}) {
        const auto result = scc({"build", "s.scn", "--emit", stage, "-o", "-"});
        EXPECT_TRUE(result.ok()) << stage << result.err;
        EXPECT_NE(result.out.find("phere"), std::string::npos) << stage;
    }
}

} // namespace
// ---- imports -------------------------------------------------------------------------------------------

constexpr const char* studio = "param power: number = 1 in 0..10 \"of the light\"\nlet grey = 0.5\n"
                               "point_light { position = (0, 5, 5), color = rgb(power, power, power) }\n"
                               "perspective_camera { }\nsphere { radius = grey }\n";

TEST_F(CommandLine, ImportsAreDrawnLikeTheSameSceneInOneFile) {
    std::filesystem::create_directories(folder() / "rooms");
    write("rooms/studio.scn", studio);
    write("a.scn", "import \"rooms/studio.scn\" as studio with { power = 2 }\nstudio.scene\n"
                   "sphere { center = (1, 0, 0), radius = studio.grey }\n");
    write("b.scn",
          "sphere { radius = 0.5 }\nsphere { center = (1, 0, 0), radius = 0.5 }\nperspective_camera { }\n"
          "point_light { position = (0, 5, 5), color = rgb(2, 2, 2) }\n");
    for (const char* name : {"a", "b"}) {
        const auto result = scc({"render", std::string(name) + ".scn", "-o", std::string(name) + ".pfm",
                                 "--size", "64x48", "--progress", "never"});
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    EXPECT_EQ(read("a.pfm"), read("b.pfm"));
    const auto built = scc({"build", "a.scn", "-o", "a.ir", "--emit", "ir"});
    EXPECT_EQ(built.code, 0) << built.err;
    EXPECT_NE(read("a.ir").find("studio/sphere"), std::string::npos) << read("a.ir");
    EXPECT_NE(read("a.ir").find("studio/point_light"), std::string::npos) << read("a.ir");
}

TEST_F(CommandLine, ParamsOfImportsAreListedAndSet) {
    write("studio.scn", studio);
    write("a.scn", "import \"studio.scn\" as studio\nstudio.scene\n");
    EXPECT_EQ(scc({"params", "a.scn"}).out, "studio.power: number = 1 in 0..10  // of the light\n");
    EXPECT_EQ(scc({"check", "a.scn", "-D", "studio.power=3"}).code, 0);
    EXPECT_EQ(scc({"check", "a.scn", "-D", "studio.power=30"}).code, 1);
}

TEST_F(CommandLine, AnImportStaysInTheFolderOfTheScene) {
    std::filesystem::create_directories(folder() / "inner");
    write("studio.scn", studio);
    write("inner/a.scn", "import \"../studio.scn\" as studio\nstudio.scene\n");
    const auto refused = scc({"check", "inner/a.scn"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_EQ(
        refused.err,
        R"(inner/a.scn:1:8: error: `../studio.scn` lies outside the scene's folder; allow its folder with --asset-path [import-outside]
    1 | import "../studio.scn" as studio
      |        ^~~~~~~~~~~~~~~
1 error
)");
    EXPECT_EQ(scc({"check", "inner/a.scn", "-D", "x=../studio.scn"}).code, 1);
    EXPECT_EQ(scc({"check", "inner/a.scn", "--asset-path", "."}).code, 0);
    std::filesystem::create_symlink(folder() / "studio.scn", folder() / "inner/link.scn");
    write("inner/b.scn", "import \"link.scn\" as studio\nstudio.scene\n");
    EXPECT_EQ(scc({"check", "inner/b.scn"}).code, 1);
    write(
        "c.scn",
        "import \"inner\" as a\nimport \"none.scn\" as b\nimport \"c.scn\" as c\na.scene\nb.scene\nc.scene");
    EXPECT_EQ(scc({"check", "c.scn"}).err,
              R"(c.scn:1:8: error: cannot read `inner`: it is not a file [unreadable-import]
    1 | import "inner" as a
      |        ^~~~~~~
c.scn:2:8: error: cannot read `none.scn`: there is no such file in the folder of this one [unreadable-import]
    2 | import "none.scn" as b
      |        ^~~~~~~~~~
c.scn:3:8: error: `c.scn` imports itself [cyclic-import]
    3 | import "c.scn" as c
      |        ^~~~~~~
c.scn:3:8: note: `c.scn` imports `c.scn` here
3 errors
)");
}

TEST_F(CommandLine, AssetsOfAnImportLieBesideIt) {
    std::filesystem::create_directories(folder() / "parts");
    write("parts/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("parts/t.scn", "param model: string = \"t.obj\"\nmesh { file = model }\n");
    write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("a.scn", "import \"parts/t.scn\" as t\nimport \"parts/t.scn\" as u with { model = \"other.obj\" }\n"
                   "t.scene\nu.scene\npoint_light { position = (0, 1, 2) }\nperspective_camera { }\n");
    const auto result = scc({"check", "a.scn"});
    EXPECT_EQ(result.code, 0) << result.err;
    write("b.scn", "mesh { file = \"t.obj\" }\n");
    EXPECT_EQ(scc({"check", "b.scn"}).code, 1);
}

TEST_F(CommandLine, FixesGoIntoTheFileThatHasTheMistake) {
    write("part.scn", "sphere { radus = 2 }\n");
    write("a.scn", "import \"part.scn\" as part\npart.scene\nperspective_camera { fov_y = 40 }\n"
                   "point_light { position = (0, 5, 0) }\n");
    const auto result = scc({"check", "--fix", "a.scn"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "a.scn: 1 fix made\npart.scn: 1 fix made\n");
    EXPECT_EQ(read("part.scn"), "sphere { radius = 2 }\n");
    EXPECT_NE(read("a.scn").find("fov_y = 40deg"), std::string::npos);
}

// ---- frames --------------------------------------------------------------------------------------------

constexpr const char* animation =
    "sphere { center = (frame, 0, 0), radius = 0.5 + time }\nperspective_camera { }\n"
    "point_light { position = (3, 4, 5) }\n"
    "render { frames = 0..3, frame_rate = 2, size = (32, 24) }\n";

TEST_F(CommandLine, FramesAreDrawnIntoFilesOfTheirOwn) {
    write("a.scn", animation);
    const auto result =
        scc({"render", "a.scn", "--frames", "1..3", "-o", "out_##.pfm", "--progress", "never"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(scc({"render", "a.scn", "--frames", "2..3", "-o", "out.pfm", "--progress", "never"}).code, 0);
    EXPECT_EQ(files(), (std::vector<std::string>{"a.scn", "out_0002.pfm", "out_01.pfm", "out_02.pfm"}));
    write("b.scn", "sphere { center = (2, 0, 0), radius = 1.5 }\nperspective_camera { }\n"
                   "point_light { position = (3, 4, 5) }\nrender { size = (32, 24) }\n");
    EXPECT_EQ(scc({"render", "b.scn", "-o", "b.pfm", "--progress", "never"}).code, 0);
    EXPECT_EQ(read("out_02.pfm"), read("b.pfm"));
    EXPECT_EQ(scc({"render", "a.scn", "--frame", "2", "-o", "one.pfm", "--progress", "never"}).err, "");
    EXPECT_EQ(read("one.pfm"), read("b.pfm"));
}

TEST_F(CommandLine, FramesThatTheSceneLacksAreUsageErrors) {
    write("a.scn", animation);
    write("b.scn", small_scene);
    const auto late = scc({"render", "a.scn", "--frame", "3", "-o", "a.pfm"});
    EXPECT_EQ(late.code, 2);
    EXPECT_EQ(late.err,
              "scc: error: there is no frame 3; the scene has the frames 0..3, the last one excluded\n");
    EXPECT_EQ(scc({"render", "b.scn", "--frame", "0", "-o", "a.pfm"}).code, 2);
    for (const char* wrong : {"3..1", "1", "a..b", "1..2x", ".."}) {
        EXPECT_EQ(scc({"render", "a.scn", "--frames", wrong, "-o", "a.pfm"}).code, 2) << wrong;
    }
    EXPECT_EQ(scc({"render", "a.scn", "--frames", "0..2", "--frame", "1", "-o", "a.pfm"}).code, 2);
    EXPECT_EQ(files(), (std::vector<std::string>{"a.scn", "b.scn"}));
}

TEST_F(CommandLine, CheckLooksAtTheLastFrameToo) {
    write("a.scn",
          "sphere { radius = 2 - frame }\nperspective_camera { }\npoint_light { position = (3, 4, 5) }\n"
          "render { frames = 0..3 }\n");
    const auto result = scc({"check", "a.scn"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, R"(a.scn:1:19: error: radius is 0; a radius is greater than 0 [value-out-of-range]
    1 | sphere { radius = 2 - frame }
      |                   ^~~~~~~~~
a.scn:1:19: note: in frame 2
1 error
)");
    write("a.scn", animation);
    EXPECT_EQ(scc({"check", "a.scn"}).err, "");
}

TEST_F(CommandLine, CheckGivesASceneTheFramesThatItUses) {
    write("a.scn",
          "sphere { radius = 2 + frame }\nperspective_camera { }\npoint_light { position = (3, 4, 5) }\n"
          "render { size = (4, 3) }\n");
    EXPECT_EQ(scc({"check", "--fix", "a.scn"}).code, 0);
    EXPECT_NE(read("a.scn").find("render { frames = 0..48, size = (4, 3) }"), std::string::npos)
        << read("a.scn");
    write("b.scn",
          "sphere { radius = 2 + frame }\nperspective_camera { }\npoint_light { position = (3, 4, 5) }\n");
    EXPECT_EQ(scc({"check", "--fix", "b.scn"}).code, 0);
    EXPECT_NE(read("b.scn").find("\nrender { frames = 0..48 }\n"), std::string::npos) << read("b.scn");
}

TEST_F(CommandLine, ImagesOfAnExportLieBesideIt) {
    write("q.png", host::encode_png(runtime::Image(2, 2)));
    std::filesystem::create_directory(folder() / "out");
    write("s.scn", std::string(small_scene) +
                       "let q = image { file = \"q.png\" }\n"
                       "plane { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n");
    EXPECT_EQ(scc({"export", "pov", "s.scn", "-o", "out/a.b.pov"}).code, 0);
    EXPECT_TRUE(exists("out/a.b_image_q.png"));
    EXPECT_NE(read("out/a.b.pov").find("png \"a.b_image_q.png\""), std::string::npos);
    const auto to_stdout = scc({"export", "pov", "s.scn", "-o", "-"});
    EXPECT_EQ(to_stdout.code, 2);
    EXPECT_EQ(to_stdout.out, "");
    EXPECT_EQ(scc({"export", "blender", "s.scn", "-o", "-"}).code, 0);
    EXPECT_EQ(files(), (std::vector<std::string>{"out", "q.png", "s.scn"}));
}

TEST_F(CommandLine, StabilityKeepsWhatIsRecorded) {
    const auto result =
        scc({"stability", "shininess", "grazing", "attenuation_up", "--size", "32x32", "--json"});
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    const auto sweeps = nlohmann::json::parse(result.out)["sweeps"];
    ASSERT_EQ(sweeps.size(), 3U);
    for (const auto& sweep : sweeps) {
        EXPECT_EQ(sweep["thresholds"]["auto"], sweep["recorded_threshold"]) << sweep["name"];
        EXPECT_TRUE(sweep["auto"]["wrong_picks"].empty()) << sweep["name"];
    }
    EXPECT_LT(sweeps[0]["thresholds"]["float"], 8) << "where float fails auto takes double";
    EXPECT_EQ(sweeps[0]["steps"][8]["chosen"], "double");
}

TEST_F(CommandLine, StabilityWarnsWhereDoubleIsNotEnough) {
    const auto result = scc({"stability", "distance", "shear", "bricks", "inside", "tunnel", "film", "huge",
                             "depth_gap", "spectral_line", "outside", "--size", "32x32", "--json"});
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    const auto sweeps = nlohmann::json::parse(result.out)["sweeps"];
    for (const auto& sweep : sweeps) {
        EXPECT_EQ(sweep["thresholds"]["auto"], sweep["recorded_threshold"]) << sweep["name"];
        EXPECT_TRUE(sweep["auto"]["wrong_picks"].empty()) << sweep["name"];
        EXPECT_TRUE(sweep["auto"]["unwarned"].empty()) << sweep["name"];
    }
    EXPECT_EQ(sweeps[0]["auto"]["beyond_double"], (std::vector{12, 13, 14, 15}));
}

TEST_F(CommandLine, StabilityMovesAndScalesAUsersScene) {
    write("s.scn", "perspective_camera { eye = (1, 2, 5) }\n"
                   "point_light { position = (3, 4, 5), attenuation = (0.5, 0.1, 0.02) }\n"
                   "rectangle_light { corner = (-3, 3, 1), edge_u = (1, 0, 0), edge_v = (0, 0, 1) }\n"
                   "directional_light { towards = (1, 2, 3), color = rgb(0.2, 0.2, 0.2) }\n"
                   "for (i in 0..3) { sphere { center = (i - 1, 0, -1), radius = 0.4 } }\n"
                   "difference { box { }, sphere { radius = 1.2 }, transform = rotate_y(30deg) }\n"
                   "plane { offset = -1 }\n");
    const auto result = scc({"stability", "s.scn", "--size", "24x24", "--json", "--report", "out"});
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    const auto sweeps = nlohmann::json::parse(result.out)["sweeps"];
    ASSERT_EQ(sweeps.size(), 3U);
    EXPECT_EQ(sweeps[0]["name"], "s/offset");
    EXPECT_EQ(sweeps[0]["thresholds"]["double"], 12);
    EXPECT_EQ(sweeps[0]["thresholds"]["float"], 12) << "what stands far off is drawn as if it stood near";
    EXPECT_EQ(sweeps[1]["thresholds"]["double"], -12);
    EXPECT_EQ(sweeps[2]["thresholds"]["double"], 12);
    EXPECT_EQ(nlohmann::json::parse(read("out/report.json"))["sweeps"], sweeps);
    EXPECT_NE(read("out/index.html").find("s/offset"), std::string::npos);
}

TEST_F(CommandLine, StabilityListsItsCasesAndRefusesWhatItCannotSweep) {
    const auto list = scc({"stability", "--list"});
    EXPECT_EQ(list.code, 0);
    EXPECT_NE(list.out.find("cylinder_afar"), std::string::npos);
    const auto unknown = scc({"stability", "ofset"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("did you mean `offset`?"), std::string::npos) << unknown.err;
    write("s.scn",
          std::string(small_scene) +
              "plane { material = phong { diffuse = fn(s: surface) = rgb(1, 1, 1) * s.world.x } }\n");
    const auto tied = scc({"stability", "s.scn", "--report", "out"});
    EXPECT_EQ(tied.code, 1);
    EXPECT_NE(tied.err.find("depends on places in the world"), std::string::npos) << tied.err;
    write("s.scn", "sphere { radius = -1 }\n");
    EXPECT_EQ(scc({"stability", "s.scn", "--report", "out"}).code, 1);
    EXPECT_EQ(scc({"stability", "none.scn"}).code, 3);
    EXPECT_EQ(files(), (Lines{"s.scn"}));
}

} // namespace scc::cli::test
