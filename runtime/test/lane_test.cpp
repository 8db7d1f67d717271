#include "runtime/math/lane.h"
#include "runtime/math/noise.h"
#include "runtime/math/pack.h"
#include "runtime/math/trig.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

using namespace scc::runtime;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(Lane, MinimumAndMaximumIgnoreANanInTheSecondPlaceOnly) {
    EXPECT_EQ(minimum(1.0, nan), 1.0);
    EXPECT_EQ(maximum(1.0, nan), 1.0);
    EXPECT_TRUE(std::isnan(minimum(nan, 1.0)));
    EXPECT_TRUE(std::isnan(maximum(nan, 1.0)));
    EXPECT_EQ(minimum(2.0, 1.0), 1.0);
    EXPECT_EQ(maximum(1.0, 2.0), 2.0);
}

TEST(Lane, FlooredModTakesTheSignOfTheDivisor) {
    EXPECT_EQ(floored_mod(-1.0, 2.0), 1.0);
    EXPECT_EQ(floored_mod(5.5, 2.0), 1.5);
    EXPECT_EQ(floored_mod(1.0, -2.0), -1.0);
    EXPECT_EQ(floored_mod(-4.0, 2.0), 0.0);
}

TEST(Lane, ElementaryFunctionsDoNotDependOnWhatTheCompilerKnows) {
    for (int i = 0; i < 1000; ++i) {
        volatile double hidden = 0.001 * i, two = 2, forty = 40;
        const double x = hidden;
        EXPECT_EQ(power(x, 2.0), std::pow(x, double(two)));
        EXPECT_EQ(power(x, 40.0), std::pow(x, double(forty)));
    }
    volatile double known = 0.7;
    EXPECT_EQ(tangent(0.7), std::tan(double(known)));
    EXPECT_EQ(exponential(0.7), std::exp(double(known)));
    EXPECT_EQ(logarithm(0.7), std::log(double(known)));
}

template <class T>
class PackOf : public testing::Test {
public:
    static std::vector<T> samples() {
        std::vector<T> result{T(0),   T(-0.0), T(1),    T(-1),    T(0.5),     T(-0.5),
                              T(1.5), T(-2.5), T(1e30), T(-1e30), T(8388609), T(-8388608.5),
                              T(inf), T(-inf), T(nan),  T(1e-40)};
        for (int i = 0; i < 240; ++i) {
            result.push_back(T(std::sin(i * 1.7) * std::exp(std::cos(i * 0.31) * 12)));
        }
        return result;
    }
    static WidestLane<T> load(const std::vector<T>& from, std::size_t first, std::size_t stride) {
        WidestLane<T> result(0);
        for (int i = 0; i < lane_count<WidestLane<T>>; ++i) {
            set_lane(result, i, from[(first + static_cast<std::size_t>(i) * stride) % from.size()]);
        }
        return result;
    }
};
using PackTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(PackOf, PackTypes);

#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender)                                                  \
    template <class L>                                                                                       \
    L name##_of([[maybe_unused]] L a, [[maybe_unused]] L b, [[maybe_unused]] L c) {                          \
        return L(value);                                                                                     \
    }
#include "runtime/operators.def"
#undef SCC_OPERATOR

template <class T>
auto to_bits(T x) {
    return std::bit_cast<std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>(x);
}
template <class T>
bool same(T a, T b) {
    return to_bits(a) == to_bits(b) || (std::isnan(a) && std::isnan(b));
}

TYPED_TEST(PackOf, EveryOperatorGivesTheScalarBits) {
    using T = TypeParam;
    using L = WidestLane<T>;
    const std::vector<T> samples = this->samples();
    for (std::size_t first = 0; first < samples.size(); ++first) {
        const L first_operand = this->load(samples, first, 1), second = this->load(samples, first * 7 + 3, 5);
        const L third = this->load(samples, first * 3 + 1, 11);
        const auto check = [&](const char* name, const L& got, auto&& scalar) {
            for (int i = 0; i < lane_count<L>; ++i) {
                const T x = lane(first_operand, i), y = lane(second, i), z = lane(third, i);
                const T expected = T(scalar(x, y, z));
                EXPECT_TRUE(same(lane(got, i), expected)) << name << "(" << x << ", " << y << ", " << z
                                                          << ") = " << lane(got, i) << ", not " << expected;
            }
        };
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender)                                                  \
    check(#name, name##_of(first_operand, second, third), [](T x, T y, T z) { return name##_of(x, y, z); });
#include "runtime/operators.def"
#undef SCC_OPERATOR
    }
}

TYPED_TEST(PackOf, MaskReductionsSeeEveryLane) {
    using L = WidestLane<TypeParam>;
    const L zero(0);
    EXPECT_TRUE(all(zero == zero));
    EXPECT_TRUE(none(zero != zero));
    for (int i = 0; i < lane_count<L>; ++i) {
        L one = zero;
        set_lane(one, i, TypeParam(1));
        EXPECT_TRUE(any(one > zero));
        EXPECT_FALSE(all(one > zero));
        EXPECT_FALSE(all(one == zero));
        EXPECT_EQ(first_lane(one > zero), i);
        EXPECT_EQ(count_lanes(one == zero), static_cast<std::uint64_t>(lane_count<L> - 1));
    }
}

} // namespace
