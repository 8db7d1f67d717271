#include "runtime/host/cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace scc::host {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t roomy = 1 << 20;

class CacheTest : public testing::Test {
protected:
    CacheTest() {
        std::string name = (fs::temp_directory_path() / "scc-cache-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~CacheTest() override { fs::remove_all(folder_); }

    fs::path file(const std::string& key) const { return folder_ / "code" / key; }
    static std::string content(const Cache& cache, const std::string& key) {
        const auto entry = cache.find("code", key);
        return entry ? std::string(entry->content()) : "none";
    }

    fs::path folder_;
};

TEST_F(CacheTest, KeepsContentUnderItsKey) {
    const Cache cache(folder_, roomy);
    EXPECT_EQ(content(cache, "a"), "none");
    cache.store("code", "a", "first");
    cache.store("code", "b", "");
    EXPECT_EQ(content(cache, "a"), "first");
    EXPECT_EQ(content(cache, "b"), "");
    EXPECT_FALSE(cache.find("mesh", "a"));
    cache.store("code", "a", "second");
    EXPECT_EQ(content(cache, "a"), "second");
}

TEST_F(CacheTest, KeysTellPartsAndTheirBordersApart) {
    EXPECT_EQ(cache_key({"a", "b"}), cache_key({"a", "b"}));
    for (const auto& other : {cache_key({"ab"}), cache_key({"b", "a"}), cache_key({"ab", ""}),
                              cache_key({"a", "c"}), cache_key({"a", std::string_view("b\0", 2)})}) {
        EXPECT_NE(cache_key({"a", "b"}), other);
    }
    EXPECT_EQ(cache_key({}).size(), 32U);
}

TEST_F(CacheTest, ADamagedEntryIsRemovedAndCountsAsMissing) {
    const Cache cache(folder_, roomy);
    const std::string text(5000, 'x');
    for (const std::uintmax_t place : {std::uintmax_t{0}, std::uintmax_t{2500}, std::uintmax_t{5010}}) {
        cache.store("code", "a", text);
        std::fstream(file("a")).seekp(static_cast<std::streamoff>(place)).put('!');
        EXPECT_EQ(content(cache, "a"), "none") << place;
        EXPECT_FALSE(fs::exists(file("a")));
    }
    for (const std::uintmax_t size : {0, 10, 4000, 5023}) {
        cache.store("code", "a", text);
        fs::resize_file(file("a"), size);
        EXPECT_EQ(content(cache, "a"), "none") << size;
    }
    cache.store("code", "a", text);
    EXPECT_EQ(content(cache, "a"), text);
}

TEST_F(CacheTest, EntriesUnusedForLongestMakeRoom) {
    const Cache cache(folder_, 3500);
    const std::string text(1000, 'x');
    const auto now = fs::file_time_type::clock::now();
    for (const auto& [key, age] : {std::pair("a", 3), std::pair("b", 2), std::pair("c", 1)}) {
        cache.store("code", key, text);
        fs::last_write_time(file(key), now - std::chrono::hours(age));
    }
    EXPECT_EQ(content(cache, "a"), text); // and so is the youngest
    cache.store("code", "d", text);
    EXPECT_EQ(content(cache, "b"), "none");
    for (const char* key : {"a", "c", "d"}) {
        EXPECT_EQ(content(cache, key), text) << key;
    }
    cache.store("code", "huge", std::string(4000, 'x'));
    EXPECT_EQ(content(cache, "huge"), "none");
    EXPECT_EQ(content(cache, "d"), text);
}

TEST_F(CacheTest, WhatAnEndedProcessLeftIsClearedAway) {
    const Cache cache(folder_, roomy);
    cache.store("code", "a", "text");
    for (const char* name : {".scc-1-1.tmp", ".scc-2-1.tmp"}) {
        std::ofstream(file(name)) << "half";
    }
    fs::last_write_time(file(".scc-1-1.tmp"), fs::file_time_type::clock::now() - std::chrono::hours(2));
    cache.store("code", "b", "text");
    EXPECT_FALSE(fs::exists(file(".scc-1-1.tmp")));
    EXPECT_TRUE(fs::exists(file(".scc-2-1.tmp"))); // may be at work
}

TEST_F(CacheTest, WritersAtTheSameTimeNeverShowHalfAnEntry) {
    const Cache cache(folder_, roomy);
    constexpr int writers = 4;
    for (int writer = 0; writer < writers; ++writer) {
        if (::fork() == 0) {
            for (int i = 0; i < 50; ++i) {
                cache.store("code", "a", std::string(20000, static_cast<char>('a' + writer)));
                const std::string seen = content(cache, "a");
                if (seen.size() != 20000 || seen.find_first_not_of(seen[0]) != std::string::npos) {
                    ::_exit(1);
                }
            }
            ::_exit(0);
        }
    }
    for (int writer = 0; writer < writers; ++writer) {
        int status = 0;
        ::wait(&status);
        EXPECT_EQ(status, 0);
    }
}

TEST_F(CacheTest, WithoutAFolderOfItsOwnNothingIsKeptAndNothingFails) {
    std::ofstream(folder_ / "file") << "in the way";
    for (const Cache& cache : {Cache(), Cache(folder_ / "file", roomy), Cache("/proc/none", roomy)}) {
        cache.store("code", "a", "text");
        EXPECT_EQ(content(cache, "a"), "none");
    }
}

TEST_F(CacheTest, TheUsersFolderFollowsTheEnvironment) {
    const auto found = [&] {
        Cache::of_user().store("code", "a", "text");
        const bool kept = Cache::of_user().find("code", "a").has_value();
        return kept ? "kept" : "not kept";
    };
    ::setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    EXPECT_STREQ(found(), "kept");
    EXPECT_TRUE(fs::exists(folder_ / "scc/code/a"));
    ::setenv("SCC_CACHE", "off", 1);
    EXPECT_STREQ(found(), "not kept");
    ::unsetenv("SCC_CACHE");
    fs::permissions(folder_ / "scc", fs::perms::others_write, fs::perm_options::add);
    EXPECT_STREQ(found(), "not kept"); // others could plant a program
    fs::remove_all(folder_ / "scc");
    ::setenv("SCC_CACHE_SIZE", "nonsense", 1);
    EXPECT_STREQ(found(), "not kept");
    ::setenv("SCC_CACHE_SIZE", "2M", 1);
    EXPECT_STREQ(found(), "kept");
    ::unsetenv("SCC_CACHE_SIZE");
    ::setenv("XDG_CACHE_HOME", "relative", 1);
    ::unsetenv("HOME");
    EXPECT_STREQ(found(), "not kept");
    ::setenv("HOME", (folder_ / "home").c_str(), 1);
    EXPECT_STREQ(found(), "kept");
    EXPECT_TRUE(fs::exists(folder_ / "home/.cache/scc/code/a"));
}

} // namespace
} // namespace scc::host
