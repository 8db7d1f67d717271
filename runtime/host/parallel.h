#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace scc::host {

inline int core_count() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// f(i) for i from 0 to count - 1, on several threads, of which the caller's is one. `f` must not throw.
template <class F>
void parallel_for(int count, int threads, F&& f) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next++; i < count; i = next++) {
            f(i);
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(threads, count); ++i) {
        others.emplace_back(work);
    }
    work();
}

} // namespace scc::host
