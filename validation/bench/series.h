#pragma once

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

/// Repeated measurements and what is told of them.
namespace scc::bench {

enum class Clock {
    wall,
    processor, ///< of all threads of this process: other processes on the machine matter less
};

inline double now(Clock clock) {
    if (clock == Clock::wall) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class F>
double time_of(Clock clock, F&& f) {
    const double start = now(clock);
    f();
    return now(clock) - start;
}

/// The same thing measured repeatedly.
struct Series {
    std::vector<double> values;

    void add(double value) { values.push_back(value); }
    double median() const {
        std::vector<double> sorted = values;
        std::sort(sorted.begin(), sorted.end());
        const std::size_t half = sorted.size() / 2;
        return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
    }
    double min() const { return *std::min_element(values.begin(), values.end()); }
    double max() const { return *std::max_element(values.begin(), values.end()); }

    nlohmann::json json() const { return {{"median", median()}, {"min", min()}, {"max", max()}}; }
};

/// Element by element: each repetition is compared with its neighbour in time, so that a machine that is slow
/// for a while is so for both.
inline Series ratio(const Series& over, const Series& under) {
    Series result;
    for (std::size_t i = 0; i < over.values.size() && i < under.values.size(); ++i) {
        result.add(over.values[i] / under.values[i]);
    }
    return result;
}

} // namespace scc::bench
