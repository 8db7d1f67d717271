// Makes lighthouse.obj, the mesh of several materials that lighthouse.scn shows: rings around the y axis,
// each band of them a part of its own. What the parts are made of stands in lighthouse.mtl.
//   make_lighthouse lighthouse.obj

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>

namespace {

constexpr int around = 32;

struct Ring {
    double radius, height;
    const char* material; ///< up to the next ring; null: nothing there
};
constexpr std::array<Ring, 17> rings{{{1.6, 0.0, "rock"},
                                      {1.45, 0.25, "rock"},
                                      {0.9, 0.4, "white"},
                                      {0.82, 1.2, "red"},
                                      {0.74, 2.0, "white"},
                                      {0.66, 2.8, "red"},
                                      {0.6, 3.4, "white"},
                                      {0.58, 3.7, "iron"},
                                      {0.8, 3.75, "iron"},
                                      {0.8, 3.85, "iron"},
                                      {0.45, 3.85, "glass"},
                                      {0.45, 4.5, "iron"},
                                      {0.62, 4.5, "red"},
                                      {0.0, 5.0, nullptr},
                                      {0.0, 3.9, "lamp"},
                                      {0.16, 4.1, "lamp"},
                                      {0.0, 4.35, nullptr}}};

int corner(std::size_t ring, int k) {
    return static_cast<int>(ring) * around + k % around + 1;
}

} // namespace

int main(int argc, char** argv) {
    std::FILE* file = argc == 2 ? std::fopen(argv[1], "w") : nullptr;
    if (file == nullptr) {
        std::fprintf(stderr, "usage: make_lighthouse FILE.obj\n");
        return 2;
    }
    std::fprintf(file, "# a lighthouse, made by make_lighthouse.cpp\nmtllib lighthouse.mtl\n");
    for (const Ring& ring : rings) {
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * std::numbers::pi * k / around;
            std::fprintf(file, "v %.5f %.5f %.5f\n", ring.radius * std::sin(angle), ring.height,
                         ring.radius * std::cos(angle));
        }
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        if (rings[i].material == nullptr) {
            continue;
        }
        std::fprintf(file, "usemtl %s\n", rings[i].material);
        for (int k = 0; k < around; ++k) {
            if (rings[i].radius > 0) {
                std::fprintf(file, "f %d %d %d\n", corner(i, k), corner(i, k + 1), corner(i + 1, k + 1));
            }
            if (rings[i + 1].radius > 0) {
                std::fprintf(file, "f %d %d %d\n", corner(i, k), corner(i + 1, k + 1), corner(i + 1, k));
            }
        }
    }
    return std::fclose(file) == 0 ? 0 : 3;
}
