#include "validation/render_cache.h"
#include "validation/scratch.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;

RenderResult drawn(int width, int height) {
    RenderResult result;
    result.status = RenderStatus::done;
    result.image = runtime::Image(width, height);
    for (std::size_t i = 0; i < result.image.pixels.size(); ++i)
        result.image.pixels[i] = 0.1F * static_cast<float>(i);
    result.version = "POV-Ray 3.7";
    result.exposure = 0.25;
    result.times.parse = 0.5;
    result.times.total = 2;
    result.warnings = {"\xFF careful"};
    return result;
}

fs::path entry_in(const fs::path& folder) {
    return fs::directory_iterator(folder / "render")->path();
}

TEST(RenderCache, GivesBackWhatWasDrawn) {
    const ScratchFolder folder;
    const RenderCache cache = RenderCache::from_option((folder.path() / "new").string());
    EXPECT_FALSE(cache.find("key"));
    cache.store("key", drawn(3, 2));
    const std::optional<RenderResult> found = cache.find("key");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->image.pixels, drawn(3, 2).image.pixels);
    EXPECT_EQ(found->image.width, 3);
    EXPECT_EQ(found->exposure, 0.25);
    EXPECT_EQ(found->times.parse, 0.5);
    EXPECT_FALSE(found->times.trace);
    EXPECT_EQ(found->status, RenderStatus::done);
    EXPECT_TRUE(found->from_cache);
    EXPECT_FALSE(cache.find("other"));
}

TEST(RenderCache, KeepsNoFailuresAndNothingWhenOff) {
    const ScratchFolder folder;
    const RenderCache cache = RenderCache::from_option(folder.path().string());
    RenderResult failed = drawn(1, 1);
    failed.status = RenderStatus::timed_out;
    cache.store("key", failed);
    EXPECT_FALSE(cache.find("key"));
    EXPECT_FALSE(RenderCache::from_option("off").keeps());
    EXPECT_THROW(RenderCache::from_option("/proc/none/cache"), host::FileError);
}

TEST(RenderCache, DamagedEntriesAreDrawnAgain) {
    const ScratchFolder folder;
    const RenderCache cache = RenderCache::from_option(folder.path().string());
    cache.store("key", drawn(3, 2));
    const fs::path entry = entry_in(folder.path());
    const auto size = fs::file_size(entry);
    for (const auto& damage : {std::pair{size / 2, 'x'}, std::pair{std::uintmax_t{3}, '\xff'}}) {
        std::fstream(entry, std::ios::in | std::ios::out | std::ios::binary)
            .seekp(static_cast<std::streamoff>(damage.first))
            .put(damage.second);
        EXPECT_FALSE(cache.find("key"));
        cache.store("key", drawn(3, 2));
    }
    fs::resize_file(entry, size - 1);
    EXPECT_FALSE(cache.find("key"));
    // Whole, but of another make.
    for (const char* text : {"", "{}\n", "no JSON\n",
                             R"({"width":9,"height":9,"channels":3})"
                             "\n"}) {
        host::Cache::in_folder(folder.path()).store("render", "key", text);
        EXPECT_FALSE(cache.find("key")) << text;
    }
}

TEST(RenderCache, SeveralMayWriteAtOnce) {
    const ScratchFolder folder;
    const RenderCache cache = RenderCache::from_option(folder.path().string());
    std::vector<std::jthread> writers;
    for (int i = 0; i < 4; ++i)
        writers.emplace_back([&] {
            for (int k = 0; k < 10; ++k) {
                cache.store("key", drawn(20, 20));
                const std::optional<RenderResult> found = cache.find("key");
                EXPECT_TRUE(found && found->image.pixels == drawn(20, 20).image.pixels);
            }
        });
    writers.clear();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "render"), fs::directory_iterator()), 1);
}

TEST(RenderCache, TheKeyHoldsAllThatThePictureDependsOn) {
    const ScratchFolder folder;
    const auto write = [&](const char* name, const char* text) {
        std::ofstream(folder.path() / name) << text;
    };
    write("a.pov", "sphere");
    write("a_0.png", "pixels");
    RenderJob job;
    job.scene = folder.path() / "a.pov";
    job.beside = {"a_0.png"};
    Command command;
    command.program = "povray";
    command.arguments = {"+Ia.pov", "+W4"};
    const std::string key = render_key(job, command, "3.7");
    EXPECT_EQ(key, render_key(job, command, "3.7"));
    EXPECT_NE(key, render_key(job, command, "3.8"));
    Command larger = command;
    larger.arguments = {"+Ia.pov", "+W8"};
    EXPECT_NE(key, render_key(job, larger, "3.7"));
    larger.arguments = {"+Ia.pov+W4"};
    EXPECT_NE(key, render_key(job, larger, "3.7"));
    RenderJob sampled = job;
    sampled.samples_per_axis = 2;
    EXPECT_NE(key, render_key(sampled, command, "3.7"));
    write("a_0.png", "pixel");
    const std::string other_image = render_key(job, command, "3.7");
    EXPECT_NE(key, other_image);
    write("a.pov", "sphere ");
    EXPECT_NE(other_image, render_key(job, command, "3.7"));
}

} // namespace
} // namespace scc::validation
