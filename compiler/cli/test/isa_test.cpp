#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>
#include <string>

/// The renderer in scc is compiled for several instruction sets.
namespace scc::cli::test {
namespace {

class InstructionSets : public CommandLine {
protected:
    validation::ProcessResult draw(const std::string& scene, const std::string& isa,
                                   const std::string& precision) {
        return scc({"render", scene, "-o", isa + ".pfm", "--size", "83x61", "--samples", "4", "--precision",
                    precision, "--stats", "-"},
                   {{"SCC_ISA", isa}});
    }
};

TEST_F(InstructionSets, DrawTheSameBits) {
    for (const char* name : {"lecture.scn", "mesh.scn", "shading.scn"}) {
        for (const char* precision : {"float", "double"}) {
            std::string fastest;
            ASSERT_TRUE(draw(example(name), "baseline", precision).ok());
            for (const char* isa : {"avx2", "avx512"}) {
                const auto drawn = draw(example(name), isa, precision);
                if (drawn.code == 2) {
                    continue; // not on this machine
                }
                ASSERT_TRUE(drawn.ok()) << drawn.err;
                EXPECT_EQ(nlohmann::json::parse(drawn.out)["isa"], isa);
                EXPECT_TRUE(read(std::string(isa) + ".pfm") == read("baseline.pfm"))
                    << name << " " << precision << " " << isa;
                fastest = isa;
            }
            if (!fastest.empty()) {
                EXPECT_EQ(nlohmann::json::parse(draw(example(name), "", precision).out)["isa"], fastest);
            }
        }
    }
}

TEST_F(InstructionSets, UnknownOnesAreAMistake) {
    write("s.scn", small_scene);
    const auto result = draw("s.scn", "mmx", "double");
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("SCC_ISA is `mmx`; on this machine it may be: baseline"), std::string::npos)
        << result.err;
    EXPECT_EQ(files(), std::vector<std::string>{"s.scn"});
}

// Else the linker might take a function that is compiled for a larger instruction set for the whole program.
TEST_F(InstructionSets, ShareNoFunctionWithTheProgram) {
    std::istringstream objects(SCC_ISOLATED_OBJECTS);
    for (std::string object; std::getline(objects, object, '|');) {
        const auto names = start("nm", {"--defined-only", "--extern-only", object});
        ASSERT_TRUE(names.ok()) << names.err;
        EXPECT_EQ(std::count(names.out.begin(), names.out.end(), '\n'), 1) << names.out;
        const bool is_kernel = names.out.find(" T scc_render_") != std::string::npos ||
                               names.out.find(" T scc_raster_") != std::string::npos;
        EXPECT_TRUE(is_kernel) << names.out;
        const auto groups = start("readelf", {"--section-groups", "--wide", object});
        EXPECT_NE(groups.out.find("There are no section groups"), std::string::npos) << groups.out;
    }
}

} // namespace
} // namespace scc::cli::test
