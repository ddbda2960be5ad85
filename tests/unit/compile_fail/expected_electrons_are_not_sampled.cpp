// A plane of sampled electrons is no input for what wants expected ones: shot noise cannot be applied twice.
// error: cannot bind|could not convert|invalid initialization|no matching
#include <utility>

#include "astroid/core/image.hpp"

using Expected = astroid::Plane<double, astroid::unit::ExpectedElectrons>;
using Sampled = astroid::Plane<double, astroid::unit::SampledElectrons>;

Sampled draw(Expected expected);

Sampled draw_twice(Expected expected) {
#ifdef ASTROID_ALLOWED
  return draw(std::move(expected));
#else
  return draw(draw(std::move(expected)));
#endif
}
