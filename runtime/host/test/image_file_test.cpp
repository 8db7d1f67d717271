#include "runtime/host/image_file.h"
#include "runtime/host/read_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace scc::host {
namespace {

namespace fs = std::filesystem;
using runtime::Image;

class ImageFile : public testing::Test {
protected:
    ImageFile() {
        std::string name = (fs::temp_directory_path() / "scc-image-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~ImageFile() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

private:
    fs::path folder_;
};

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Image ramp(int width, int height, int channels = 3) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<float>(i) / static_cast<float>(image.pixels.size() - 1);
    return image;
}

double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_of(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::string reason_of_failure(const std::string& path, const Image& image) {
    try {
        write_image(path, image);
    } catch (const FileError& error) {
        return error.what();
    }
    return "no error";
}

TEST_F(ImageFile, KnowsTypesByExtensionInAnyCase) {
    for (const char* name : {"a.exr", "a.PNG", "b/a.b.Pfm"})
        EXPECT_TRUE(is_image_type_known(name)) << name;
    for (const char* name : {"a.jpg", "png", "a.", "a.exr/b", ""})
        EXPECT_FALSE(is_image_type_known(name)) << name;
}

TEST_F(ImageFile, FloatTypesKeepEveryValue) {
    Image image = ramp(7, 5);
    image.pixels[0] = -3.25F;
    image.pixels[1] = 1e20F;
    image.pixels[2] = 1e-30F;
    image.pixels[3] = std::numeric_limits<float>::infinity();
    for (const char* name : {"a.exr", "a.pfm"}) {
        for (const bool compact : {false, true}) {
            write_image(path(name), image, {.compact = compact});
            const Image read = read_image(path(name));
            EXPECT_EQ(read.width, 7);
            EXPECT_EQ(read.height, 5);
            EXPECT_EQ(read.channels, 3);
            EXPECT_EQ(read.pixels, image.pixels) << name;
        }
    }
}

TEST_F(ImageFile, PngHoldsTheNearestSrgbCode) {
    const Image image = ramp(331, 67);
    for (const int bits : {8, 16}) {
        write_image(path("a.png"), image, {.bits = bits});
        const Image codes = read_image(path("a.png"), true);
        const int max = (1 << bits) - 1;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const double exact = srgb(static_cast<double>(image.pixels[i])) * max;
            ASSERT_NEAR(codes.pixels[i] * static_cast<float>(max), exact, 0.501 + 1e-2 * (bits == 16))
                << "value " << image.pixels[i] << " with " << bits << " bits";
        }
    }
}

TEST_F(ImageFile, PngIsDecodedFromSrgb) {
    Image image(256, 1, 1);
    for (int code = 0; code < 256; ++code)
        *image.at(code, 0) = static_cast<float>(linear_of(code / 255.0));
    write_image(path("a.png"), image);
    const Image read = read_image(path("a.png"));
    EXPECT_EQ(read.channels, 1);
    EXPECT_EQ(read.pixels, image.pixels);
}

TEST_F(ImageFile, PngClampsAndTurnsNanIntoBlack) {
    Image image(5, 1, 1);
    const float infinity = std::numeric_limits<float>::infinity();
    image.pixels = {-1, 2, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity};
    for (const int bits : {8, 16}) {
        write_image(path("a.png"), image, {.bits = bits});
        EXPECT_EQ(read_image(path("a.png")).pixels, (runtime::Pixels{0, 1, 0, 1, 0}));
    }
}

TEST_F(ImageFile, RowsRunFromTheTop) {
    Image image(2, 3, 1);
    *image.at(1, 0) = 1;
    for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
        write_image(path(name), image);
        EXPECT_EQ(read_image(path(name)).pixels, image.pixels) << name;
    }
    // The file itself, not only what reads it back: PFM stores the bottom row first.
    EXPECT_EQ(bytes_of(path("a.pfm")).substr(0, 12), "Pf\n2 3\n-1.0\n");
    EXPECT_EQ(bytes_of(path("a.pfm")).substr(12, 16), std::string(16, '\0'));
}

TEST_F(ImageFile, RepeatedRunsGiveTheSameBytesWithoutNamesOrTimes) {
    for (const char* type : {".exr", ".png", ".pfm"}) {
        const std::string first = path(std::string("first") + type);
        const std::string second = path(std::string("second") + type);
        write_image(first, ramp(64, 64));
        ::usleep(1'100'000 * (type == std::string(".png"))); // a PNG's time stamp counts seconds
        write_image(second, ramp(64, 64));
        EXPECT_EQ(bytes_of(first), bytes_of(second)) << type;
        EXPECT_EQ(bytes_of(first).find("first"), std::string::npos) << type;
        EXPECT_EQ(bytes_of(first).find("tmp"), std::string::npos) << type;
    }
}

TEST_F(ImageFile, ReplacesAnOlderFileAndLeavesNothingElse) {
    write_image(path("a.exr"), ramp(9, 9));
    write_image(path("a.exr"), ramp(3, 2));
    EXPECT_EQ(read_image(path("a.exr")).width, 3);
    EXPECT_EQ(files(), 1U);
}

TEST_F(ImageFile, MissingFolderIsNamedWithTheReason) {
    EXPECT_EQ(reason_of_failure(path("no/a.png"), ramp(2, 2)),
              "cannot write `" + path("no/a.png") + "`: No such file or directory");
}

TEST_F(ImageFile, FolderUnderTheFinalNameIsAnError) {
    fs::create_directory(path("a.png"));
    EXPECT_EQ(reason_of_failure(path("a.png"), ramp(2, 2)),
              "cannot write `" + path("a.png") + "`: Is a directory");
    EXPECT_EQ(files(), 1U);
}

TEST_F(ImageFile, UnwritableFolderIsAnError) {
    if (::geteuid() == 0)
        GTEST_SKIP() << "root may write everywhere";
    fs::create_directory(path("locked"));
    fs::permissions(path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(reason_of_failure(path("locked/a.png"), ramp(2, 2)),
              "cannot write `" + path("locked/a.png") + "`: Permission denied");
}

TEST_F(ImageFile, FullDiskIsAnErrorForEveryType) {
    for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
        fs::create_symlink("/dev/full", path(name));
        EXPECT_EQ(reason_of_failure(path(name), ramp(2, 2)),
                  "cannot write `" + path(name) + "`: No space left on device");
        EXPECT_TRUE(fs::is_character_file("/dev/full"));
    }
}

TEST_F(ImageFile, FailureHalfWayKeepsTheOldFileAndRemovesTheTemporaryOne) {
    write_image(path("a.exr"), ramp(2, 2));
    const std::string before = bytes_of(path("a.exr"));
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    rlimit small = old;
    small.rlim_cur = 1000;
    const auto previous = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string reason = reason_of_failure(path("a.exr"), ramp(300, 200));
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, previous);
    EXPECT_EQ(reason, "cannot write `" + path("a.exr") + "`: File too large");
    EXPECT_EQ(bytes_of(path("a.exr")), before);
    EXPECT_EQ(files(), 1U);
}

TEST_F(ImageFile, SymbolicLinkStaysOne) {
    write_image(path("real.exr"), ramp(2, 2));
    fs::create_symlink("real.exr", path("link.exr"));
    write_image(path("link.exr"), ramp(5, 2));
    EXPECT_TRUE(fs::is_symlink(path("link.exr")));
    EXPECT_EQ(read_image(path("real.exr")).width, 5);
}

TEST_F(ImageFile, MisuseIsToldApartFromTheEnvironment) {
    EXPECT_THROW(write_image(path("a.gif"), ramp(2, 2)), std::invalid_argument);
    EXPECT_THROW(write_image(path("a.png"), ramp(2, 2), {.bits = 12}), std::invalid_argument);
    EXPECT_THROW(write_image(path("a.png"), ramp(2, 2, 2)), std::invalid_argument);
    EXPECT_THROW(write_image(path("a.png"), Image()), std::invalid_argument);
    EXPECT_EQ(files(), 0U);
}

TEST_F(ImageFile, UnreadableFilesAreErrorsThatNameThem) {
    try {
        read_image(path("none.png"));
        FAIL();
    } catch (const FileError& error) {
        EXPECT_EQ(error.what(), "cannot read `" + path("none.png") + "`: No such file or directory");
    }
    // Not a PNG: OpenImageIO 2.4 leaks its message for one that is cut, which the leak checker reports.
    write_image(path("cut.exr"), ramp(40, 40));
    fs::resize_file(path("cut.exr"), 6000);
    EXPECT_THROW(read_image(path("cut.exr")), FileError);
    std::ofstream(path("text.exr")) << "not an image";
    EXPECT_THROW(read_image(path("text.exr")), FileError);
    std::ofstream(path("text.png")) << "not an image";
    EXPECT_THROW(read_image(path("text.png")), FileError);
}

} // namespace
} // namespace scc::host
