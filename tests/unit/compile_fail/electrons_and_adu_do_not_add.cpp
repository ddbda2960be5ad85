// Electrons and ADU differ by the gain.
// error: no match for 'operator\+'
#include "astroid/core/units.hpp"

#ifdef ASTROID_ALLOWED
constexpr auto kSum = astroid::Electrons(1.0) + astroid::Adu(1.0) * astroid::Gain(25.0);
#else
constexpr auto kSum = astroid::Electrons(1.0) + astroid::Adu(1.0);
#endif
