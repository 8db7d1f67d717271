#include "compiler/cli/test/support.h"

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace scc::cli::test {
namespace {

const std::string reference = SCC_SOURCE_DIR "/lang/reference.md";

/// What stands between ```scn and ```.
std::vector<std::string> blocks_of(const std::string& text) {
    constexpr std::string_view open = "```scn\n";
    constexpr std::string_view close = "```\n";
    std::vector<std::string> blocks;
    for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
        at += open.size();
        const std::size_t end = text.find(close, at);
        blocks.push_back(text.substr(at, end - at));
        at = end + close.size();
    }
    return blocks;
}

/// SCC_UPDATE_GOLDEN=1 rewrites the file, to be reviewed like code.
TEST_F(CommandLine, TheReferenceIsWhatTheCompilerKnows) {
    const auto printed = scc({"reference"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
        host::replace_file(reference, printed.out);
        return;
    }
    std::ifstream in(reference, std::ios::binary);
    EXPECT_EQ(printed.out, std::string(std::istreambuf_iterator<char>(in), {}));
}

TEST_F(CommandLine, EveryExampleOfTheReferenceIsAScene) {
    const std::vector<std::string> blocks = blocks_of(scc({"reference"}).out);
    EXPECT_GT(blocks.size(), 60u);
    for (const std::string& block : blocks) {
        const std::size_t line = block.find('\n');
        const bool has_name = block.starts_with("// ") && block.substr(0, line).ends_with(".scn");
        const std::string name = has_name ? block.substr(3, line - 3) : "example.scn";
        write(name, block);
        const auto result = scc({"check", name});
        EXPECT_EQ(result.code, 0) << block << result.err;
        EXPECT_EQ(result.err.find("warning"), std::string::npos) << block << result.err;
    }
}

TEST_F(CommandLine, TheReferenceLeavesNothingWithoutAText) {
    const std::string text = scc({"reference"}).out;
    EXPECT_EQ(text.find(": ."), std::string::npos);
    EXPECT_EQ(text.find(" |  |\n"), std::string::npos);
}

} // namespace
} // namespace scc::cli::test
