#include "lang/fuzz/targets.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace scc::lang::fuzz {
namespace {

/// What the fuzzers start from: the scenes of the project, right ones and such with mistakes.
TEST(Corpus, HoldsForEverySceneOfTheProject) {
    std::size_t count = 0;
    for (const char* folder : {"examples", "lang/test", "compiler", "validation"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::string(SCC_SOURCE_DIR "/") + folder)) {
            if (entry.path().extension() != ".scn") {
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
    }
    EXPECT_GE(count, 12U);
}

} // namespace
} // namespace scc::lang::fuzz
