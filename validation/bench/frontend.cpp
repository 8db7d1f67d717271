#include "validation/bench/frontend.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

namespace scc::bench {

namespace {

constexpr const char* scn_view =
    "perspective_camera { eye = (0, 9, 14), target = (0, 0, 0), fov_y = 35deg }\n"
    "directional_light { direction = (-1, -3, -1) }\n";
constexpr const char* pov_view = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
                                 "camera { location <0, 9, 14> look_at 0 angle 35 }\n"
                                 "light_source { <1000, 3000, 1000> rgb 1 parallel point_at 0 }\n";

SphereScene write(const std::filesystem::path& folder, const std::string& name, const std::string& scn,
                  const std::string& pov) {
    SphereScene scene{folder / (name + ".scn"), folder / (name + ".pov"), static_cast<double>(scn.size()),
                      static_cast<double>(pov.size())};
    std::ofstream(scene.scn) << scn;
    std::ofstream(scene.pov) << pov;
    return scene;
}

} // namespace

SphereScene write_flat_spheres(std::size_t count, const std::filesystem::path& folder) {
    std::string scn = scn_view;
    std::string pov = pov_view;
    for (std::size_t i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i);
        const double a = k * 137.50776 * std::numbers::pi / 180;
        const double r = 0.03 * std::sqrt(k);
        const double x = r * std::cos(a), y = 0.4 * std::sin(7 * r), z = r * std::sin(a);
        const double radius = 0.01 + 0.015 * std::fmod(k * 0.618034, 1);
        scn +=
            fmt::format("sphere {{ center = ({:.6f}, {:.6f}, {:.6f}), radius = {:.6f} }}\n", x, y, z, radius);
        pov += fmt::format("sphere {{ <{:.6f}, {:.6f}, {:.6f}>, {:.6f} }}\n", x, y, z, radius);
    }
    return write(folder, fmt::format("flat_{}", count), scn, pov);
}

SphereScene write_loop_of_spheres(std::size_t count, const std::filesystem::path& folder) {
    const std::string scn = fmt::format(R"({}let palette = [#e63946, #f1faee, #a8dadc, #457b9d, #1d3557]
fn place(i: number) -> vec3 {{
  let a = i * 137.50776deg
  let r = 0.03 * sqrt(i)
  (r * cos(a), 0.4 * sin(7 * r), r * sin(a))
}}
for (i in 0..{}) {{
  sphere {{ center = place(i), radius = 0.01 + 0.015 * (i * 0.618034 % 1), material = phong {{ diffuse = palette[i % 5] }} }}
}}
)",
                                        scn_view, count);
    const std::string pov = fmt::format(R"({}#declare Palette = array[5] {{
  rgb <0.791, 0.041, 0.061>, rgb <0.880, 0.956, 0.855>, rgb <0.392, 0.708, 0.716>, rgb <0.060, 0.198, 0.337>,
  rgb <0.012, 0.036, 0.095> }}
#declare I = 0;
#while (I < {})
  #declare A = I*137.50776*pi/180;
  #declare R = 0.03*sqrt(I);
  sphere {{ <R*cos(A), 0.4*sin(7*R), R*sin(A)>, 0.01 + 0.015*mod(I*0.618034, 1) pigment {{ Palette[mod(I, 5)] }} }}
  #declare I = I + 1;
#end
)",
                                        pov_view, count);
    return write(folder, fmt::format("loop_{}", count), scn, pov);
}

} // namespace scc::bench
