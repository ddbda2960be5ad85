#include <algorithm>
#include <cstddef>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

void PixelPsf::integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                                   std::span<double> fractions, std::vector<double>& scratch) const {
  // Principal axes of the motion: half the angle whose tangent is 2 sxy / (sxx - syy).
  const double half_sum = 0.5 * (motion.sxx + motion.syy);
  const double half_difference = 0.5 * (motion.sxx - motion.syy);
  const double radius = det::hypot(half_difference, motion.sxy);
  const double angle = 0.5 * det::atan2(motion.sxy, half_difference);
  const double cosine = det::cos(angle);
  const double sine = det::sin(angle);
  constexpr double kNodeSquared = 3.0;  // nodes 0 and +-sqrt(3) s of the three-point Gauss-Hermite rule
  constexpr double kOuterWeight = 1.0 / 6.0;
  const double along = det::sqrt(kNodeSquared * std::max(0.0, half_sum + radius));
  const double across = det::sqrt(kNodeSquared * std::max(0.0, half_sum - radius));

  integrate(centre, box, fractions);
  constexpr double kCentreWeight = 1.0 - 4.0 * kOuterWeight;
  for (double& fraction : fractions) fraction *= kCentreWeight;
  if (scratch.size() < box.size()) scratch.resize(box.size());
  const std::span<double> moved(scratch.data(), box.size());
  for (const PixelShift& shift :
       {PixelShift{along * cosine, along * sine}, PixelShift{-along * cosine, -along * sine},
        PixelShift{-across * sine, across * cosine}, PixelShift{across * sine, -across * cosine}}) {
    integrate({centre.x + shift.dx, centre.y + shift.dy}, box, moved);
    for (std::size_t i = 0; i < fractions.size(); ++i) fractions[i] += kOuterWeight * moved[i];
  }
}

}  // namespace astroid
