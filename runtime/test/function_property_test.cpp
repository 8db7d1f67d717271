#include "runtime/function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

/// Bounds and derivatives of thousands of random functions against their values in long double.
using namespace scc::runtime;

namespace {

using Wide = long double;

struct Row {
    Opcode code;
    unsigned arity;
};
constexpr Row rows[] = {
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender) {Opcode::name, arity},
#include "runtime/operators.def"
#undef SCC_OPERATOR
};

bool compares(Opcode code) {
    return code >= Opcode::eq && code <= Opcode::ge;
}
bool combines_truths(Opcode code) {
    return code >= Opcode::logical_and && code <= Opcode::logical_not;
}

/// A function of p_x, p_y and p_z, typed as the language types it: conditions go into `select` and the
/// logical operators only. Its numbers are exact in float.
class Programs {
public:
    explicit Programs(unsigned seed) : engine_(seed) {}

    FunctionProgram<double> make(int length) {
        FunctionProgram<double> program;
        std::vector<std::uint32_t> numbers, truths;
        const auto add = [&](const Instruction<double>& one, std::vector<std::uint32_t>& kind) {
            kind.push_back(static_cast<std::uint32_t>(program.instructions.size()));
            program.instructions.push_back(one);
        };
        for (const Opcode input : {Opcode::p_x, Opcode::p_y, Opcode::p_z}) {
            add({input, {}, 0}, numbers);
        }
        for (int i = 0; i < 3; ++i) {
            add({Opcode::constant, {}, std::round(number(-20, 20)) / 8}, numbers);
        }
        const auto any = [&](const std::vector<std::uint32_t>& kind) {
            return kind[static_cast<std::size_t>(number(0, static_cast<double>(kind.size()) - 1e-9))];
        };
        while (static_cast<int>(program.instructions.size()) < length) {
            const Row& row = rows[static_cast<std::size_t>(number(0, std::size(rows) - 1e-9))];
            Instruction<double> one{row.code, {}, 0};
            const bool logical = combines_truths(row.code);
            if (truths.empty() && (logical || row.code == Opcode::select)) {
                continue;
            }
            for (unsigned k = 0; k < row.arity; ++k) {
                one.operands[k] = any(logical || (k == 0 && row.code == Opcode::select) ? truths : numbers);
            }
            add(one, logical || compares(row.code) ? truths : numbers);
        }
        return program;
    }
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }

private:
    std::mt19937 engine_;
};

template <class R>
FunctionProgram<R> in_precision(const FunctionProgram<double>& from) {
    FunctionProgram<R> to;
    for (const Instruction<double>& one : from.instructions) {
        to.instructions.push_back({one.code, one.operands, static_cast<R>(one.constant)});
    }
    return to;
}

template <class T, class F>
SurfacePoint<T> point_of(F&& coordinate) {
    SurfacePoint<T> point;
    point.p = {coordinate(0), coordinate(1), coordinate(2)};
    return point;
}

/// The registers whose value comes from finite values alone.
std::vector<bool> defined(const FunctionProgram<double>& program, const std::vector<Wide>& values) {
    std::vector<bool> result(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        result[k] = std::isfinite(values[k]);
        for (const Row& row : rows) {
            for (unsigned i = 0; row.code == program.instructions[k].code && i < row.arity; ++i) {
                result[k] = result[k] && result[program.instructions[k].operands[i]];
            }
        }
    }
    return result;
}

std::vector<Wide> values_of(const FunctionProgram<Wide>& program, const SurfacePoint<Wide>& point) {
    const Wide* values = run(program, point);
    return {values, values + program.instructions.size()};
}

std::string described(const FunctionProgram<double>& program, std::size_t node) {
    const Instruction<double>& one = program.instructions[node];
    return "register " + std::to_string(node) + ", opcode " + std::to_string(static_cast<int>(one.code)) +
           " of " + std::to_string(one.operands[0]) + " " + std::to_string(one.operands[1]) + " " +
           std::to_string(one.operands[2]);
}

template <class R>
class RandomFunction : public testing::Test {
public:
    struct Box {
        R min[3], max[3];
    };
    static Box box(Programs& random) {
        Box result;
        const double size = std::pow(10, random.number(-7, 0.7));
        for (int i = 0; i < 3; ++i) {
            result.min[i] = static_cast<R>(random.number(-4, 4));
            result.max[i] = result.min[i] + static_cast<R>(random.number(0, 1) < 0.2 ? 0 : size);
        }
        return result;
    }
    static R inside(const Box& box, int axis, Programs& random) {
        const R at = box.min[axis] + (box.max[axis] - box.min[axis]) * static_cast<R>(random.number(0, 1));
        return std::min(std::max(at, box.min[axis]), box.max[axis]);
    }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(RandomFunction, Reals);

TYPED_TEST(RandomFunction, IntervalsContainAllValues) {
    using R = TypeParam;
    Programs random(11);
    int tight = 0;
    for (int round = 0; round < 3000; ++round) {
        const FunctionProgram<double> source = random.make(25);
        const auto program = in_precision<R>(source);
        const auto exact = in_precision<Wide>(source);
        const auto box = this->box(random);
        const Interval<R>* bounds =
            run(program, point_of<Interval<R>>([&](int i) { return Interval<R>(box.min[i], box.max[i]); }));
        for (std::size_t k = 0; k < program.instructions.size(); ++k) {
            ASSERT_LE(bounds[k].min, bounds[k].max) << described(source, k);
            tight += bounds[k].max - bounds[k].min < R(0.1) ? 1 : 0;
        }
        for (int sample = 0; sample < 20; ++sample) {
            const std::vector<Wide> values =
                values_of(exact, point_of<Wide>([&](int i) { return Wide(this->inside(box, i, random)); }));
            const std::vector<bool> is_defined = defined(source, values);
            for (std::size_t k = 0; k < program.instructions.size(); ++k) {
                if (is_defined[k]) {
                    ASSERT_TRUE(Wide(bounds[k].min) <= values[k] && values[k] <= Wide(bounds[k].max))
                        << described(source, k) << ": " << bounds[k].min << ".." << bounds[k].max
                        << " without " << values[k];
                }
            }
        }
    }
    EXPECT_GT(tight, 20000);
}

TYPED_TEST(RandomFunction, IntervalsAreTheSameInPacks) {
    using R = TypeParam;
    using L = Pack<R, 4>;
    Programs random(12);
    for (int round = 0; round < 1000; ++round) {
        const auto program = in_precision<R>(random.make(25));
        typename RandomFunction<R>::Box boxes[4];
        for (auto& box : boxes) {
            box = this->box(random);
        }
        const auto point = point_of<Dual<Interval<L>, 1>>([&](int axis) {
            Interval<L> range;
            for (int i = 0; i < 4; ++i) {
                set_lane(range.min, i, boxes[i].min[axis]);
                set_lane(range.max, i, boxes[i].max[axis]);
            }
            return Dual<Interval<L>, 1>::variable(range, 0);
        });
        const std::vector<Dual<Interval<L>, 1>> packs = [&] {
            const auto* registers = run(program, point);
            return std::vector<Dual<Interval<L>, 1>>(registers, registers + program.instructions.size());
        }();
        for (int i = 0; i < 4; ++i) {
            const auto* alone =
                run(program, point_of<Dual<Interval<R>, 1>>([&](int axis) {
                        return Dual<Interval<R>, 1>::variable({boxes[i].min[axis], boxes[i].max[axis]}, 0);
                    }));
            for (std::size_t k = 0; k < packs.size(); ++k) {
                ASSERT_EQ(lane(packs[k].v.min, i), alone[k].v.min);
                ASSERT_EQ(lane(packs[k].v.max, i), alone[k].v.max);
                ASSERT_EQ(lane(packs[k].d[0].min, i), alone[k].d[0].min);
                ASSERT_EQ(lane(packs[k].d[0].max, i), alone[k].d[0].max);
            }
        }
    }
}

// By the mean value theorem: where the derivative is bounded, the slope between any two points is within the
// bounds.
TYPED_TEST(RandomFunction, DerivativesBoundTheSlopesBetweenPoints) {
    using R = TypeParam;
    Programs random(13);
    int checked = 0, tight = 0;
    for (int round = 0; round < 3000; ++round) {
        const FunctionProgram<double> source = random.make(20);
        const auto program = in_precision<R>(source);
        const auto exact = in_precision<Wide>(source);
        typename RandomFunction<R>::Box box;
        const int axis = round % 3;
        for (int i = 0; i < 3; ++i) {
            box.min[i] = box.max[i] = static_cast<R>(random.number(-4, 4));
        }
        box.max[axis] = box.min[axis] + static_cast<R>(std::pow(10, random.number(-4, -1)));
        const auto* bounds =
            run(program, point_of<Dual<Interval<R>, 1>>([&](int i) {
                    const Interval<R> range(box.min[i], box.max[i]);
                    return i == axis ? Dual<Interval<R>, 1>::variable(range, 0) : Dual<Interval<R>, 1>(range);
                }));
        const auto values_at = [&](const R* corner) {
            return values_of(exact, point_of<Wide>([&](int i) { return Wide(corner[i]); }));
        };
        const std::vector<Wide> before = values_at(box.min), after = values_at(box.max);
        const std::vector<bool> starts = defined(source, before), ends = defined(source, after);
        const Wide width = Wide(box.max[axis]) - Wide(box.min[axis]);
        for (std::size_t k = 0; k < program.instructions.size(); ++k) {
            const Interval<R>& slope = bounds[k].d[0];
            ASSERT_LE(slope.min, slope.max) << described(source, k);
            const Wide seen = (after[k] - before[k]) / width;
            const Wide error = (std::abs(after[k]) + std::abs(before[k])) * 1e-18L / width;
            const bool is_truth =
                compares(source.instructions[k].code) || combines_truths(source.instructions[k].code);
            if (starts[k] && ends[k] && !is_truth) {
                ++checked;
                tight += slope.max - slope.min < R(1e-2) ? 1 : 0;
                ASSERT_TRUE(Wide(slope.min) <= seen + error && seen - error <= Wide(slope.max))
                    << described(source, k) << ": " << slope.min << ".." << slope.max << " without " << seen;
            }
        }
    }
    EXPECT_GT(checked, 30000);
    EXPECT_GT(tight, 10000);
}

TEST(RandomFunctionGradient, AgreesWithCentralDifferences) {
    Programs random(14);
    int checked = 0;
    for (int round = 0; round < 3000; ++round) {
        const FunctionProgram<double> source = random.make(16);
        const auto exact = in_precision<Wide>(source);
        double at[3];
        for (double& one : at) {
            one = random.number(-4, 4);
        }
        const auto* gradient = run(
            source, point_of<Dual<double, 3>>([&](int i) { return Dual<double, 3>::variable(at[i], i); }));
        const auto values_at = [&](int axis, Wide step) {
            return values_of(exact,
                             point_of<Wide>([&](int i) { return Wide(at[i]) + (i == axis ? step : 0); }));
        };
        const std::vector<Wide> middle = values_at(0, 0);
        const std::vector<bool> is_defined = defined(source, middle);
        const bool has_random = std::any_of(source.instructions.begin(), source.instructions.end(),
                                            [](const auto& one) { return one.code == Opcode::random; });
        if (has_random) {
            continue;
        }
        for (int axis = 0; axis < 3; ++axis) {
            const auto slopes = [&](Wide h, std::size_t k, const std::vector<Wide>& low,
                                    const std::vector<Wide>& high) { return (high[k] - low[k]) / (2 * h); };
            const Wide h = 1e-5L;
            const auto low = values_at(axis, -h), high = values_at(axis, h);
            const auto lower = values_at(axis, -2 * h), higher = values_at(axis, 2 * h);
            for (std::size_t k = 0; k < source.instructions.size(); ++k) {
                const Wide near = slopes(h, k, low, high), far = slopes(2 * h, k, lower, higher);
                // Where the two differences agree, the function is smooth enough to tell.
                const Wide scale = 1 + std::abs(near) + std::abs(middle[k]);
                const bool at_an_end = !std::isfinite(gradient[k].d[axis]); // as that of asin at 1
                if (!is_defined[k] || at_an_end || !(std::abs(near - far) < 1e-7L * scale)) {
                    continue;
                }
                const bool one_sided = std::abs((high[k] - middle[k]) - (middle[k] - low[k])) >
                                       1e-3L * std::abs(high[k] - low[k]);
                if (!one_sided) {
                    ++checked;
                    ASSERT_NEAR(gradient[k].d[axis], static_cast<double>(near),
                                1e-6 * static_cast<double>(scale))
                        << described(source, k);
                }
            }
        }
    }
    EXPECT_GT(checked, 30000);
}

template <class R>
class Waves : public testing::Test {};
TYPED_TEST_SUITE(Waves, Reals);

TYPED_TEST(Waves, AreRightToARoundingOfOneAndTheSameInPacks) {
    using R = TypeParam;
    Programs random(15);
    constexpr R eps = std::numeric_limits<R>::epsilon();
    for (int i = 0; i < 400000; ++i) {
        Pack<R, 4> x;
        for (int k = 0; k < 4; ++k) {
            const double size = std::pow(10, random.number(-6, sizeof(R) == 8 ? 7 : 4.5));
            set_lane(x, k, static_cast<R>(random.number(-1, 1) * size));
        }
        const Pack<R, 4> s = sine(x), c = cosine(x);
        for (int k = 0; k < 4; ++k) {
            const R one = lane(x, k);
            ASSERT_EQ(lane(s, k), sine(one));
            ASSERT_EQ(lane(c, k), cosine(one));
            const Wide true_sine = std::sin(Wide(one)), true_cosine = std::cos(Wide(one));
            ASSERT_LE(std::abs(Wide(lane(s, k)) - true_sine),
                      1.5L * Wide(eps) * std::max(std::abs(true_sine), Wide(0.25)))
                << one;
            ASSERT_LE(std::abs(Wide(lane(c, k)) - true_cosine), Wide(eps)) << one;
        }
    }
    EXPECT_TRUE(std::isnan(sine(std::numeric_limits<R>::infinity())));
}

TEST(Noise, IsTheSameInPacksAndNearlyInFloat) {
    Programs random(16);
    for (int i = 0; i < 20000; ++i) {
        Pack<double, 4> p[3];
        Pack<float, 8> q[3];
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 4; ++k) {
                set_lane(p[axis], k, static_cast<double>(static_cast<float>(random.number(-50, 50))));
                set_lane(q[axis], k, static_cast<float>(lane(p[axis], k)));
            }
        }
        const auto wide = noise_number(p[0], p[1], p[2]);
        const auto narrow = noise_number(q[0], q[1], q[2]);
        for (int k = 0; k < 4; ++k) {
            const double one = noise_number(lane(p[0], k), lane(p[1], k), lane(p[2], k));
            ASSERT_EQ(lane(wide, k), one);
            ASSERT_NEAR(lane(narrow, k), one, 2e-5);
            ASSERT_TRUE(one >= 0 && one < 1);
        }
    }
}

} // namespace
