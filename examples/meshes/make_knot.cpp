// Makes knot.obj, the mesh that mesh.scn shows: a tube around a trefoil knot, with exact normals. It stands
// where the Stanford bunny stands in its file and has its size, so that one scene suits both.
//   make_knot knot.obj
// A thinner tube, which nowhere meets itself, of fewer triangles (cutaway.scn):
//   make_knot thin_knot.obj 0.012 128 16

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace {

using Vector = std::array<double, 3>;

int along = 400;
int around = 32;
constexpr double size = 0.0245; // of the knot; its outer radius is about 3.6 times this
double tube = 0.018;
constexpr Vector center{-0.0168, 0.1245, 0.0};

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector normalized(const Vector& v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

// The trefoil (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t) and its derivatives.
Vector curve(double t) {
    return {std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
}
Vector velocity(double t) {
    return {std::cos(t) + 4 * std::cos(2 * t), -std::sin(t) + 4 * std::sin(2 * t), -3 * std::cos(3 * t)};
}
Vector acceleration(double t) {
    return {-std::sin(t) - 8 * std::sin(2 * t), -std::cos(t) + 8 * std::cos(2 * t), 9 * std::sin(3 * t)};
}

void write_ring(std::FILE* file, double t) {
    const Vector tangent = normalized(velocity(t));
    const Vector binormal = normalized(cross(velocity(t), acceleration(t)));
    const Vector normal = cross(binormal, tangent);
    const Vector middle = curve(t);
    for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        Vector n{};
        Vector p{};
        for (std::size_t i = 0; i < 3; ++i) {
            n[i] = std::cos(angle) * normal[i] + std::sin(angle) * binormal[i];
            p[i] = center[i] + size * middle[i] + tube * n[i];
        }
        std::fprintf(file, "v %.6f %.6f %.6f\nvn %.4f %.4f %.4f\n", p[0], p[1], p[2], n[0], n[1], n[2]);
    }
}

int vertex(int ring, int k) {
    return (ring % along) * around + k % around + 1;
}

void write_triangle(std::FILE* file, int a, int b, int c) {
    std::fprintf(file, "f %d//%d %d//%d %d//%d\n", a, a, b, b, c, c);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2 && argc != 5) {
        std::fprintf(stderr, "usage: make_knot FILE.obj [RADIUS RINGS CORNERS]\n");
        return 2;
    }
    if (argc == 5) {
        tube = std::atof(argv[2]);
        along = std::atoi(argv[3]);
        around = std::atoi(argv[4]);
    }
    std::FILE* file = std::fopen(argv[1], "w");
    if (file == nullptr) {
        std::perror(argv[1]);
        return 3;
    }
    std::fprintf(file, "# a tube around a trefoil knot, made by make_knot.cpp\n");
    for (int ring = 0; ring < along; ++ring) {
        write_ring(file, 2 * std::numbers::pi * ring / along);
    }
    for (int ring = 0; ring < along; ++ring) {
        for (int k = 0; k < around; ++k) {
            write_triangle(file, vertex(ring, k), vertex(ring + 1, k + 1), vertex(ring + 1, k));
            write_triangle(file, vertex(ring, k), vertex(ring, k + 1), vertex(ring + 1, k + 1));
        }
    }
    const bool written = std::ferror(file) == 0;
    return std::fclose(file) == 0 && written ? 0 : 3;
}
