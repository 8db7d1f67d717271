#pragma once

/// What the compiler's vectors cannot say by themselves: sign bits, square roots and widening of whole
/// registers, for the targets that have them. The builtins and not <immintrin.h>, which costs more time to
/// compile than everything else here.
namespace scc::runtime::detail {

/// The compiler's vectors (g++ and clang have the same), since loops over arrays are not kept in registers.
template <class T, int N>
struct VectorOf {
    typedef T type __attribute__((vector_size(sizeof(T) * N)));
};
template <class T, int N>
using VectorType = typename VectorOf<T, N>::type;

#if defined(__SSE2__)
inline unsigned sign_bits(VectorType<double, 2> x) {
    return static_cast<unsigned>(__builtin_ia32_movmskpd(x));
}
inline unsigned sign_bits(VectorType<float, 4> x) {
    return static_cast<unsigned>(__builtin_ia32_movmskps(x));
}
inline VectorType<double, 2> vector_root(VectorType<double, 2> x) {
    return __builtin_ia32_sqrtpd(x);
}
inline VectorType<float, 4> vector_root(VectorType<float, 4> x) {
    return __builtin_ia32_sqrtps(x);
}
#endif

#if defined(__AVX2__)
inline unsigned sign_bits(VectorType<double, 4> x) {
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(x));
}
inline unsigned sign_bits(VectorType<float, 8> x) {
    return static_cast<unsigned>(__builtin_ia32_movmskps256(x));
}
inline VectorType<double, 4> vector_root(VectorType<double, 4> x) {
    return __builtin_ia32_sqrtpd256(x);
}
inline VectorType<float, 8> vector_root(VectorType<float, 8> x) {
    return __builtin_ia32_sqrtps256(x);
}
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int current_rounding = 4;

inline unsigned sign_bits(VectorType<double, 8> x) {
    return __builtin_ia32_cvtq2mask512(reinterpret_cast<VectorType<long long, 8>>(x));
}
inline unsigned sign_bits(VectorType<float, 16> x) {
    return __builtin_ia32_cvtd2mask512(reinterpret_cast<VectorType<int, 16>>(x));
}
inline VectorType<double, 8> vector_root(VectorType<double, 8> x) {
#if defined(__clang__)
    return __builtin_ia32_sqrtpd512(x, current_rounding);
#else
    return __builtin_ia32_sqrtpd512_mask(x, x, -1, current_rounding);
#endif
}
inline VectorType<float, 16> vector_root(VectorType<float, 16> x) {
#if defined(__clang__)
    return __builtin_ia32_sqrtps512(x, current_rounding);
#else
    return __builtin_ia32_sqrtps512_mask(x, x, -1, current_rounding);
#endif
}
#endif

/// The same numbers in another vector type. clang widens a whole register at once by itself, g++ 12 its
/// halves.
template <class To, class From>
To converted(From x) {
#if defined(__AVX2__) && !defined(__clang__)
    if constexpr (sizeof(To) == 32 && sizeof(From) == 16) {
        return __builtin_ia32_cvtps2pd256(x);
    }
#endif
#if defined(__AVX512F__) && defined(__AVX512DQ__) && !defined(__clang__)
    if constexpr (sizeof(To) == 64 && sizeof(From) == 32) {
        return __builtin_ia32_cvtps2pd512_mask(x, To{}, -1, current_rounding);
    }
#endif
    return __builtin_convertvector(x, To);
}

/// Bytes of the widest registers that the program is compiled for.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX2__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

} // namespace scc::runtime::detail
