#include "runtime/test/lecture_scene.h"

#include <chrono>
#include <cstdio>
#include <cstring>

/// Times the lecture scene, compiled and generic, in both precisions: 1280x720, one sample, one thread.
namespace {

using namespace scc::runtime;

template <class S>
Image time_rendering(const char* name, const S& scene) {
    const RenderRequest request = test::request(1280, 720);
    Image image(1280, 720);
    double best = 1e30;
    RenderResult result;
    for (int run = 0; run < 7; ++run) {
        const auto start = std::chrono::steady_clock::now();
        result = render(scene, request, image);
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        best = std::min(best, time.count());
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
