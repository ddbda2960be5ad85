#include "star_estimator_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/photometry/aperture.hpp"

namespace astroid {

Rectangle mask_window(PixelPosition star, int size) {
  if (!std::isfinite(star.x) || !std::isfinite(star.y) || size <= 0) return {};
  // An even window has no central pixel: floor() makes 6 pixels begin two before the star's own (SCIENCE §3.2).
  const double half = size % 2 == 0 ? 0.0 : 0.5;
  const int before = (size - 1) / 2;
  return {static_cast<int>(std::floor(star.x + half)) - before, static_cast<int>(std::floor(star.y + half)) - before,
          size, size};
}

namespace detail {

namespace {

// A local background with a larger error than this many sigma of one pixel is worse than the known one.
constexpr double kWorstBackgroundError = 0.5;

PixelPosition nearest_pixel(PixelPosition p) {
  return {std::floor(p.x + 0.5), std::floor(p.y + 0.5)};
}

Rectangle bounding_box(const Rectangle& region, const PixelLayout& layout, const StarEstimator& estimator) {
  int x0 = std::numeric_limits<int>::max();
  int y0 = x0;
  int x1 = std::numeric_limits<int>::min();
  int y1 = x1;
  const auto width = static_cast<std::size_t>(region.nx);
  for (std::size_t i = 0; i < estimator.aperture_terms; ++i) {
    const std::size_t k = estimator.terms[i].pixel - layout.offset(estimator.region);
    const int x = region.x0 + static_cast<int>(k % width);
    const int y = region.y0 + static_cast<int>(k / width);
    x0 = std::min(x0, x);
    x1 = std::max(x1, x + 1);
    y0 = std::min(y0, y);
    y1 = std::max(y1, y + 1);
  }
  return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace

std::vector<Rectangle> aperture_windows(const GroundModel& model, const PhotometrySettings& settings) {
  std::vector<Rectangle> windows;
  windows.reserve(model.targets.size());
  for (const std::size_t target : model.targets) {
    const FieldStar& star = model.stars[target];
    const bool aperture = settings.method == PhotometryMethod::kAperture;
    windows.push_back(!shines(star) ? Rectangle{}
                      : aperture    ? aperture_box(star.position, settings.aperture_radius.value())
                                    : mask_window(star.position, settings.mask_window));
  }
  return windows;
}

StarEstimatorBuilder::StarEstimatorBuilder(const PixelLayout& layout, const GroundModel& model,
                                           const PhotometrySettings& settings)
    : layout_(layout),
      model_(model),
      settings_(settings),
      noise_(model.noise),
      stamps_(star_stamps(model, settings)),
      regions_(layout.regions()),
      fits_psf_(settings.method == PhotometryMethod::kPsf) {
  if (settings.background == BackgroundMethod::kLocal) light_ = expected_light(layout, model, stamps_);
}

StarEstimator StarEstimatorBuilder::build(std::size_t star, const Rectangle& window,
                                          std::span<const std::size_t> neighbours) {
  const FieldStar& target = model_.stars[star];
  StarEstimator estimator;
  estimator.star = star;
  estimator.window = window;
  estimator.nsr_exposure = std::numeric_limits<double>::infinity();
  if (!choose_region(target, window, estimator)) {
    estimator.flags |= measurement_flag::kOutside;
    return estimator;
  }
  if (window.empty()) {
    estimator.flags |= measurement_flag::kNoFlux;
    return estimator;
  }
  // PSF weights are chosen for the pixels that are there; masks give way only where they are cut.
  const Rectangle used = fits_psf_ ? intersect(window, layout_.regions()[estimator.region]) : window;
  if (!(used == window)) estimator.flags |= measurement_flag::kEdge;
  expected_in_window(star, used, neighbours);
  if (fits_psf_) differentiate(star, used, neighbours);
  if (!(fits_psf_ ? choose_psf_weights(target, used, estimator) : choose_weights(target, window))) {
    estimator.flags |= measurement_flag::kNoFlux;
    return estimator;
  }
  cut_at_edges(target, used, estimator);
  fill_budget(used, estimator);
  if (!(estimator.budget.target > 0.0)) {
    estimator.terms.clear();
    estimator.aperture_terms = 0;
    estimator.flags |= measurement_flag::kNoFlux;
    return estimator;
  }
  add_background(target, used, estimator);
  add_pattern_noise(used, estimator);
  add_calibration_noise(estimator);
  if (fits_psf_) judge_blend(used, estimator);
  estimator.nsr_exposure = std::sqrt(estimator.budget.variance()) / estimator.budget.target;
  fill_gradients(star, neighbours, estimator);
  return estimator;
}

bool StarEstimatorBuilder::choose_region(const FieldStar& star, const Rectangle& window, StarEstimator& estimator) {
  const PixelPosition centre = nearest_pixel(star.position);
  constexpr double kFarthestPixel = 1e8;
  if (!(std::abs(centre.x) < kFarthestPixel && std::abs(centre.y) < kFarthestPixel)) return false;
  const Rectangle pixel{static_cast<int>(centre.x), static_cast<int>(centre.y), 1, 1};
  const Rectangle annulus = aperture_box(star.position, settings_.annulus_outer.value());
  regions_.find(pixel, found_);
  std::size_t most_aperture = 0;
  std::size_t most_annulus = 0;
  bool chosen = false;
  for (const std::size_t region : found_) {
    const std::size_t in_aperture = intersect(window, layout_.regions()[region]).size();
    const std::size_t in_annulus = intersect(annulus, layout_.regions()[region]).size();
    const bool better = in_aperture > most_aperture || (in_aperture == most_aperture && in_annulus > most_annulus);
    if (chosen && !better) continue;
    estimator.region = region;
    most_aperture = in_aperture;
    most_annulus = in_annulus;
    chosen = true;
  }
  return chosen;
}

void StarEstimatorBuilder::expected_in_window(std::size_t star, const Rectangle& window,
                                              std::span<const std::size_t> neighbours) {
  const std::size_t pixels = window.size();
  target_.assign(pixels, 0.0);
  contaminants_.assign(pixels, 0.0);
  total_.resize(pixels);
  // The target's own light isn't cut at its stamp: near the edge of the window every pixel still counts.
  add_star(*model_.psf, model_.stars[star], window, window, target_, scratch_);
  if (fits_psf_) {
    light_of_each(star, window, neighbours);
  } else {
    for (const std::size_t neighbour : neighbours)
      if (neighbour != star)
        add_star(*model_.psf, model_.stars[neighbour], stamps_[neighbour], window, contaminants_, scratch_);
  }
  for (std::size_t i = 0; i < pixels; ++i) total_[i] = target_[i] + contaminants_[i];
  smear_window(window);
}

bool StarEstimatorBuilder::choose_weights(const FieldStar& star, const Rectangle& window) {
  weights_.assign(window.size(), 0.0);
  switch (settings_.method) {
    case PhotometryMethod::kAperture:
      aperture_overlap(star.position, settings_.aperture_radius.value(), window, weights_);
      return true;
    case PhotometryMethod::kMask: {
      const std::vector<std::size_t> mask = optimal_binary_mask(target_, total_, noise_);
      for (const std::size_t pixel : mask) weights_[pixel] = 1.0;
      return !mask.empty();
    }
    case PhotometryMethod::kWeighted: {
      double sum = 0.0;
      for (std::size_t i = 0; i < weights_.size(); ++i) {
        const double variance = noise_.variance(total_[i]);
        weights_[i] = target_[i] > 0.0 ? target_[i] / variance : 0.0;
        sum += weights_[i];
      }
      return sum > 0.0;
    }
    case PhotometryMethod::kPsf:
      break;
  }
  throw BugError("unknown photometry method");
}

void StarEstimatorBuilder::cut_at_edges(const FieldStar& star, const Rectangle& window, StarEstimator& estimator) {
  const Rectangle& region = layout_.regions()[estimator.region];
  const auto width = static_cast<std::size_t>(window.nx);
  const Rectangle inside = intersect(window, region);
  bool cut = false;
  if (!(inside == window)) {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const int x = window.x0 + static_cast<int>(i % width);
      const int y = window.y0 + static_cast<int>(i / width);
      if (inside.contains(x, y)) continue;
      cut = cut || weights_[i] > 0.0;
      target_[i] = 0.0;
      contaminants_[i] = 0.0;
      total_[i] = 0.0;
      weights_[i] = 0.0;
    }
  }
  if (cut) {
    estimator.flags |= measurement_flag::kEdge;
    // What is best without the lost pixels is another mask; pixels without target light stay out of it.
    if (settings_.method == PhotometryMethod::kMask) choose_weights(star, window);
  }
  if (settings_.method == PhotometryMethod::kWeighted) {
    double enclosed = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) enclosed += weights_[i] * target_[i];
    for (double& weight : weights_) weight = enclosed > 0.0 ? weight * star.electrons / enclosed : 0.0;
  }
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    // What is applied is a float: everything predicted below is of this weight.
    const auto weight = static_cast<float>(weights_[i]);
    weights_[i] = static_cast<double>(weight);
    if (weight == 0.0F) continue;
    const int x = window.x0 + static_cast<int>(i % width);
    const int y = window.y0 + static_cast<int>(i / width);
    estimator.terms.push_back({static_cast<std::uint32_t>(layout_.index(estimator.region, x, y)), weight});
  }
  estimator.aperture_terms = estimator.terms.size();
  estimator.mask_pixels = static_cast<int>(estimator.terms.size());
}

void StarEstimatorBuilder::fill_budget(const Rectangle& window, StarEstimator& estimator) {
  const PixelNoise& noise = noise_;
  const double electrons = model_.stars[estimator.star].electrons;
  EstimatorBudget& budget = estimator.budget;
  double squares = 0.0;
  double photon_squares = 0.0;
  double readout_squares = 0.0;
  double static_prnu = 0.0;
  const std::vector<double>& photon_weights = couple_weights(window);
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double w = weights_[i];
    const double square = w * w;
    const double photon_square = photon_weights[i] * photon_weights[i];
    budget.target += w * target_[i];
    budget.contaminants += w * contaminants_[i];
    const RampVariance fit = noise.factors(total_[i]);
    budget.var_target += fit.photon * photon_square * target_[i];
    budget.var_contaminants += fit.photon * photon_square * contaminants_[i];
    squares += square;
    photon_squares += fit.photon * photon_square;
    readout_squares += fit.readout * square;
    const double light = fits_psf_ ? target_[i] + contaminants_[i] : target_[i];
    static_prnu += (w * light) * (w * light);
  }
  budget.var_background = photon_squares * noise.background;
  budget.var_readout = readout_squares * noise.readout * noise.readout;
  budget.var_quantisation = readout_squares * noise.quantisation * noise.quantisation;
  // A fitted ramp is rounded once more when it is delivered.
  if (noise.ramp.reads > 1) budget.var_quantisation += squares * noise.quantisation * noise.quantisation;
  if (!(budget.target > 0.0)) return;
  // PSF weights: what the neighbours are believed to leave is no part of the flux.
  if (fits_psf_) estimator.offset = std::exchange(budget.contaminants, 0.0);
  estimator.enclosed_fraction = budget.target / electrons;
  estimator.spr_total = budget.contaminants / (budget.target + budget.contaminants);
  estimator.prnu_static = std::sqrt(static_prnu) / budget.target;
  if (estimator.spr_total > model_.contamination_limit) estimator.flags |= measurement_flag::kContaminated;
}

void StarEstimatorBuilder::add_background(const FieldStar& star, const Rectangle& window, StarEstimator& estimator) {
  double weight_sum = 0.0;
  for (const EstimatorTerm& term : estimator.terms) weight_sum += static_cast<double>(term.weight);
  estimator.known_background = noise_.background * weight_sum + estimator.offset;
  switch (settings_.background) {
    case BackgroundMethod::kMesh:
      estimator.known_background = 0.0;
      return;
    case BackgroundMethod::kKnown:
      estimator.offset = estimator.known_background;
      return;
    case BackgroundMethod::kLocal:
      // PSF weights have chosen it before, since they depend on its error.
      if (!fits_psf_) choose_annulus(star, window, estimator);
      if (annulus_.usable) {
        add_local_background(weight_sum, estimator);
        return;
      }
      estimator.offset = estimator.known_background;
      estimator.flags |= measurement_flag::kNoBackground;
      return;
  }
}

void StarEstimatorBuilder::find_annulus_pixels(const FieldStar& star, const Rectangle& window,
                                               const StarEstimator& estimator) {
  const double inner = settings_.annulus_inner.value();
  const double outer = settings_.annulus_outer.value();
  const Rectangle& region = layout_.regions()[estimator.region];
  const Rectangle box = intersect(aperture_box(star.position, outer), region);
  // Only an aperture that reaches into its own annulus shares pixels with it.
  const bool shared = settings_.method == PhotometryMethod::kAperture
                          ? settings_.aperture_radius.value() + 1.0 > inner
                          : static_cast<double>(settings_.mask_window) > inner;
  const auto in_aperture = [&](int x, int y, std::size_t pixel) {
    if (fits_psf_) return window.contains(x, y);
    return std::any_of(estimator.terms.begin(), estimator.terms.end(),
                       [pixel](const EstimatorTerm& term) { return term.pixel == pixel; });
  };
  found_.clear();
  for (int y = box.y0; y < box.y1(); ++y) {
    for (int x = box.x0; x < box.x1(); ++x) {
      const double dx = x - star.position.x;
      const double dy = y - star.position.y;
      const double square = dx * dx + dy * dy;
      if (square < inner * inner || square > outer * outer) continue;
      const std::size_t pixel = layout_.index(estimator.region, x, y);
      if (!(shared && in_aperture(x, y, pixel))) found_.push_back(pixel);
    }
  }
}

void StarEstimatorBuilder::choose_annulus(const FieldStar& star, const Rectangle& window,
                                          const StarEstimator& estimator) {
  find_annulus_pixels(star, window, estimator);
  const std::span<const double> light = light_.pixels();
  std::stable_sort(found_.begin(), found_.end(), [light](std::size_t a, std::size_t b) { return light[a] < light[b]; });
  // From the darkest pixel on, take as many as make the mean best: noise falls, doubt of the star light rises.
  double star_light = 0.0;
  double best_error = std::numeric_limits<double>::infinity();
  std::size_t best_count = 0;
  annulus_ = {};
  for (std::size_t k = 0; k < found_.size(); ++k) {
    star_light += light[found_[k]];
    const auto count = static_cast<double>(k + 1);
    const double doubt = model_.flux_doubt * star_light / count;
    const double error = noise_.variance(star_light / count) / count + doubt * doubt;
    if (k + 1 < kFewestBackgroundPixels || error >= best_error) continue;
    best_error = error;
    best_count = k + 1;
    annulus_.star_light = star_light;
    annulus_.doubt = doubt;
  }
  const double noise_variance = noise_.variance();
  const double worst = kWorstBackgroundError * kWorstBackgroundError * noise_variance;
  annulus_.usable = best_count > 0 && (best_error <= worst || !(noise_variance > 0.0));
  annulus_.error = std::sqrt(best_error);
  found_.resize(best_count);
  std::sort(found_.begin(), found_.end());
}

void StarEstimatorBuilder::add_local_background(double weight_sum, StarEstimator& estimator) {
  const auto count = static_cast<double>(found_.size());
  const auto weight = static_cast<float>(-weight_sum / count);
  for (const std::size_t pixel : found_) estimator.terms.push_back({static_cast<std::uint32_t>(pixel), weight});
  estimator.offset += -weight_sum * annulus_.star_light / count;
  estimator.budget.var_background_estimate =
      (weight_sum / count) * (weight_sum / count) *
      (count * noise_.variance() + noise_.factors(annulus_.star_light / count).photon * annulus_.star_light);
}

void StarEstimatorBuilder::differentiate(std::size_t star, const Rectangle& box,
                                         std::span<const std::size_t> neighbours) {
  for (const bool along_x : {true, false}) {
    LightChange& change = along_x ? change_x_ : change_y_;
    change.target.assign(box.size(), 0.0);
    change.contaminants.assign(box.size(), 0.0);
    add_change(*model_.psf, model_.stars[star], box, box, along_x, change.target, scratch_);
    for (const std::size_t neighbour : neighbours)
      if (neighbour != star)
        add_change(*model_.psf, model_.stars[neighbour], stamps_[neighbour], box, along_x, change.contaminants,
                   scratch_);
  }
}

void StarEstimatorBuilder::fill_gradients(std::size_t star, std::span<const std::size_t> neighbours,
                                          StarEstimator& estimator) {
  // PSF weights have differentiated the light of their window before, and weights_ is over it.
  if (!fits_psf_) {
    const Rectangle& region = layout_.regions()[estimator.region];
    const Rectangle box = bounding_box(region, layout_, estimator);
    const auto width = static_cast<std::size_t>(box.nx);
    // weights_ becomes the weights over the smaller box.
    weights_.assign(box.size(), 0.0);
    for (std::size_t i = 0; i < estimator.aperture_terms; ++i) {
      const std::size_t k = estimator.terms[i].pixel - layout_.offset(estimator.region);
      const int x = region.x0 + static_cast<int>(k % static_cast<std::size_t>(region.nx));
      const int y = region.y0 + static_cast<int>(k / static_cast<std::size_t>(region.nx));
      weights_[static_cast<std::size_t>(y - box.y0) * width + static_cast<std::size_t>(x - box.x0)] =
          static_cast<double>(estimator.terms[i].weight);
    }
    differentiate(star, box, neighbours);
  }
  for (const bool along_x : {true, false}) {
    const LightChange& light = along_x ? change_x_ : change_y_;
    double change = 0.0;
    double prnu = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const double all = light.target[i] + light.contaminants[i];
      const double judged = weights_[i] * (fits_psf_ ? all : light.target[i]);
      change += weights_[i] * all;
      prnu += judged * judged;
    }
    const double flux = estimator.budget.target + estimator.budget.contaminants;
    (along_x ? estimator.gradient_x : estimator.gradient_y) = change / (2.0 * kGradientStep * flux);
    (along_x ? estimator.prnu_gradient_x : estimator.prnu_gradient_y) =
        std::sqrt(prnu) / (2.0 * kGradientStep * estimator.budget.target);
  }
}

}  // namespace detail
}  // namespace astroid
