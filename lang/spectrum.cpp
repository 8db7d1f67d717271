#include "lang/spectrum.h"

#include <algorithm>
#include <cmath>

namespace scc::lang {
namespace {

using Point = std::array<double, 2>;

double on_lines(std::span<const Point> points, double nm) {
    const auto after =
        std::upper_bound(points.begin(), points.end(), nm, [](double x, const Point& p) { return x < p[0]; });
    if (after == points.begin() || after == points.end()) {
        return after == points.begin() ? points.front()[1] : points.back()[1];
    }
    const Point& a = *(after - 1);
    const Point& b = *after;
    return a[1] + (b[1] - a[1]) * ((nm - a[0]) / (b[0] - a[0]));
}

/// The mean under a hat that is 1 at `nm` and 0 one step beside it. Between the points and the hat's corners
/// the product is a polynomial of degree 2, for which Simpson's rule is exact.
double under_hat(std::span<const Point> points, double nm) {
    std::vector<double> corners{nm - wavelength_step, nm, nm + wavelength_step};
    for (const Point& p : points) {
        if (p[0] > corners[0] && p[0] < nm + wavelength_step) {
            corners.push_back(p[0]);
        }
    }
    std::sort(corners.begin(), corners.end());
    const auto product = [&](double x) {
        return on_lines(points, x) * (1 - std::abs(x - nm) / wavelength_step);
    };
    double sum = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const double a = corners[i - 1];
        const double b = corners[i];
        sum += (b - a) / 6 * (product(a) + 4 * product((a + b) / 2) + product(b));
    }
    return sum / wavelength_step;
}

// ---- illuminants ------------------------------------------------------------------------------------------

Spectrum scaled_to_one(Spectrum light) {
    const double y = xyz_of_light(light)[1];
    for (double& value : light) {
        value /= y;
    }
    return light;
}

/// CIE 15:2004, 3.1: Planck's law at 2848 K, with the c2 of 1931.
Spectrum make_a() {
    Spectrum light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        light[i] = std::pow(560 / wavelength(i), 5) / std::expm1(1.435e7 / (2848 * wavelength(i)));
    }
    return scaled_to_one(light);
}

/// CIE 15:2004, table T.1, every second row; those between are the means of their neighbours there too.
constexpr std::array<double, 41> d65{
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

Spectrum make_d65() {
    Spectrum light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        light[i] = (d65[i / 2] + d65[(i + 1) / 2]) / 2;
    }
    return scaled_to_one(light);
}

Spectrum make_e() {
    Spectrum light{};
    light.fill(1);
    return light;
}

// ---- metals -----------------------------------------------------------------------------------------------

struct Index {
    double nm, n, k;
};

struct Metal {
    std::string_view name;
    std::span<const Index> indices;
};

// P. B. Johnson and R. W. Christy, Optical constants of the noble metals, Phys. Rev. B 6, 4370 (1972)
constexpr Index gold[]{
    {367.9, 1.48, 1.895}, {381.5, 1.46, 1.933}, {397.4, 1.47, 1.952}, {413.3, 1.46, 1.958},
    {430.5, 1.45, 1.948}, {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833},
    {520.9, 0.62, 2.081}, {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863}, {616.8, 0.21, 3.272},
    {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103}, {756.0, 0.14, 4.542}, {821.1, 0.16, 5.083}};
constexpr Index silver[]{
    {367.9, 0.07, 1.657}, {381.5, 0.05, 1.864}, {397.4, 0.05, 2.070}, {413.3, 0.05, 2.275},
    {430.5, 0.04, 2.462}, {450.9, 0.04, 2.657}, {471.4, 0.05, 2.869}, {495.9, 0.05, 3.093},
    {520.9, 0.05, 3.324}, {548.6, 0.06, 3.586}, {582.1, 0.05, 3.858}, {616.8, 0.06, 4.152},
    {659.5, 0.05, 4.483}, {704.5, 0.04, 4.838}, {756.0, 0.03, 5.242}, {821.1, 0.04, 5.727}};
constexpr Index copper[]{
    {367.9, 1.36, 1.975}, {381.5, 1.33, 2.045}, {397.4, 1.32, 2.116}, {413.3, 1.28, 2.207},
    {430.5, 1.25, 2.305}, {450.9, 1.24, 2.397}, {471.4, 1.25, 2.483}, {495.9, 1.22, 2.564},
    {520.9, 1.18, 2.608}, {548.6, 1.02, 2.577}, {582.1, 0.70, 2.704}, {616.8, 0.30, 3.205},
    {659.5, 0.22, 3.747}, {704.5, 0.21, 4.205}, {756.0, 0.24, 4.665}, {821.1, 0.26, 5.180}};
// P. B. Johnson and R. W. Christy, Optical constants of transition metals, Phys. Rev. B 9, 5056 (1974)
constexpr Index iron[]{{368, 2.02, 2.43}, {381, 2.12, 2.50}, {397, 2.24, 2.58}, {413, 2.35, 2.65},
                       {431, 2.48, 2.71}, {451, 2.59, 2.77}, {471, 2.67, 2.82}, {496, 2.74, 2.88},
                       {521, 2.86, 2.91}, {549, 2.95, 2.93}, {582, 2.94, 2.99}, {617, 2.88, 3.05},
                       {659, 2.92, 3.10}, {704, 2.86, 3.19}, {756, 2.87, 3.28}, {821, 2.94, 3.39}};
constexpr Index chromium[]{{368, 1.87, 2.69}, {381, 1.92, 2.74}, {397, 2.00, 2.83}, {413, 2.08, 2.93},
                           {431, 2.19, 3.04}, {451, 2.33, 3.14}, {471, 2.51, 3.24}, {496, 2.75, 3.30},
                           {521, 2.94, 3.33}, {549, 3.18, 3.33}, {582, 3.22, 3.30}, {617, 3.17, 3.30},
                           {659, 3.09, 3.34}, {704, 3.05, 3.39}, {756, 3.08, 3.42}, {821, 3.20, 3.48}};
// A. D. Rakic, Algorithm for the determination of intrinsic optical constants of metal films, Appl. Opt. 34,
// 4755 (1995)
constexpr Index aluminium[]{{364.66, 0.39877, 4.3957}, {413.28, 0.52135, 5.0008}, {442.80, 0.60790, 5.3676},
                            {476.87, 0.72780, 5.7781}, {516.60, 0.87340, 6.2418}, {563.57, 1.0728, 6.7839},
                            {619.93, 1.3660, 7.4052},  {652.25, 1.5724, 7.7354},  {688.81, 1.8301, 8.0601},
                            {729.32, 2.1606, 8.3565},  {774.91, 2.6154, 8.4914},  {794.78, 2.7675, 8.3866}};

constexpr std::array<Metal, 6> metals{{{"aluminium", aluminium},
                                       {"chromium", chromium},
                                       {"copper", copper},
                                       {"gold", gold},
                                       {"iron", iron},
                                       {"silver", silver}}};

/// Fresnel's equations at normal incidence.
double reflectance(double n, double k) {
    return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

// ---- reflectances of Rec.709 ------------------------------------------------------------------------------

/// The solution of the problem that the header states, by the method of active sets.
constexpr std::array<Spectrum, 3> reflectances_of_rec709{{
    {0.0248981, 0.0248958, 0.0248898, 0.0248762, 0.0248463, 0.0247795, 0.0246521, 0.024411,  0.0239776,
     0.0232473, 0.0221766, 0.0208863, 0.0197148, 0.0193073, 0.0206028, 0.024918,  0.0295907, 0.0239566,
     0.0129779, 0.002839,  0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0.0355802, 0.1117675, 0.2179351, 0.3431075, 0.4761348, 0.6072136, 0.7277912,
     0.8309104, 0.9114027, 0.9661733, 0.9952,    0.999984,  0.9999853, 0.9999863, 0.9999872, 0.9999878,
     0.9999883, 0.9999886, 0.9999889, 0.9999891, 0.9999892, 0.9999893, 0.9999894, 0.9999894, 0.9999895,
     0.9999895, 0.9999895, 0.9999895, 0.9999895, 0.9999895, 0.9999895, 0.9999895, 0.9999895, 0.9999895,
     0.9999896, 0.9999896, 0.9999896, 0.9999896, 0.9999896, 0.9999896, 0.9999896, 0.9999896, 0.9999896},
    {0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0.0083566, 0.0499445,
     0.1183596, 0.2048262, 0.3006335, 0.4027172, 0.5075814, 0.6111808, 0.7098234, 0.7998723, 0.8775283,
     0.9389749, 0.9807095, 1.0000148, 1.0000024, 0.9999917, 0.9999827, 0.9999754, 0.9999697, 0.9999656,
     0.9965904, 0.9759516, 0.923365,  0.8396503, 0.7334528, 0.6136866, 0.4893226, 0.3682211, 0.2572928,
     0.1621287, 0.0868335, 0.0338072, 0.0047823, 0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0},
    {0.9753958, 0.9753981, 0.9754041, 0.9754176, 0.9754476, 0.9755142, 0.9756414, 0.9758821, 0.9763148,
     0.9770437, 0.978112,  0.9793987, 0.9805651, 0.9809656, 0.9796612, 0.975335,  0.9622927, 0.9263241,
     0.8688713, 0.7925262, 0.6995394, 0.5974368, 0.4925534, 0.3889348, 0.2902733, 0.2002061, 0.1225325,
     0.0610693, 0.0193193, 0,         0,         0,         0,         0,         0,         0,
     0.0033726, 0.0240099, 0.0410161, 0.0485442, 0.0485755, 0.0431715, 0.0345106, 0.0245359, 0.0148893,
     0.0069369, 0.0017421, 0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0,
     0,         0,         0,         0,         0,         0,         0,         0,         0},
}};

} // namespace

Spectrum sampled(std::span<const std::array<double, 2>> points) {
    bool is_fine = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
        is_fine = is_fine || points[i][0] - points[i - 1][0] < wavelength_step;
    }
    Spectrum result{};
    for (std::size_t i = 0; i < spectrum_size; ++i) {
        result[i] = is_fine ? under_hat(points, wavelength(i)) : on_lines(points, wavelength(i));
    }
    return result;
}

Triple xyz_of_light(const Spectrum& light) {
    Triple sum{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            sum[k] += xyz_weights()[k][i] * light[i];
        }
    }
    return sum;
}

const Spectrum* find_illuminant(std::string_view name) {
    static const Spectrum a = make_a();
    static const Spectrum daylight = make_d65();
    static const Spectrum e = make_e();
    return name == "a" ? &a : name == "d65" ? &daylight : name == "e" ? &e : nullptr;
}

std::vector<std::string_view> illuminant_names() {
    return {"a", "d65", "e"};
}

std::optional<Spectrum> metal_reflectance(std::string_view name) {
    const auto found =
        std::find_if(metals.begin(), metals.end(), [&](const Metal& metal) { return metal.name == name; });
    if (found == metals.end()) {
        return std::nullopt;
    }
    std::vector<Point> n, k;
    for (const Index& index : found->indices) {
        n.push_back({index.nm, index.n});
        k.push_back({index.nm, index.k});
    }
    Spectrum result{};
    for (std::size_t i = 0; i < spectrum_size; ++i) {
        result[i] = reflectance(on_lines(n, wavelength(i)), on_lines(k, wavelength(i)));
    }
    return result;
}

std::vector<std::string_view> metal_names() {
    std::vector<std::string_view> names;
    for (const Metal& metal : metals) {
        names.push_back(metal.name);
    }
    return names;
}

const std::array<Spectrum, 3>& rec709_reflectances() {
    return reflectances_of_rec709;
}

} // namespace scc::lang
