// Constants that the kernels and their scalar references share: fits in single precision, and bounds on their errors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace astroid::fits {

/// Coefficients for a variable that is `scale` times larger in its value: exact for powers of two.
template <std::size_t N>
constexpr std::array<float, N> scaled(std::array<float, N> coefficients, float scale) {
  for (float& c : coefficients) c *= scale;
  return coefficients;
}

// The normal quantile of a word, z = x P(w) with x = |2u - 1| and w = -ln(1 - x^2) (Giles2012). P is a polynomial in
// w - kCentre up to kTail and one in sqrt(w) - kTailCentre beyond (0.34 % of draws). Minimax fits of relative error
// 3e-7 and 4e-7. x and the tail 1 - x are kept in units of half a word's step, 2^-31.
inline constexpr float kUnits = 0x1p31F;
inline constexpr float kTail = 5.0F;
inline constexpr float kCentre = 2.5F;
inline constexpr float kTailCentre = 3.5F;
inline constexpr auto kCentral = scaled<8>({2.12331319F, 0.348803639F, -0.00590612181F, -0.00177431689F,
                                            0.000307359558F, -5.79007246e-06F, -4.50551988e-06F, 4.46372951e-07F},
                                           1.0F / kUnits);
inline constexpr auto kFar = scaled<8>({4.71708775F, 1.42462635F, 0.00466935337F, -0.0028498678F, 0.00141173508F,
                                        -0.00109663361F, 0.000798515277F, -0.000239524088F},
                                       1.0F / kUnits);

// -ln(1 + g) = g^2 R(g) - g for sqrt(1/2) <= 1 + g < sqrt(2); error 3e-7. The logarithm is of a number in units of
// 2^62, kUnits squared.
inline constexpr std::uint32_t kSqrtHalfBits = 0x3f3504f3U;  // bits of the float sqrt(1/2)
inline constexpr unsigned kMantissaBits = 23;
inline constexpr std::uint32_t kScaledSqrtHalfBits = kSqrtHalfBits + (62U << kMantissaBits);
inline constexpr std::uint32_t kMantissaMask = 0x007fffffU;
inline constexpr float kLn2 = 0.693147181F;
inline constexpr std::array<float, 6> kMinusLog = {0.500014842F,  -0.333155602F, 0.248978123F,
                                                   -0.204923302F, 0.18761386F,   -0.1198695F};

// e^r for |r| <= ln(2)/2; relative error 8e-8.
inline constexpr float kLog2E = 1.44269504F;
inline constexpr std::array<float, 6> kExp = {1.00000012F,  0.999999702F,  0.499988943F,
                                              0.166675746F, 0.0419153832F, 0.00829764549F};

// The continuous Poisson quantile, x = mean + root w + w^2 A(s) + c0(s) + c1(s)/mean with s = w/root, root =
// sqrt(mean): poisson_quantile.hpp says where it comes from. Here fits of lower degree: errors 1.8e-6, 2.9e-5, 1.8e-3.
inline constexpr float kLowestS = -0.75F;
inline constexpr float kHighestS = 1.0F;
inline constexpr std::array<float, 6> kA = {0.166668341F,    -0.0138840042F,  0.0036633946F,
                                            -0.00135874015F, 0.000708163716F, -0.000263769412F};
inline constexpr std::array<float, 5> kC0 = {0.333325893F - 0.5F, -0.0276242848F, 0.0087389769F, -0.00436831266F,
                                             0.00173285615F};
inline constexpr std::array<float, 3> kC1 = {-0.0195435621F, 0.023259433F, -0.0155453496F};

// |error of x| <= kErrorFloor + kErrorPerMean / mean + root (kErrorOfCentre + kErrorOfNormal |w|), the last from
// rounding and from the error of w. The test PixelPoisson.ApproximationStaysWithinItsBound measures it; a factor of 2
// is left.
inline constexpr float kErrorFloor = 2e-4F;
inline constexpr float kErrorPerMean = 8e-3F;
inline constexpr float kErrorOfCentre = 2e-7F;
inline constexpr float kErrorOfNormal = 1.6e-6F;
inline constexpr float kRoom = 0.5F - kErrorFloor;
inline constexpr float kSmallMean = 10.0F;  // below it the count is found by adding probabilities from 0 on

// Sums of probabilities of at most kMostSteps terms, each with a relative error of some 1e-7 a step.
inline constexpr float kErrorOfSum = 6e-6F;
inline constexpr int kMostSteps = 64;

}  // namespace astroid::fits
