#include "validation/jobs.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

namespace scc::validation {

void run_jobs(const std::vector<Job>& jobs, int parallel) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr first;
    std::mutex guard;
    const auto work = [&] {
        for (std::size_t i = next++; i < jobs.size(); i = next++) {
            try {
                jobs[i]();
            } catch (...) {
                const std::lock_guard lock(guard);
                first = first ? first : std::current_exception();
                next = jobs.size();
            }
        }
    };
    {
        std::vector<std::jthread> others;
        const auto wanted = static_cast<std::size_t>(std::max(parallel, 1));
        for (std::size_t i = 1; i < std::min(wanted, jobs.size()); ++i)
            others.emplace_back(work);
        work();
    }
    if (first)
        std::rethrow_exception(first);
}

} // namespace scc::validation
