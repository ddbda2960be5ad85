// PSF weights with neighbours: what StarEstimatorBuilder does for this method alone.
#include <algorithm>
#include <cmath>

#include "star_estimator_builder.hpp"

namespace astroid::detail {

void StarEstimatorBuilder::light_of_each(std::size_t star, const Rectangle& window,
                                         std::span<const std::size_t> neighbours) {
  const std::size_t pixels = window.size();
  doubts_.clear();
  neighbours_ = 0;
  for (const std::size_t neighbour : neighbours) {
    if (neighbour == star) continue;
    doubts_.resize((neighbours_ + 1) * pixels, 0.0);
    const std::span<double> light(doubts_.data() + neighbours_ * pixels, pixels);
    add_star(*model_.psf, model_.stars[neighbour], stamps_[neighbour], window, light, scratch_);
    for (std::size_t i = 0; i < pixels; ++i) contaminants_[i] += light[i];
    ++neighbours_;
  }
}

bool StarEstimatorBuilder::choose_psf_weights(const FieldStar& star, const Rectangle& window,
                                              const StarEstimator& estimator) {
  const std::size_t pixels = window.size();
  for (double& light : doubts_) light *= model_.flux_doubt;
  if (settings_.background == BackgroundMethod::kLocal) {
    choose_annulus(star, window, estimator);
    // The annulus is one more datum of the same background: its mean has this error in every pixel of the window.
    if (annulus_.usable) doubts_.resize(doubts_.size() + pixels, annulus_.error);
  }
  doubt_motion();
  std::vector<double>& variance = scratch_;
  variance.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) variance[i] = model_.noise.variance(total_[i]);
  // In units of the believed flux, so that what follows is of order one.
  weights_.resize(pixels);
  fractions_.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) fractions_[i] = target_[i] / star.electrons;
  const PsfErrors errors = psf_weights({fractions_, variance, doubts_}, weights_, psf_scratch_);
  known_sigma_ = errors.known;
  const auto fits_float = [](double weight) { return std::isfinite(static_cast<float>(weight)); };
  return std::isfinite(errors.noise) && std::all_of(weights_.begin(), weights_.end(), fits_float);
}

void StarEstimatorBuilder::doubt_motion() {
  const MotionCovariance& motion = model_.motion;
  if (!(motion.sxx > 0.0 || motion.syy > 0.0)) return;
  // Cholesky factors of the covariance: two independent motions, along (a, b) and (0, c).
  const double a = std::sqrt(std::max(0.0, motion.sxx));
  const double b = a > 0.0 ? motion.sxy / a : 0.0;
  const double c = std::sqrt(std::max(0.0, motion.syy - b * b));
  const std::size_t pixels = change_x_.target.size();
  const std::size_t first = doubts_.size();
  doubts_.resize(first + 2 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double dx = (change_x_.target[i] + change_x_.contaminants[i]) / (2.0 * kGradientStep);
    const double dy = (change_y_.target[i] + change_y_.contaminants[i]) / (2.0 * kGradientStep);
    doubts_[first + i] = a * dx + b * dy;
    doubts_[first + pixels + i] = c * dy;
  }
}

void StarEstimatorBuilder::judge_blend(const Rectangle& window, StarEstimator& estimator) {
  EstimatorBudget& budget = estimator.budget;
  const std::size_t pixels = window.size();
  double doubt = 0.0;
  for (std::size_t k = 0; k < neighbours_; ++k) {
    double left = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) left += weights_[i] * doubts_[k * pixels + i];
    doubt += left * left;
  }
  const double random =
      budget.variance() - budget.var_background_estimate - budget.var_smearing_correction - budget.var_bias;
  if (random + doubt > kBlendInflation * kBlendInflation * known_sigma_ * known_sigma_ ||
      doubt > kBlendDoubt * kBlendDoubt * budget.target * budget.target)
    estimator.flags |= measurement_flag::kBlended;
  if (settings_.background == BackgroundMethod::kLocal && annulus_.usable) {
    double weight_sum = 0.0;
    for (const double weight : weights_) weight_sum += weight;
    doubt += weight_sum * weight_sum * annulus_.doubt * annulus_.doubt;
  }
  budget.var_neighbour_doubt = doubt;
}

}  // namespace astroid::detail
