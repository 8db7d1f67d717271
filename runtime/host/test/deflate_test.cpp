#include "runtime/host/deflate.h"
#include "runtime/host/exr.h"
#include "runtime/host/file.h"
#include "runtime/host/png.h"
#include "runtime/host/read_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

/// What we compress is read back by OpenImageIO's PNG and OpenEXR libraries, which check all sums.
namespace scc::host {
namespace {

namespace fs = std::filesystem;
using runtime::Image;

class Deflate : public testing::Test {
protected:
    Deflate() {
        std::string name = (fs::temp_directory_path() / "scc-deflate-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~Deflate() override { fs::remove_all(folder_); }

    Image read_back(const std::string& name, const std::string& bytes) const {
        replace_file((folder_ / name).string(), bytes);
        return read_image((folder_ / name).string(), true);
    }

    fs::path folder_;
};

/// 16-bit codes of every kind: the value is what a linear reader sees.
enum class Content { black, noise, few, ramp, sparse, steep };

Image picture(Content content, int width, int height, int channels) {
    std::mt19937 random(7);
    Image image(width, height, channels);
    std::size_t i = 0;
    for (float& value : image.pixels) {
        const auto any = static_cast<float>(random() % 65536) / 65535;
        const auto place = static_cast<float>(i++) / static_cast<float>(image.pixels.size());
        switch (content) {
        case Content::black:
            value = 0;
            break;
        case Content::noise:
            value = any;
            break;
        case Content::few:
            value = static_cast<float>(random() % 3) / 2;
            break;
        case Content::ramp:
            value = place;
            break;
        case Content::sparse:
            value = random() % 200 == 0 ? any : 0.25F;
            break;
        case Content::steep: // counts like Fibonacci's numbers, whose Huffman code is as long as can be
            value =
                static_cast<float>(std::min(65535.0, 256 * std::floor(-std::log2(any + 1e-6) * 3))) / 65535;
            break;
        }
    }
    return image;
}

TEST_F(Deflate, FloatsOfEveryKindComeBack) {
    for (const Content content :
         {Content::black, Content::noise, Content::few, Content::ramp, Content::sparse, Content::steep}) {
        for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 17), std::pair(257, 100)}) {
            for (const int channels : {1, 3}) {
                const Image image = picture(content, width, height, channels);
                for (const bool compact : {false, true}) {
                    EXPECT_EQ(read_back("a.exr", encode_exr(image, compact, 2)).pixels, image.pixels)
                        << static_cast<int>(content) << " " << width << " " << channels << " " << compact;
                }
            }
        }
    }
}

TEST_F(Deflate, PngsOfEveryKindHoldTheSameCodesWhateverTheirSize) {
    for (const Content content :
         {Content::black, Content::noise, Content::few, Content::ramp, Content::sparse, Content::steep}) {
        for (const int channels : {1, 3}) {
            // Over 128 KiB: several strips. Its corner alone: one.
            const Image image = picture(content, 301, 190, channels);
            for (const int bits : {8, 16}) {
                const std::string bytes = encode_png(image, bits);
                EXPECT_EQ(bytes, encode_png(image, bits, 3));
                const Image whole = read_back("a.png", bytes);
                Image corner(7, 5, channels);
                for (int y = 0; y < corner.height; ++y) {
                    std::copy_n(image.at(0, y), 7 * channels, corner.at(0, y));
                }
                const Image small = read_back("b.png", encode_png(corner, bits));
                for (int y = 0; y < corner.height; ++y) {
                    for (int i = 0; i < 7 * channels; ++i) {
                        ASSERT_EQ(whole.at(0, y)[i], small.at(0, y)[i]) << static_cast<int>(content);
                    }
                }
            }
        }
    }
}

TEST_F(Deflate, WhatRepeatsTakesLittleRoomAndNoiseHardlyMoreThanItself) {
    EXPECT_LT(encode_png(picture(Content::black, 1000, 1000, 3)).size(), 20000U);
    EXPECT_LT(encode_png(picture(Content::sparse, 1000, 1000, 3)).size(), 150000U);
    EXPECT_LT(encode_exr(picture(Content::noise, 1000, 1000, 3), true).size(), 12050000U);
}

TEST(Sums, AreThoseOfTheirStandards) {
    EXPECT_EQ(crc32("123456789"), 0xcbf43926U);
    EXPECT_EQ(adler32("Wikipedia"), 0x11e60398U);
    std::string text;
    for (int i = 0; i < 40000; ++i) {
        text += static_cast<char>(255 - i % 7);
    }
    for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{20001}, text.size()}) {
        const std::string_view all = text;
        EXPECT_EQ(adler32_joined(adler32(all.substr(0, cut)), adler32(all.substr(cut)), text.size() - cut),
                  adler32(all));
    }
}

} // namespace
} // namespace scc::host
