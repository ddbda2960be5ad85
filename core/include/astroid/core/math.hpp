// Elementary functions that give the same bits on every x86-64-v2 processor, unlike glibc's, which pick a variant by
// CPU.
//
// SLEEF's scalar C functions compiled without fused multiply-add (Sleef_cinz_*). Everything that ends in pixels or
// fluxes uses these. Special values (NaN, infinities, poles) are those of C; nothing sets errno.
// @source Shibata2020. @accuracy in units in the last place (ulp), stated by SLEEF, checked by tests/reference/core.
#pragma once

#include <cmath>

namespace astroid::det {

/// e^x. @accuracy 1 ulp; 0 below -708.4 to -745.1 gradually (subnormals are kept), inf above 709.78.
double exp(double x);
/// 10^x. @accuracy 1 ulp.
double exp10(double x);
/// e^x - 1 without cancellation near 0. @accuracy 1 ulp.
double expm1(double x);
/// Natural logarithm. @accuracy 1 ulp; -inf at 0, NaN below.
double log(double x);
/// Decimal logarithm. @accuracy 1 ulp.
double log10(double x);
/// log(1 + x) without cancellation near 0. @accuracy 1 ulp up to 1e307.
double log1p(double x);
/// x^y with the special cases of C. @accuracy 1 ulp.
double pow(double x, double y);

/// Trigonometric functions of an angle in radians, of any size. @accuracy 1 ulp.
double sin(double x);
double cos(double x);
double tan(double x);
/// Inverse functions, in radians. @accuracy 1 ulp; NaN outside [-1, 1] for asin and acos.
double asin(double x);
double acos(double x);
double atan(double x);
/// Angle of the vector (x, y), -pi .. pi. @accuracy 1 ulp.
double atan2(double y, double x);
/// Length of the vector (x, y), without overflow in between. @accuracy 0.5 ulp.
double hypot(double x, double y);
/// Hyperbolic tangent. @accuracy 1 ulp.
double tanh(double x);

/// Error function. @accuracy 1 ulp.
double erf(double x);
/// 1 - erf(x) without cancellation. @accuracy 1.5 ulp down to 1e-307 (x < 26.2).
double erfc(double x);

/// Square root: correctly rounded by IEEE 754, so the processor's own instruction.
inline double sqrt(double x) {
  return std::sqrt(x);
}

}  // namespace astroid::det
