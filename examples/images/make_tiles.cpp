// Makes tiles.ppm, from which tiles.png is: 64 x 64 texels of a wall of glazed tiles, one letter-like mark in
// each corner tile, so that a picture shows which way up it is and whether it is mirrored.
//   make_tiles > tiles.ppm && oiiotool tiles.ppm -o tiles.png

#include <array>
#include <cstdio>

namespace {

constexpr int size = 64, tile = 16, joint = 1;

using Color = std::array<int, 3>;

// An F, 5 x 7.
constexpr std::array<const char*, 7> mark{"#####", "#....", "#....", "####.", "#....", "#....", "#...."};

Color color_at(int x, int y) {
    const int in_x = x % tile, in_y = y % tile;
    if (in_x < joint || in_y < joint) {
        return {196, 190, 178};
    }
    const int column = x / tile, row = y / tile;
    const Color glaze = (column + row) % 2 == 0 ? Color{38, 92, 132} : Color{226, 214, 180};
    const int mark_x = (in_x - 4) / 2, mark_y = in_y - 5;
    const bool in_mark = in_x >= 4 && mark_x < 5 && mark_y >= 0 && mark_y < 7;
    if (column == 0 && row == 0 && in_mark && mark[static_cast<std::size_t>(mark_y)][mark_x] == '#') {
        return {214, 60, 40};
    }
    const int shade = (x * 7 + y * 13) % 11 - 5; // no tile is quite even
    return {glaze[0] + shade, glaze[1] + shade, glaze[2] + shade};
}

} // namespace

int main() {
    std::printf("P6\n%d %d\n255\n", size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            for (const int channel : color_at(x, y)) {
                std::putchar(channel);
            }
        }
    }
    return 0;
}
