#include "lang/fuzz/targets.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace scc::lang::fuzz {
namespace {

/// Every file in a folder of the project that the fuzzers started from or have left.
void run_all(const std::string& folder, std::size_t least) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(SCC_SOURCE_DIR "/" + folder)) {
        if (!entry.is_regular_file() || entry.file_size() > 1'000'000) {
            continue;
        }
        SCOPED_TRACE(entry.path().string());
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
        for (auto* run : {fuzz_lexer, fuzz_parser, fuzz_checker, fuzz_formatter}) {
            run(text);
        }
        ++count;
    }
    EXPECT_GE(count, least);
}

TEST(Corpus, HoldsForWhatTheFuzzersFound) {
    run_all("lang/fuzz/corpus", 100);
}

TEST(Corpus, HoldsForTheExamples) {
    run_all("examples", 6);
}

} // namespace
} // namespace scc::lang::fuzz
