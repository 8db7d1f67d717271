#pragma once

#include <vector>

namespace scc::compiler {

/// L7: a light's intensity at distance d is divided by kc + kl d + kq d^2.
struct Attenuation {
    double kc = 1, kl = 0, kq = 0;

    double at(double d) const { return 1 / (kc + d * (kl + d * kq)); }
};

/// One light as POV-Ray fades it: at distance d it gives gain * 2 / (1 + (d / distance)^power), or gain where
/// power is 0.
struct Fade {
    double gain = 1;
    double distance = 0;
    double power = 0;

    double at(double d) const;
};

/// Lights at one place whose sum has the attenuation.
struct FadeSum {
    std::vector<Fade> lights;
    bool exact = true;
    double bound = 0; ///< largest error from `near` to `far`, as a part of the attenuation at `near`

    double at(double d) const;
};

/// For surfaces at distances near..far (far may be infinite; 0 <= near < far) from the light. Attenuations
/// with real roots that lie apart are sums of faded lights; others are fitted with at most five.
FadeSum fade_lights(const Attenuation& attenuation, double near, double far);

} // namespace scc::compiler
