#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::host {

/// Linear light of an encoded value (IEC 61966-2-1).
inline double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The encoded value of linear light, which is clamped to 0..1.
inline double encode_srgb(double linear) {
    const double v = linear > 0 ? linear < 1 ? linear : 1 : 0;
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// Correctly rounded sRGB codes without a power per value: a code is the number of thresholds that a value
/// reaches, and the upper bits of the float say where to start counting.
class SrgbCodes {
public:
    /// `shift`: lower bits of a float that are ignored at first; chosen so that few thresholds differ only in
    /// them.
    SrgbCodes(std::uint16_t max, int shift) : max_(max), shift_(shift) {
        for (int code = 1; code <= max; ++code)
            thresholds_.push_back(float_not_below(decode_srgb((code - 0.5) / max)));
        thresholds_.push_back(2); // reached by none of the values that are looked up
        const std::uint32_t buckets = (std::bit_cast<std::uint32_t>(1.0F) >> shift) + 1;
        std::uint16_t code = 0;
        for (std::uint32_t bucket = 0; bucket < buckets; ++bucket)
            first_code_.push_back(code = count_reached(std::bit_cast<float>(bucket << shift), code));
        for (std::uint32_t bucket = 0; bucket < buckets; ++bucket)
            one_step_ = one_step_ &&
                        (bucket + 1 == buckets ? max : first_code_[bucket + 1]) <= first_code_[bucket] + 1;
    }

    /// One after the other. Faster than single values where no bucket holds two thresholds: no branches.
    void encode(const float* from, std::size_t count, unsigned char* to) const {
        if (!one_step_) {
            for (std::size_t i = 0; i < count; ++i)
                to[i] = static_cast<unsigned char>((*this)(from[i]));
            return;
        }
        // Locals, since for all the compiler knows `to` may point into this.
        const std::uint16_t* const first_code = first_code_.data();
        const float* const thresholds = thresholds_.data();
        const int shift = shift_;
        std::array<float, 256> values;
        for (std::size_t start = 0; start < count; start += values.size()) {
            const std::size_t n = std::min(values.size(), count - start);
            for (std::size_t i = 0; i < n; ++i) {
                const float positive = from[start + i] > 0 ? from[start + i] : 0.0F; // NaN too
                values[i] = positive < 1 ? positive : 1.0F;
            }
            for (std::size_t i = 0; i < n; ++i) {
                const std::uint16_t code = first_code[std::bit_cast<std::uint32_t>(values[i]) >> shift];
                to[start + i] = static_cast<unsigned char>(code + (values[i] >= thresholds[code] ? 1 : 0));
            }
        }
    }

    std::uint16_t operator()(float linear) const {
        if (!(linear > 0)) // NaN too
            return 0;
        if (linear >= 1)
            return max_;
        return count_reached(linear, first_code_[std::bit_cast<std::uint32_t>(linear) >> shift_]);
    }

private:
    static float float_not_below(double value) {
        const auto nearest = static_cast<float>(value);
        return static_cast<double>(nearest) < value ? std::nextafter(nearest, 2.0F) : nearest;
    }
    std::uint16_t count_reached(float linear, std::uint16_t from) const {
        // Mostly 0 or 1 as it happens, which no branch could foresee.
        from = static_cast<std::uint16_t>(from + (linear >= thresholds_[from] ? 1 : 0));
        while (linear >= thresholds_[from])
            ++from;
        return from;
    }

    std::uint16_t max_;
    int shift_;
    bool one_step_ = true;
    std::vector<float> thresholds_;
    std::vector<std::uint16_t> first_code_;
};

} // namespace scc::host
