#include "astroid/analysis/group_mean.hpp"

#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

double square(double v) {
  return v * v;
}

/// Electrons that the relative deviation of a camera refers to.
double reference(const StarEstimator& e) {
  return e.budget.target + e.budget.contaminants;
}

/// Mean over cameras of what each group has.
template <class Value>
double mean(std::span<const GroupView> groups, Value&& value) {
  double sum = 0.0;
  for (const GroupView& group : groups) sum += group.share * value(*group.estimator);
  return sum;
}

/// Share of the target in the light of an aperture.
double purity(const StarEstimator& e) {
  return 1.0 - e.spr_total;
}

}  // namespace

StarEstimator mean_estimator(std::span<const GroupView> groups) {
  const StarEstimator& first = *groups.front().estimator;
  StarEstimator out;
  out.star = first.star;
  out.region = first.region;
  out.window = first.window;
  out.mask_pixels = first.mask_pixels;
  out.enclosed_fraction = first.enclosed_fraction;
  out.spr_total = first.spr_total;
  out.nsr_exposure = first.nsr_exposure;
  out.prnu_static = first.prnu_static;
  out.budget = first.budget;
  out.flags = first.flags;
  if (groups.size() == 1) return out;
  for (const GroupView& group : groups) out.flags |= group.estimator->flags;
  // Without light in a group, as for a target outside the frame, there is no mean either.
  for (const GroupView& group : groups)
    if (!(reference(*group.estimator) > 0.0)) {
      out.budget = group.estimator->budget;
      return out;
    }
  const double all = mean(groups, reference);
  const double pure = mean(groups, purity);
  // e- of the mean from what each group has relative to its own reference.
  const auto electrons = [&](double EstimatorBudget::*part) {
    return all * mean(groups, [part](const StarEstimator& e) { return e.budget.*part / reference(e); });
  };
  const auto variance = [&](double EstimatorBudget::*part) {
    return all * all * mean(groups, [part](const StarEstimator& e) { return e.budget.*part / square(reference(e)); });
  };
  EstimatorBudget& b = out.budget;
  b.target = all * pure;
  b.contaminants = all * (1.0 - pure);
  b.smearing = electrons(&EstimatorBudget::smearing);
  b.bias_weight = electrons(&EstimatorBudget::bias_weight);
  for (double EstimatorBudget::*part :
       {&EstimatorBudget::var_target, &EstimatorBudget::var_contaminants, &EstimatorBudget::var_background,
        &EstimatorBudget::var_readout, &EstimatorBudget::var_quantisation, &EstimatorBudget::var_background_estimate,
        &EstimatorBudget::var_smearing, &EstimatorBudget::var_smearing_correction, &EstimatorBudget::var_bias})
    b.*part = variance(part);
  // A wrong belief about a neighbour is the same in all cameras: it does not average out.
  b.var_neighbour_doubt = square(all * mean(groups, [](const StarEstimator& e) {
                                   return std::sqrt(e.budget.var_neighbour_doubt) / reference(e);
                                 }));
  out.spr_total = 1.0 - pure;
  out.nsr_exposure = std::sqrt(b.variance()) / b.target;
  // So that enclosed fraction x all light of the star = target, with mean_truth().
  const double star = mean(groups, [](const StarEstimator& e) { return e.budget.target / e.enclosed_fraction; });
  out.enclosed_fraction = b.target / star;
  out.prnu_static =
      std::sqrt(mean(groups, [](const StarEstimator& e) { return square(purity(e) * e.prnu_static); })) / pure;
  return out;
}

TruthStar mean_truth(std::span<const TruthStar> groups, std::span<const double> shares) {
  ASTROID_CHECK_EQ(groups.size(), shares.size());
  TruthStar out = groups.front();
  if (groups.size() == 1) return out;
  out.electrons = 0.0;
  for (std::size_t g = 0; g < groups.size(); ++g) out.electrons += shares[g] * groups[g].electrons;
  return out;
}

MotionNoise mean_motion_noise(std::span<const GroupView> groups, std::span<const CrossMotion> motions,
                              const RunSetup& setup) {
  const std::size_t count = groups.size();
  ASTROID_CHECK_EQ(motions.size(), count * count);
  const auto own = [&](std::size_t g) { return own_motion(motions[g * count + g]); };
  if (count == 1) return motion_noise(*groups.front().estimator, own(0), setup);
  const double pure = mean(groups, purity);
  MotionNoise out;
  for (std::size_t g = 0; g < count; ++g) {
    const StarEstimator& a = *groups[g].estimator;
    // What a group's noise relative to its target is relative to all its light, and then to the mean target.
    const double kept = square(purity(a) / pure);
    const MotionNoise alone = motion_noise(a, own(g), setup);
    out.jitter_camera += groups[g].share * kept * alone.jitter_camera;
    out.prnu_exposure += groups[g].share * kept * alone.prnu_exposure;
    out.prnu_bin += groups[g].share * kept * alone.prnu_bin;
    for (std::size_t h = 0; h < count; ++h) {
      const StarEstimator& b = *groups[h].estimator;
      const auto along = [&](const CrossCovariance& c) {
        return a.gradient_x * (b.gradient_x * c.xx + b.gradient_y * c.xy) +
               a.gradient_y * (b.gradient_x * c.yx + b.gradient_y * c.yy);
      };
      const double weight = groups[g].share * groups[h].share / square(pure);
      out.jitter_exposure += weight * along(motions[g * count + h].exposure);
      out.jitter_bin += weight * along(motions[g * count + h].bin);
    }
  }
  return out;
}

}  // namespace astroid
