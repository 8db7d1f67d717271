#include "runtime/host/file.h"
#include "runtime/host/values.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scc::host {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string some_values() {
    ValuesWriter writer;
    writer.add_text("a scene");
    writer.add(std::span<const float>(std::vector<float>{1, 2, 3}));
    writer.add(42);
    writer.add(std::span<const double>(std::vector<double>(100, 0.5)));
    return writer.take();
}

std::string reason(const std::string& bytes) {
    try {
        Values values(bytes_of(bytes), "prog");
        values.read_text();
        std::array<float, 3> three{};
        values.read(three);
    } catch (const FileError& error) {
        return error.what();
    }
    return "none";
}

TEST(Values, ComeBackInTheirOrderAndLargeTablesStayWhereTheyAre) {
    const std::string bytes = some_values();
    Values values(bytes_of(bytes), "prog");
    EXPECT_EQ(values.read_text(), "a scene");
    std::array<float, 3> three{};
    values.read(three);
    EXPECT_EQ(three, (std::array<float, 3>{1, 2, 3}));
    int answer = 0;
    values.read(answer);
    EXPECT_EQ(answer, 42);
    std::span<const double> many;
    values.read(many);
    EXPECT_EQ(many.size(), 100U);
    EXPECT_EQ(many[99], 0.5);
    const auto* first = reinterpret_cast<const char*>(many.data());
    EXPECT_TRUE(first > bytes.data() && first < bytes.data() + bytes.size());
}

TEST(Values, FollowWhateverComesBefore) {
    EXPECT_EQ(reason(std::string(640, 'x') + some_values()), "none");
}

TEST(Values, MissingCutOrDamagedOnesAreToldApart) {
    const std::string good = some_values();
    EXPECT_EQ(reason(""), "the scene's values in `prog` are missing; build the program again");
    EXPECT_EQ(reason(std::string(1000, 'x')),
              "the scene's values in `prog` are missing; build the program again");
    EXPECT_EQ(reason(good.substr(0, good.size() - 1)),
              "the scene's values in `prog` are missing; build the program again");
    EXPECT_EQ(reason(good.substr(64)), "the scene's values in `prog` are cut; build the program again");
    for (std::size_t i = 0; i < good.size() - 24; i += 37) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 4);
        EXPECT_EQ(reason(bad), "the scene's values in `prog` are damaged; build the program again") << i;
    }
}

TEST(Values, ThoseOfOtherCodeAreRefused) {
    const std::string bytes = some_values();
    Values values(bytes_of(bytes), "prog");
    values.read_text();
    std::array<float, 4> four{};
    EXPECT_THROW(values.read(four), FileError);
    Values again(bytes_of(bytes), "prog");
    double number = 0;
    EXPECT_THROW(again.read(number), FileError);
}

TEST(Values, OfTheSameSceneAreTheSameBytes) {
    EXPECT_EQ(some_values(), some_values());
}

} // namespace
} // namespace scc::host
