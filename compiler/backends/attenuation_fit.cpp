#include "compiler/backends/attenuation_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

namespace scc::compiler {

namespace {

constexpr std::size_t max_lights = 5;
constexpr double good_enough = 1e-6;
/// POV-Ray keeps colours as floats, so every light adds its own rounding.
constexpr double float_rounding = 6e-8;

// ---- sums that are equal to the attenuation --------------------------------------------------------------

/// Makes 1 / (1 + (d / D)^p) so steep that the 1 vanishes beside it; POV-Ray takes distances down to 1e-10.
constexpr double tiny_distance = 1e-9;
constexpr double tiny_distance_squared_fade = 1e-7;

/// 1 / (kq (d + a) (d + b)) for a < b, by partial fractions.
FadeSum fade_pair(double kq, double a, double b) {
    a = std::max(a, tiny_distance);
    return {{{1 / (2 * kq * (b - a) * a), a, 1}, {-1 / (2 * kq * (b - a) * b), b, 1}}};
}

std::optional<FadeSum> exact_sum(const Attenuation& k) {
    if (k.kl == 0 && k.kq == 0) {
        return FadeSum{{{1 / k.kc, 0, 0}}};
    }
    if (k.kl == 0) {
        const double distance = k.kc > 0 ? std::sqrt(k.kc / k.kq) : tiny_distance_squared_fade;
        return FadeSum{{{1 / (2 * k.kq * distance * distance), distance, 2}}};
    }
    if (k.kq == 0) {
        const double distance = k.kc > 0 ? k.kc / k.kl : tiny_distance;
        return FadeSum{{{1 / (2 * k.kl * distance), distance, 1}}};
    }
    // Close to a double root the two fractions nearly cancel, and float colours lose what remains.
    const double discriminant = k.kl * k.kl - 4 * k.kc * k.kq;
    if (discriminant < 0.01 * k.kl * k.kl) {
        return std::nullopt;
    }
    const double q = 0.5 * (k.kl + std::sqrt(discriminant));
    return fade_pair(k.kq, k.kc / q, q / k.kq);
}

// ---- sums that are fitted --------------------------------------------------------------------------------

using Column = std::vector<double>;

/// Logarithms of one light's fade_distance and fade_power.
struct Shape {
    double log_distance = 0, log_power = 0;
};

double fade(const Shape& shape, double d) {
    return 1 / (1 + std::pow(d / std::exp(shape.log_distance), std::exp(shape.log_power)));
}

double squared(const Column& v) {
    double sum = 0;
    for (const double x : v) {
        sum += x * x;
    }
    return sum;
}

struct LeastSquares {
    std::vector<double> coefficients;
    Column residual;
};

/// Minimises |columns c - target| by Householder reflections; the columns have full rank.
LeastSquares least_squares(std::vector<Column> columns, const Column& target) {
    const std::size_t n = columns.size(), m = target.size();
    const std::vector<Column> original = columns;
    Column rhs = target;
    const auto reflect = [m](const Column& v, std::size_t from, double norm2, Column& x) {
        double dot = 0;
        for (std::size_t i = from; i < m; ++i) {
            dot += v[i] * x[i];
        }
        for (std::size_t i = from; i < m; ++i) {
            x[i] -= 2 * dot / norm2 * v[i];
        }
    };
    for (std::size_t j = 0; j < n; ++j) {
        Column v = columns[j];
        std::fill_n(v.begin(), j, 0.0);
        v[j] += std::copysign(std::sqrt(squared(v)), v[j]);
        const double norm2 = squared(v);
        for (std::size_t k = j; k < n; ++k) {
            reflect(v, j, norm2, columns[k]);
        }
        reflect(v, j, norm2, rhs);
    }
    LeastSquares result{std::vector<double>(n), target};
    for (std::size_t j = n; j-- > 0;) {
        double sum = rhs[j];
        for (std::size_t k = j + 1; k < n; ++k) {
            sum -= columns[k][j] * result.coefficients[k];
        }
        result.coefficients[j] = sum / columns[j][j];
    }
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < m; ++i) {
            result.residual[i] -= result.coefficients[j] * original[j][i];
        }
    }
    return result;
}

/// Solves the positive definite system a x = b.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = j + 1; i < n; ++i) {
            const double factor = a[i][j] / a[j][j];
            for (std::size_t k = j; k < n; ++k) {
                a[i][k] -= factor * a[j][k];
            }
            b[i] -= factor * b[j];
        }
    }
    for (std::size_t j = n; j-- > 0;) {
        for (std::size_t k = j + 1; k < n; ++k) {
            b[j] -= a[j][k] * b[k];
        }
        b[j] /= a[j][j];
    }
    return b;
}

/// Fits sums of faded lights to an attenuation: the gains by linear least squares, distances and powers by
/// Levenberg-Marquardt steps around that (variable projection), and the largest error brought down by giving
/// weight to where the error is large (Lawson).
class Fitter {
public:
    Fitter(const Attenuation& attenuation, double near, double far)
        : k_(attenuation), middle_(std::sqrt(k_.kc / k_.kq)), distances_(grid(near, far, 160)),
          dense_(grid(near, far, 4001)), peak_(k_.at(near)) {
        target_.reserve(distances_.size());
        for (const double d : distances_) {
            target_.push_back(k_.at(d) / peak_);
        }
    }

    FadeSum run() {
        Candidate best;
        for (std::size_t lights = 1; lights <= max_lights; ++lights) {
            for (int trial = 0; trial < 8; ++trial) {
                attempt(start(lights, trial), best);
                if (best.score <= good_enough) {
                    return best.sum;
                }
            }
        }
        return best.sum;
    }

private:
    struct Candidate {
        FadeSum sum;
        double score = INFINITY;
    };
    struct State {
        std::vector<Shape> shapes;
        std::vector<Column> columns; ///< weighted; then one row per light that keeps its gain small
        LeastSquares solution;
        double cost = INFINITY;
    };

    /// Chebyshev points in d / (d + middle), which is even over the range where the attenuation changes.
    Column grid(double near, double far, std::size_t count) const {
        const double from = near / (near + middle_);
        const double to = std::isinf(far) ? 1 - 1e-7 : far / (far + middle_);
        Column points(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(count - 1);
            const double u = (from + to) / 2 - (to - from) / 2 * std::cos(angle);
            points[i] = middle_ * u / (1 - u);
        }
        return points;
    }

    /// The first light has the attenuation's own pair of complex poles, |pole| = distance and arg(pole) = pi
    /// / power; what remains is smooth, and the other lights start as 1 / (d + D) spread around it.
    std::vector<Shape> start(std::size_t lights, int trial) {
        const double discriminant = k_.kl * k_.kl - 4 * k_.kc * k_.kq;
        const double angle = std::numbers::pi - std::atan2(std::sqrt(std::max(0.0, -discriminant)), k_.kl);
        std::vector<Shape> shapes{{std::log(middle_), std::log(std::numbers::pi / angle)}};
        for (std::size_t i = 1; i < lights; ++i) {
            const double offset = static_cast<double>(i) - static_cast<double>(lights) / 2;
            shapes.push_back({std::log(middle_) + 1.5 * offset, 0});
        }
        for (Shape& shape : shapes) {
            shape.log_distance += trial == 0 ? 0 : 0.9 * random();
            shape.log_power += trial == 0 ? 0 : 0.3 * random();
        }
        return shapes;
    }

    void attempt(std::vector<Shape> shapes, Candidate& best) {
        weights_.assign(distances_.size(), 1);
        State state = evaluate(std::move(shapes));
        for (int round = 0; round < 12 && best.score > good_enough; ++round) {
            descend(state, round == 0 ? 40 : 8);
            if (Candidate found = measure(state); found.score < best.score) {
                best = std::move(found);
            }
            reweight(state);
        }
    }

    /// Numbers in -1..1, the same in every run.
    double random() {
        seed_ = seed_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(seed_ >> 40U) / static_cast<double>(1U << 23U) - 1;
    }

    Column column(const std::vector<Shape>& shapes, std::size_t light) const {
        Column result(distances_.size() + shapes.size());
        for (std::size_t i = 0; i < distances_.size(); ++i) {
            result[i] = weights_[i] * fade(shapes[light], distances_[i]);
        }
        result[distances_.size() + light] = 1e-7;
        return result;
    }

    void project(State& state) const {
        Column target(distances_.size() + state.shapes.size());
        for (std::size_t i = 0; i < distances_.size(); ++i) {
            target[i] = weights_[i] * target_[i];
        }
        state.solution = least_squares(state.columns, target);
        state.cost = squared(state.solution.residual);
    }

    State evaluate(std::vector<Shape> shapes) const {
        State state{std::move(shapes), {}, {}};
        for (std::size_t i = 0; i < state.shapes.size(); ++i) {
            state.columns.push_back(column(state.shapes, i));
        }
        project(state);
        return state;
    }

    std::vector<Column> jacobian(const State& state) const {
        constexpr double step = 1e-6;
        std::vector<Column> derivatives;
        for (std::size_t j = 0; j < 2 * state.shapes.size(); ++j) {
            State moved = state;
            Shape& shape = moved.shapes[j / 2];
            (j % 2 == 0 ? shape.log_distance : shape.log_power) += step;
            moved.columns[j / 2] = column(moved.shapes, j / 2);
            project(moved);
            Column& derivative = moved.solution.residual;
            for (std::size_t i = 0; i < derivative.size(); ++i) {
                derivative[i] = (derivative[i] - state.solution.residual[i]) / step;
            }
            derivatives.push_back(std::move(derivative));
        }
        return derivatives;
    }

    static std::vector<Shape> stepped(std::vector<Shape> shapes, const std::vector<double>& step) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            shapes[i].log_distance += std::clamp(step[2 * i], -0.5, 0.5);
            shapes[i].log_power = std::clamp(shapes[i].log_power + std::clamp(step[2 * i + 1], -0.5, 0.5),
                                             std::log(0.2), std::log(8.0));
        }
        return shapes;
    }

    void descend(State& state, int steps) const {
        double damping = 1e-3;
        for (int i = 0; i < steps; ++i) {
            const double before = state.cost;
            if (!improve(state, damping) || before - state.cost < 1e-9 * before) {
                return;
            }
        }
    }

    bool improve(State& state, double& damping) const {
        const std::vector<Column> derivatives = jacobian(state);
        const std::size_t n = derivatives.size();
        std::vector<std::vector<double>> normal(n, std::vector<double>(n));
        std::vector<double> gradient(n);
        const auto dot = [](const Column& a, const Column& b) {
            double sum = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                sum += a[i] * b[i];
            }
            return sum;
        };
        for (std::size_t a = 0; a < n; ++a) {
            gradient[a] = -dot(derivatives[a], state.solution.residual);
            for (std::size_t b = 0; b < n; ++b) {
                normal[a][b] = dot(derivatives[a], derivatives[b]);
            }
        }
        for (int tries = 0; tries < 8; ++tries) {
            auto damped = normal;
            for (std::size_t a = 0; a < n; ++a) {
                damped[a][a] += damping * normal[a][a] + 1e-30;
            }
            State next = evaluate(stepped(state.shapes, solve(std::move(damped), gradient)));
            if (next.cost < state.cost) {
                state = std::move(next);
                damping = std::max(damping / 5, 1e-12);
                return true;
            }
            damping *= 4;
        }
        return false;
    }

    Candidate measure(const State& state) const {
        FadeSum sum;
        sum.exact = false;
        for (std::size_t i = 0; i < state.shapes.size(); ++i) {
            sum.lights.push_back({peak_ * state.solution.coefficients[i] / 2,
                                  std::exp(state.shapes[i].log_distance),
                                  std::exp(state.shapes[i].log_power)});
        }
        double rounding = 0;
        for (const double d : dense_) {
            double magnitude = 0;
            for (const Fade& light : sum.lights) {
                magnitude += std::abs(light.at(d));
            }
            rounding = std::max(rounding, float_rounding * magnitude / peak_);
            sum.bound = std::max(sum.bound, std::abs(sum.at(d) - k_.at(d)) / peak_);
        }
        const double score = sum.bound + rounding;
        return {std::move(sum), std::isnan(score) ? INFINITY : score};
    }

    void reweight(State& state) {
        double largest = 1e-300;
        Column errors(distances_.size());
        for (std::size_t i = 0; i < distances_.size(); ++i) {
            errors[i] = std::abs(state.solution.residual[i]) / weights_[i];
            largest = std::max(largest, errors[i]);
        }
        double sum = 0;
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            weights_[i] *= std::sqrt(errors[i] / largest + 0.03);
            sum += weights_[i];
        }
        for (double& weight : weights_) {
            weight *= static_cast<double>(weights_.size()) / sum;
        }
        state = evaluate(std::move(state.shapes));
    }

    Attenuation k_;
    double middle_;
    Column distances_, dense_;
    double peak_;
    Column target_, weights_;
    std::uint64_t seed_ = 1;
};

} // namespace

double Fade::at(double d) const {
    return power == 0 ? gain : gain * 2 / (1 + std::pow(d / distance, power));
}

double FadeSum::at(double d) const {
    double sum = 0;
    for (const Fade& light : lights) {
        sum += light.at(d);
    }
    return sum;
}

FadeSum fade_lights(const Attenuation& attenuation, double near, double far) {
    if (auto sum = exact_sum(attenuation)) {
        return *std::move(sum);
    }
    return Fitter(attenuation, near, std::max(far, near * 1.001)).run();
}

} // namespace scc::compiler
