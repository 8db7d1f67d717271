// Makes vase.obj, the mesh with texture coordinates that textures.scn shows: a vase that stands at the
// origin, u once around it and v from its foot to its rim.
//   make_vase vase.obj

#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

constexpr int around = 48;
constexpr int along = 24;

double radius(double t) {
    return 0.34 + 0.16 * std::sin(2 * std::numbers::pi * (t * 1.05 - 0.06)) - 0.08 * t;
}

void write_corner(std::FILE* file, int ring, int k) {
    const int vertex = ring * around + k % around + 1, uv = ring * (around + 1) + k + 1;
    std::fprintf(file, " %d/%d", vertex, uv);
}

} // namespace

int main(int argc, char** argv) {
    std::FILE* file = argc == 2 ? std::fopen(argv[1], "w") : nullptr;
    if (file == nullptr) {
        std::fprintf(stderr, "usage: make_vase FILE.obj\n");
        return 2;
    }
    std::fprintf(file, "# a vase, made by make_vase.cpp\n");
    for (int ring = 0; ring <= along; ++ring) {
        const double t = static_cast<double>(ring) / along;
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * std::numbers::pi * k / around;
            std::fprintf(file, "v %.5f %.5f %.5f\n", radius(t) * std::sin(angle), 1.2 * t,
                         radius(t) * std::cos(angle));
        }
    }
    for (int ring = 0; ring <= along; ++ring) {
        for (int k = 0; k <= around; ++k) {
            std::fprintf(file, "vt %.6f %.6f\n", static_cast<double>(k) / around,
                         static_cast<double>(ring) / along);
        }
    }
    for (int ring = 0; ring < along; ++ring) {
        for (int k = 0; k < around; ++k) {
            std::fprintf(file, "f");
            write_corner(file, ring, k);
            write_corner(file, ring, k + 1);
            write_corner(file, ring + 1, k + 1);
            write_corner(file, ring + 1, k);
            std::fprintf(file, "\n");
        }
    }
    return std::fclose(file) == 0 ? 0 : 3;
}
