// Bessel's function of the first order, with the same bits on every processor.
#pragma once

namespace astroid::detail {

/// J1(x) for any finite x.
///
/// Power series below 5, Miller's backward recurrence up to 17, Hankel's asymptotic expansion beyond.
/// @accuracy 3e-15 absolute (test: Bessel.AgreesWithTheIntegral)  @source Olver2010 §10.8, §10.17, §10.74
double bessel_j1(double x);

/// 2 J1(x) / x, 1 at 0: the amplitude of a circular aperture.
double jinc(double x);

}  // namespace astroid::detail
