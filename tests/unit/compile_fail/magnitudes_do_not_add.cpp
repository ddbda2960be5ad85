// Magnitudes are logarithms: adding two is always a mistake.
// error: no match for 'operator\+'
#include "astroid/core/units.hpp"

constexpr astroid::Magnitude kStar(11.0);
#ifdef ASTROID_ALLOWED
constexpr astroid::Magnitude kFainter = kStar + astroid::DeltaMag(0.5);
#else
constexpr auto kSum = kStar + kStar;
#endif
