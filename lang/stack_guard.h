#pragma once

#include <cstddef>
#include <cstdint>

namespace scc::lang {

/// Tells when recursion over a scene's text or calls has used up most of the native stack. Measures the stack
/// itself, since how much one level takes differs between builds.
class StackGuard {
public:
    StackGuard() : base_(here()) {}

    bool exhausted() const {
        const std::uintptr_t now = here();
        return (now < base_ ? base_ - now : now - base_) > limit;
    }

private:
    static constexpr std::size_t limit = 5u << 20; // of the 8 MiB that a thread has

    static std::uintptr_t here() { return reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)); }

    std::uintptr_t base_;
};

} // namespace scc::lang
