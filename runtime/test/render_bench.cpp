#include "runtime/test/lecture_scene.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>

/// Times the lecture scene, compiled and generic, in both precisions: 1280x720, one sample, one thread.
/// Processor time, so that other processes matter less.
namespace {

using namespace scc::runtime;

template <class S>
Image time_rendering(const char* name, const S& scene) {
    const RenderRequest request = test::request(1280, 720);
    Image image(1280, 720);
    double best = 1e30;
    RenderResult result;
    for (int run = 0; run < 7; ++run) {
        const std::clock_t start = std::clock();
        result = render(scene, request, image);
        best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    const auto rays = static_cast<double>(result.rays.primary + result.rays.shadow + result.rays.reflected);
    std::printf("%-20s %7.1f ms  %5.2f M rays  %6.1f ns per ray\n", name, best, rays * 1e-6,
                best * 1e6 / rays);
    return image;
}

template <class R>
void time_precision(const char* compiled, const char* generic) {
    const Image a = time_rendering(compiled, test::LectureScene<R>{});
    const Image b = time_rendering(generic, test::generic_lecture_scene<R>());
    if (std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) != 0) {
        std::puts("compiled and generic images differ");
    }
}

} // namespace

int main() {
    time_precision<double>("compiled, double", "generic, double");
    time_precision<float>("compiled, float", "generic, float");
}
