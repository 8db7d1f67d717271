#include "compiler/backends/cpp.h"
#include "compiler/backends/pov.h"
#include "compiler/ir/print.h"
#include "compiler/test/support.h"
#include "runtime/host/file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

/// golden/CASE.scn with the texts that it becomes beside it: CASE.ir, CASE.cpp, CASE.pov. With
/// SCC_UPDATE_GOLDEN=1 the texts are rewritten instead of compared; the change is then reviewed like code.
namespace scc::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path golden_folder = SCC_SOURCE_DIR "/compiler/test/golden";

std::vector<std::string> cases() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(golden_folder)) {
        if (entry.path().extension() == ".scn") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class Golden : public testing::TestWithParam<std::string> {
protected:
    void expect_golden(const std::string& extension, const std::string& text) {
        const fs::path file = golden_folder / (GetParam() + extension);
        if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
            host::replace_file(file.string(), text);
        } else {
            EXPECT_EQ(text, read(file)) << "SCC_UPDATE_GOLDEN=1 rewrites " << file.filename();
        }
    }
};

INSTANTIATE_TEST_SUITE_P(All, Golden, testing::ValuesIn(cases()),
                         [](const auto& name) { return name.param; });

TEST_P(Golden, BackendsEmitTheReviewedText) {
    test::Compiled c = test::compile(read(golden_folder / (GetParam() + ".scn")),
                                     {.name = GetParam(), .assets = {}, .camera = ""});
    ASSERT_TRUE(c.fine) << c.messages;
    run_passes(c.scene);
    expect_golden(".ir", print(c.scene));
    expect_golden(".cpp",
                  emit_cpp(c.scene, Precision::full, Numbers::in_code, GetParam() + ".values").source);
    Ledger ledger;
    expect_golden(".pov", test::emit_pov(c.scene, ledger));
}

} // namespace
} // namespace scc::compiler
