#include <algorithm>
#include <cstddef>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"
#include "motion_nodes.hpp"

namespace astroid {

std::array<detail::MotionNode, detail::kMotionNodes> detail::motion_nodes(const MotionCovariance& motion) {
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
  constexpr double kCentreWeight = 1.0 - 4.0 * kOuterWeight;
  return {{{{}, kCentreWeight},
           {{along * cosine, along * sine}, kOuterWeight},
           {{-along * cosine, -along * sine}, kOuterWeight},
           {{-across * sine, across * cosine}, kOuterWeight},
           {{across * sine, -across * cosine}, kOuterWeight}}};
}

void PixelPsf::integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                                   std::span<double> fractions, std::vector<double>& scratch) const {
  if (scratch.size() < box.size()) scratch.resize(box.size());
  const std::span<double> moved(scratch.data(), box.size());
  std::ranges::fill(fractions, 0.0);
  for (const detail::MotionNode& node : detail::motion_nodes(motion)) {
    integrate({centre.x + node.shift.dx, centre.y + node.shift.dy}, box, moved);
    for (std::size_t i = 0; i < fractions.size(); ++i) fractions[i] += node.weight * moved[i];
  }
}

void PixelPsf::add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                        std::vector<double>& scratch) const {
  const Rectangle box = intersect(stamp_box(star.centre, star.half_width), image.area());
  if (box.empty()) return;
  std::vector<double> fractions(box.size());
  if (star.broadened) {
    integrate_broadened(star.centre, star.motion, box, fractions, scratch);
  } else {
    integrate(star.centre, box, fractions);
  }
  const double* fraction = fractions.data();
  for (int y = box.y0; y < box.y1(); ++y) {
    double* pixel = &image.at(box.x0, y);
    for (int i = 0; i < box.nx; ++i) pixel[i] += star.electrons * fraction[i];
    fraction += box.nx;
  }
}

}  // namespace astroid
