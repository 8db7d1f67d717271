#pragma once

#include <cstddef>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace scc::runtime {

/// Memory from the start of a cache line on, so that rows of pixels are written by whole lines. Large
/// pictures get huge pages where the system has some: else they are thousands of small ones, each of which
/// takes time when it is first written and again whenever its place is looked up.
template <class T>
struct PictureAllocator {
    using value_type = T;

    PictureAllocator() = default;
    template <class U>
    PictureAllocator(const PictureAllocator<U>&) {}

    T* allocate(std::size_t n) {
        void* const memory = ::operator new(n * sizeof(T), alignment(n));
#ifdef __linux__
        if (alignment(n) == huge_page) {
            madvise(memory, n * sizeof(T), MADV_HUGEPAGE); // does without where it cannot
        }
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t n) {
        ::operator delete(memory, n * sizeof(T), alignment(n));
    }
    friend bool operator==(const PictureAllocator&, const PictureAllocator&) {
        return true;
    }

private:
    static constexpr std::align_val_t cache_line{64}, huge_page{std::size_t{2} << 20U};
    static std::align_val_t alignment(std::size_t n) {
        return n * sizeof(T) < 2 * static_cast<std::size_t>(huge_page) ? cache_line : huge_page;
    }
};

} // namespace scc::runtime
