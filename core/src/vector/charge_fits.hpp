// Numbers that the kernels of charge_kernels.hpp and their plain twins share.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace astroid::charge_fits {

inline constexpr unsigned kMantissaBits = 52;
inline constexpr std::uint64_t kMantissaMask = (std::uint64_t{1} << kMantissaBits) - 1;
inline constexpr std::uint64_t kOneBits = std::bit_cast<std::uint64_t>(1.0);
inline constexpr std::uint64_t kSqrtHalfBits = std::bit_cast<std::uint64_t>(0x1.6a09e667f3bcdp-1);
inline constexpr double kExponentBias = 1023.0;
inline constexpr double kRounder = 0x1.8p52;  ///< added, it leaves the nearest integer in the lowest bits
inline constexpr std::uint64_t kRounderBits = std::bit_cast<std::uint64_t>(kRounder);
inline constexpr double kLn2 = 0x1.62e42fefa39efp-1;
inline constexpr double kLn2High = 0x1.62e42fefa38p-1;  ///< ln 2 in 42 bits, so k ln 2 is exact
inline constexpr double kLn2Low = 0x1.ef35793c7673p-45;
inline constexpr double kLog2E = 1.442695040888963407360;

/// 2 atanh(s) / s in powers of s², |s| < 0.1716: the next term is below 4e-17.
inline constexpr std::array<double, 10> kLog{2.0,        2.0 / 3.0,  2.0 / 5.0,  2.0 / 7.0,  2.0 / 9.0,
                                             2.0 / 11.0, 2.0 / 13.0, 2.0 / 15.0, 2.0 / 17.0, 2.0 / 19.0};

/// e^r in powers of r, |r| <= ln(2)/2: the next term is below 7e-15.
inline constexpr std::array<double, 12> kExp{
    1.0,         1.0,          1.0 / 2.0,     1.0 / 6.0,      1.0 / 24.0,      1.0 / 120.0,
    1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0, 1.0 / 39916800.0};

inline constexpr double kLeastCharge = 1e-30;     ///< e-; below, a packet captures nothing
inline constexpr double kLeastExponent = -700.0;  ///< e^x is 0 for what it is used for
}  // namespace astroid::charge_fits
