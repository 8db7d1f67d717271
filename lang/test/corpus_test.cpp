#include "lang/fuzz/corpus.h"
#include "lang/fuzz/targets.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace scc::lang::fuzz {
namespace {

std::string read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void run_all(std::string_view text) {
    for (auto* run : {fuzz_lexer, fuzz_parser, fuzz_checker, fuzz_formatter}) {
        run(text);
    }
}

TEST(Corpus, HoldsForWhatTheFuzzersFound) {
    const std::string corpus = read(SCC_SOURCE_DIR "/lang/fuzz/corpus");
    const auto texts = texts_of(corpus);
    EXPECT_GT(texts.size(), 900U);
    for (const std::string_view text : texts) {
        run_all(text);
    }
    EXPECT_THROW(texts_of(corpus.substr(0, corpus.size() - 1)), std::runtime_error);
}

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
            run_all(read(entry.path()));
            ++count;
        }
    }
    EXPECT_GE(count, 12U);
}

} // namespace
} // namespace scc::lang::fuzz
