#include "runtime/host/read_image.h"
#include "validation/embed.h"
#include "validation/junit.h"
#include "validation/report.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;
using runtime::Image;

Image ramp(int width, int height) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<float>(i % 97) / 97;
    return image;
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t result = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++result;
    return result;
}

Report example() {
    SceneReport scene;
    scene.name = "two <b>balls</b> & \"more\"";
    scene.description = "it's </p><script>alert(1)</script>";
    scene.reference = ramp(40, 30);
    scene.reference_made_by = "scc render --precision double";
    scene.times.total = 0.5;

    RendererReport pov;
    pov.renderer = "pov";
    pov.version = "POV-Ray <3.7>";
    pov.command = "povray +Ia<b.pov";
    pov.image = scene.reference;
    pov.image.at(7, 3)[1] += 0.25F;
    pov.budget = budget_for("pov", 40, 30);
    pov.metrics = compare(scene.reference, pov.image, {.thresholds = thresholds_for(*pov.budget)});
    pov.judgement = judge(*pov.budget, *pov.metrics);
    pov.times = {0.1, 0.2, 0.3, 0.4, std::nullopt, 1.0};
    pov.ledger = {{"approximated", "light & <shade>", "key", "a.scn:3:1", "fit", 6.3e-5},
                  {"exact", "sphere", "", "", "", 0}};
    pov.warnings = {"careful <img src=x>"};
    pov.worst_pixel = "hit <ball>";
    pov.log = "log <log>";

    RendererReport blender;
    blender.renderer = "blender";
    blender.judgement = {Verdict::skipped, "Blender is not installed"};

    RendererReport native;
    native.renderer = "native";
    native.judgement = {Verdict::failed, "3 pixels differ"};

    scene.renderers = {pov, blender, native};
    Report report;
    report.versions = {{"scc", "0.1.0"}, {"g++ <12>", "12.2"}};
    report.scenes = {scene, scene};
    return report;
}

TEST(Report, SkippedNeverCountsAsPassed) {
    const ReportSummary summary = summarize(example());
    EXPECT_EQ(summary.passed, 2U);
    EXPECT_EQ(summary.skipped, 2U);
    EXPECT_EQ(summary.failed, 2U);
    EXPECT_EQ(RendererReport().judgement.verdict, Verdict::skipped);
    EXPECT_NE(to_html(example()).find("2 passed, 2 failed, 2 skipped"), std::string::npos);
}

TEST(Report, JsonHoldsVerdictsMetricsBudgetsTimesAndLedger) {
    const ScratchFolder folder;
    write_report(example(), folder.path() / "new" / "report");
    const auto json = nlohmann::json::parse(text_of(folder.path() / "new" / "report" / "report.json"));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_EQ(json["versions"]["scc"], "0.1.0");
    EXPECT_EQ(json["summary"]["skipped"], 2);
    const auto& scene = json["scenes"][0];
    EXPECT_EQ(scene["name"], "two <b>balls</b> & \"more\"");
    EXPECT_EQ(scene["size"], (std::vector<int>{40, 30}));
    const auto& pov = scene["renderers"][0];
    EXPECT_EQ(pov["verdict"], "passed");
    EXPECT_TRUE(pov["reason"].is_null());
    EXPECT_EQ(pov["budget"]["outliers"], 5);
    EXPECT_NEAR(pov["metrics"]["all"]["max_error"].get<double>(), 0.25, 1e-6);
    EXPECT_EQ(pov["metrics"]["all"]["worst"]["x"], 7);
    EXPECT_EQ(pov["times_s"]["parse"], 0.2);
    EXPECT_FALSE(pov["times_s"].contains("saving"));
    EXPECT_EQ(pov["ledger"][0]["bound"], 6.3e-5);
    const auto& blender = scene["renderers"][1];
    EXPECT_EQ(blender["verdict"], "skipped");
    EXPECT_EQ(blender["reason"], "Blender is not installed");
    EXPECT_TRUE(blender["metrics"].is_null());
    EXPECT_TRUE(blender["file"].is_null());
}

TEST(Report, ImagesAreStoredUnderDistinctRelativeNames) {
    const ScratchFolder folder;
    write_report(example(), folder.path());
    const auto json = nlohmann::json::parse(text_of(folder.path() / "report.json"));
    const std::string first = json["scenes"][0]["reference"]["file"];
    const std::string second = json["scenes"][1]["reference"]["file"];
    EXPECT_EQ(first, "images/two__b_balls__b_____more_-reference.exr");
    EXPECT_EQ(second, "images/two__b_balls__b_____more_-reference-2.exr");
    EXPECT_EQ(host::read_image((folder.path() / second).string()).pixels,
              example().scenes[1].reference.pixels);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "images"), fs::directory_iterator()), 4);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 3)
        << "a file is left over";
}

TEST(Report, HtmlEscapesEveryText) {
    const std::string html = to_html(example());
    for (const char* raw :
         {"<script>alert", "<b>", "<img src=x>", "<ball>", "<log>", "<shade>", "<3.7>", "<12>", "a<b.pov"})
        EXPECT_EQ(html.find(raw), std::string::npos) << raw;
    for (const char* escaped :
         {"two &lt;b&gt;balls&lt;/b&gt; &amp; &quot;more&quot;", "it&#39;s &lt;/p&gt;&lt;script&gt;",
          "careful &lt;img src=x&gt;", "hit &lt;ball&gt;", "log &lt;log&gt;", "light &amp; &lt;shade&gt;",
          "povray +Ia&lt;b.pov", "g++ &lt;12&gt;"})
        EXPECT_NE(html.find(escaped), std::string::npos) << escaped;
}

TEST(Report, HtmlNeedsNothingFromOutside) {
    const std::string html = to_html(example());
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_EQ(html.find("url("), std::string::npos);
    EXPECT_EQ(count(html, " src=\""), count(html, " src=\"data:image/png;base64,"));
    EXPECT_EQ(count(html, " href=\""), count(html, " href=\"#scene-"));
    EXPECT_EQ(count(html, "<img "), 6U) << "reference, other and difference of each scene";
    EXPECT_EQ(count(html, "difference, amplified 1 times"), 4U) << "caption and alternative text";
    EXPECT_NE(html.find("prefers-color-scheme: dark"), std::string::npos);
}

TEST(Report, HtmlTagsAreBalanced) {
    const std::string html = to_html(example());
    for (const std::string tag :
         {"table", "tr", "td", "th", "div", "section", "figure", "details", "p", "h3", "span"})
        EXPECT_EQ(count(html, "<" + tag + ">") + count(html, "<" + tag + " "), count(html, "</" + tag + ">"))
            << tag;
}

TEST(Report, HtmlShowsReasonsAndInexactFeatures) {
    const std::string html = to_html(example());
    EXPECT_NE(html.find("Blender is not installed"), std::string::npos);
    EXPECT_NE(html.find("3 pixels differ"), std::string::npos);
    EXPECT_NE(html.find("<details open><summary>ledger: 2 features, 1 of them not exact"), std::string::npos);
    EXPECT_NE(html.find("0.25 (7, 3)"), std::string::npos);
}

TEST(Report, BytesThatAreNotUtf8DoNotStopIt) {
    Report report = example();
    report.scenes[0].renderers[0].warnings = {"\xff\xfe"};
    const ScratchFolder folder;
    write_report(report, folder.path());
    EXPECT_TRUE(nlohmann::json::accept(text_of(folder.path() / "report.json")));
}

TEST(Report, FolderThatCannotBeMadeIsNamed) {
    const ScratchFolder folder;
    std::ofstream(folder.path() / "file") << "x";
    EXPECT_THROW(write_report(example(), folder.path() / "file" / "report"), host::FileError);
}

TEST(Report, EmptyReportIsWritten) {
    const ScratchFolder folder;
    write_report({}, folder.path());
    EXPECT_NE(text_of(folder.path() / "index.html").find("0 passed, 0 failed, 0 skipped"), std::string::npos);
}

TEST(Base64, FollowsTheStandardsTestVectors) {
    const std::pair<const char*, const char*> rows[] = {{"", ""},
                                                        {"f", "Zg=="},
                                                        {"fo", "Zm8="},
                                                        {"foo", "Zm9v"},
                                                        {"foob", "Zm9vYg=="},
                                                        {"fooba", "Zm9vYmE="},
                                                        {"foobar", "Zm9vYmFy"},
                                                        {"\xff\xff\xfe", "///+"}};
    for (const auto& [bytes, text] : rows)
        EXPECT_EQ(base64(bytes), text);
}

TEST(Shrunk, AveragesOrKeepsTheMaximumAndLeavesSmallImagesAlone) {
    Image image(5, 3, 1);
    image.at(1, 1)[0] = 4;
    image.at(4, 2)[0] = 2;
    EXPECT_EQ(shrunk(image, 5, Shrink::average).pixels, image.pixels);
    EXPECT_EQ(shrunk(image, 3, Shrink::average).pixels, (runtime::Pixels{1, 0, 0, 0, 0, 2}));
    EXPECT_EQ(shrunk(image, 3, Shrink::maximum).pixels, (runtime::Pixels{4, 0, 0, 0, 0, 2}));
    image.at(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(shrunk(image, 5, Shrink::maximum).pixels[0], 1) << "what is not finite shows as white";
}

TEST(Shrunk, WideImagesAreEmbeddedAtMostEightHundredPixelsWide) {
    EXPECT_EQ(shrunk(Image(1920, 1080), 800, Shrink::average).width, 640);
    EXPECT_EQ(shrunk(Image(801, 10), 800, Shrink::average).width, 401);
}

TEST(Report, ViewersHoldTheNumbers) {
    const std::string html = to_html(example());
    EXPECT_EQ(count(html, "class=\"viewer\" data-width=\"40\" data-height=\"30\" data-block=\"1\""), 2U);
    EXPECT_EQ(count(html, "id=\"values-1\""), 1U);
    Image values(2, 1);
    values.pixels = {0, 1, -2, 0x1p-24F, 65520, 2047.9F / 2048};
    // 0000 3c00 c000 0001 7c00 3c00, little-endian
    EXPECT_EQ(half_floats(values, 1), base64(std::string("\0\0\0\x3c\0\xc0\1\0\0\x7c\0\x3c", 12)));
}

// Opens each viewer, goes through its modes, points at the pixel that differs, sorts each table, and tells in
// the page's title what was seen.
constexpr const char* visitor = R"js(<script>
const seen = [];
const probe = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
for (const viewer of document.querySelectorAll(".viewer")) {
  viewer.querySelector("button").click();
  const mode = viewer.querySelector("select"), canvas = viewer.querySelector("canvas");
  const colors = ["wipe", "flip", "difference"].map(name => {
    mode.value = name;
    mode.dispatchEvent(new Event("input"));
    probe.drawImage(canvas, 0, 0);
    return probe.getImageData(7, 3, 1, 1).data.join();
  });
  const {left, top} = canvas.getBoundingClientRect(), pixel = canvas.clientWidth / canvas.width;
  canvas.dispatchEvent(new MouseEvent("mousemove", {clientX: left + 7.5 * pixel, clientY: top + 3.5 * pixel}));
  seen.push(new Set(colors).size + " colours, " + viewer.querySelector("output").textContent);
}
const heads = document.querySelectorAll("table.sortable th");
for (const head of heads) head.click();
seen.push([...heads].filter(head => head.dataset.sorted === "up").length + " sorted");
document.title = seen.join("; ");
</script>)js";

TEST(Report, BrowserShowsSortsAndReadsWithoutAMessage) {
    const auto browser = find_program("chromium");
    if (!browser) {
        GTEST_SKIP() << "needs Chromium";
    }
    const ScratchFolder folder;
    std::string html = to_html(example());
    const std::size_t end = html.rfind("</body>");
    ASSERT_NE(end, std::string::npos);
    html.insert(end, visitor);
    std::ofstream(folder.path() / "page.html") << html;
    const Command command{.program = *browser,
                          .arguments = {"--headless", "--no-sandbox", "--disable-gpu",
                                        "--enable-logging=stderr",
                                        "--user-data-dir=" + (folder.path() / "profile").string(),
                                        "--dump-dom", "file://" + (folder.path() / "page.html").string()},
                          .directory = folder.path(),
                          .environment = {{"HOME", folder.path().string()}},
                          .timeout_seconds = 60,
                          .max_output_bytes = std::size_t{64} << 20};
    const ProcessResult result = run(command);
    ASSERT_TRUE(result.ok()) << describe(result, command) << result.err;
    EXPECT_EQ(result.err.find("CONSOLE"), std::string::npos) << result.err;
    const std::size_t title = result.out.find("<title>");
    ASSERT_NE(title, std::string::npos) << result.out;
    const std::string told = result.out.substr(title, 400);
    EXPECT_EQ(count(told, "3 colours, (7, 3): reference "), 2U) << told;
    EXPECT_EQ(count(told, "difference 0.000 0.2500 0.000"), 2U) << told;
    EXPECT_EQ(count(told, " 0 sorted"), 0U) << told;
}

TEST(JUnit, CountsAndEscapes) {
    Report report = example();
    report.scenes[0].renderers[2].judgement.reason = "a<b\nc\x01 \xFF \"q\"";
    SceneReport broken;
    broken.name = "wrong.scn";
    broken.failure = "the scene is wrong";
    report.scenes.push_back(broken);
    const std::string xml = to_junit(report);
    EXPECT_EQ(count(xml, "<testsuite "), 3U);
    EXPECT_EQ(count(xml, "<testcase "), 7U);
    EXPECT_EQ(count(xml, "<failure "), 2U);
    EXPECT_EQ(count(xml, "<skipped "), 2U);
    EXPECT_NE(xml.find("tests=\"7\" failures=\"2\" errors=\"1\" skipped=\"2\""), std::string::npos) << xml;
    EXPECT_NE(xml.find("<error message=\"the scene is wrong\"/>"), std::string::npos) << xml;
    EXPECT_NE(xml.find("message=\"a&lt;b&#10;c\xEF\xBF\xBD \xEF\xBF\xBD &quot;q&quot;\""), std::string::npos)
        << xml;
    EXPECT_EQ(summarize(report).broken, 1U);
}

} // namespace
} // namespace scc::validation
