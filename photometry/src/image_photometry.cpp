#include "astroid/photometry/image_photometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/photometry/aperture.hpp"
#include "astroid/photometry/estimator.hpp"
#include "image_sky.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// What the aperture that gives a neighbour its first flux took in a crowd may all be of others.
constexpr double kGuessDoubt = 1.0;

// Weights of the pixels of a box, row by row.
struct Weights {
  Rectangle box;
  std::vector<double> weight;
  double neighbours = 0.0;           // e-, of their believed light under the weights, to be taken out
  double neighbours_variance = 0.0;  // e-², of the doubt about it
};

// Sums over the pixels of the frame that have weight.
struct WeightedSum {
  double flux = kNaN;  // e-
  double variance = kNaN;
  std::uint32_t flags = 0;
};

void check_settings(const ImagePhotometrySettings& settings) {
  std::vector<Problem> problems;
  const auto complain = [&problems](const char* parameter, std::string value, const char* expected,
                                    const char* message) {
    Problem problem;
    problem.parameter = parameter;
    problem.value = std::move(value);
    problem.expected = expected;
    problem.message = message;
    problems.push_back(std::move(problem));
  };
  const double radius = settings.aperture_radius.value();
  const double inner = settings.annulus_inner.value();
  const double outer = settings.annulus_outer.value();
  if (!(radius > 0.0 && std::isfinite(radius)))
    complain("aperture radius", fmt::format("{}", radius), "more than 0 px", "an aperture needs an area");
  if (settings.method != PhotometryMethod::kAperture && settings.psf == nullptr)
    complain("psf", "", "a PSF, given or measured", "masks and PSF weights follow from the PSF");
  if (settings.method != PhotometryMethod::kAperture && settings.mask_window <= 0)
    complain("mask window", fmt::format("{}", settings.mask_window), "at least 1 px", "no pixel can be in the mask");
  if (settings.background == BackgroundMethod::kLocal && !(inner >= 0.0 && outer > inner && std::isfinite(outer)))
    complain("annulus", fmt::format("{} to {}", inner, outer), "0 <= inner radius < outer radius, px",
             "the annulus of the local background has no area");
  if (!(settings.annulus_clip > 0.0))
    complain("annulus clip", fmt::format("{}", settings.annulus_clip), "more than 0 sigma", "no pixel would be left");
  if (!problems.empty()) throw InputError(std::move(problems));
}

void check_positions(std::span<const SourceRequest> sources, const SkyProjection* sky) {
  if (sky != nullptr) return;
  for (const SourceRequest& source : sources) {
    if (source.pixel || !source.sky) continue;
    Problem problem;
    problem.parameter = "source " + source.id;
    problem.expected = "x and y, or an image with celestial coordinates";
    problem.message = "a position in the sky, but the image has no coordinates";
    throw InputError(std::move(problem));
  }
}

PixelPosition position_of(const SourceRequest& source, const SkyProjection* sky) {
  if (source.pixel) return *source.pixel;
  if (source.sky && sky != nullptr) return sky->to_pixel(*source.sky).value_or(PixelPosition{kNaN, kNaN});
  return {kNaN, kNaN};
}

bool on_frame(PixelPosition p, const Rectangle& area) {
  return p.x >= area.x0 - 0.5 && p.x < area.x1() - 0.5 && p.y >= area.y0 - 0.5 && p.y < area.y1() - 0.5;
}

Weights aperture_weights(PixelPosition centre, double radius) {
  Weights weights{.box = aperture_box(centre, radius), .weight = {}};
  weights.weight.resize(weights.box.size());
  aperture_overlap(centre, radius, weights.box, weights.weight);
  return weights;
}

Weights mask_weights(const StarEstimator& estimator, const Rectangle& area) {
  // Without a background of its own an estimator's offset is what PSF weights leave of the neighbours.
  Weights weights{.box = estimator.window,
                  .weight = std::vector<double>(estimator.window.size(), 0.0),
                  .neighbours = estimator.offset,
                  .neighbours_variance = estimator.budget.var_neighbour_doubt};
  const auto width = static_cast<std::size_t>(area.nx);
  for (const EstimatorTerm& term : estimator.terms) {
    const int x = area.x0 + static_cast<int>(term.pixel % width);
    const int y = area.y0 + static_cast<int>(term.pixel / width);
    const Rectangle& box = weights.box;
    weights.weight[static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx) +
                   static_cast<std::size_t>(x - box.x0)] = static_cast<double>(term.weight);
  }
  return weights;
}

template <class Visit>
void for_each_pixel(const Weights& weights, const Rectangle& area, Visit visit) {
  std::size_t i = 0;
  for (int y = weights.box.y0; y < weights.box.y1(); ++y)
    for (int x = weights.box.x0; x < weights.box.x1(); ++x, ++i)
      if (weights.weight[i] != 0.0) visit(x, y, i, area.contains(x, y));
}

WeightedSum sum_pixels(const Frame& frame, const Weights& weights, const detail::SkyUnderStar& sky) {
  const auto pixels = frame.pixels.view(0);
  const auto flags = frame.flags.view(0);
  const double gain = frame.header.gain.value();
  WeightedSum sum;
  double flux = 0.0;
  double star_variance = 0.0;
  double total = 0.0;
  double squares = 0.0;
  for_each_pixel(weights, pixels.area(), [&](int x, int y, std::size_t i, bool inside) {
    if (!inside) {
      sum.flags |= measurement_flag::kEdge;
      return;
    }
    const double w = weights.weight[i];
    const double electrons = gain * (static_cast<double>(pixels.at(x, y)) - sky.level);
    constexpr unsigned kSaturatedBits = pixel_flag::kFullWell | pixel_flag::kAdcSaturated;
    if ((flags.at(x, y) & kSaturatedBits) != 0U) sum.flags |= measurement_flag::kSaturated;
    if ((flags.at(x, y) & pixel_flag::kBad) != 0U || !std::isfinite(pixels.at(x, y)))
      sum.flags |= measurement_flag::kBadPixel;
    flux += w * electrons;
    star_variance += w * w * electrons;
    total += w;
    squares += w * w;
  });
  if (!std::isfinite(flux) || total == 0.0) return sum;
  const double level_error = gain * sky.error * total;
  sum.flux = flux - weights.neighbours;
  sum.variance =
      squares * sky.variance + std::max(0.0, star_variance) + level_error * level_error + weights.neighbours_variance;
  return sum;
}

// Fraction of the PSF, weighted, in the pixels that were used.
double enclosed_fraction(const PixelPsf& psf, PixelPosition centre, const Weights& weights, const Rectangle& area) {
  std::vector<double> fractions(weights.box.size());
  psf.integrate(centre, weights.box, fractions);
  double sum = 0.0;
  for_each_pixel(weights, area, [&](int, int, std::size_t i, bool inside) {
    if (inside) sum += weights.weight[i] * fractions[i];
  });
  return sum;
}

double reduced_chi2(const Frame& frame, const PixelPsf& psf, PixelPosition centre, const Weights& weights,
                    const detail::SkyUnderStar& sky, double star_electrons) {
  const auto pixels = frame.pixels.view(0);
  std::vector<double> fractions(weights.box.size());
  psf.integrate(centre, weights.box, fractions);
  double chi2 = 0.0;
  int count = 0;
  for_each_pixel(weights, pixels.area(), [&](int x, int y, std::size_t i, bool inside) {
    if (!inside) return;
    const double model = star_electrons * fractions[i];
    const double residual = frame.header.gain.value() * (static_cast<double>(pixels.at(x, y)) - sky.level) - model;
    chi2 += residual * residual / (sky.variance + std::max(0.0, model));
    ++count;
  });
  return count > 1 ? chi2 / (count - 1) : kNaN;
}

class ImageMeasurer {
 public:
  ImageMeasurer(const Frame& frame, const ImagePhotometrySettings& settings)
      : frame_(frame), settings_(settings), area_(frame.pixels.layout().regions()[0]), sky_(frame, settings) {}

  void measure_all(std::span<SourceMeasurement> sources) {
    skies_.resize(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const PixelPosition centre{sources[i].x, sources[i].y};
      if (!on_frame(centre, area_)) {
        sources[i].flags |= measurement_flag::kOutside;
        continue;
      }
      skies_[i] = sky_.under(centre);
      if (skies_[i].fallback) sources[i].flags |= measurement_flag::kNoBackground;
      sources[i].background = frame_.header.gain.value() * (skies_[i].level - frame_.header.bias.value());
    }
    if (settings_.method == PhotometryMethod::kAperture) {
      for (std::size_t i = 0; i < sources.size(); ++i)
        if ((sources[i].flags & measurement_flag::kOutside) == 0U)
          finish(sources[i], aperture_weights({sources[i].x, sources[i].y}, settings_.aperture_radius.value()),
                 skies_[i]);
    } else {
      measure_masks(sources);
    }
  }

 private:
  // Total electrons of every source by an aperture: what masks begin with. 0 where there is no telling.
  std::vector<FieldStar> guess(std::span<const SourceMeasurement> sources) const {
    std::vector<FieldStar> stars(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const PixelPosition centre{sources[i].x, sources[i].y};
      stars[i].position = centre;
      if ((sources[i].flags & measurement_flag::kOutside) != 0U) continue;
      const Weights weights = aperture_weights(centre, settings_.aperture_radius.value());
      const WeightedSum sum = sum_pixels(frame_, weights, skies_[i]);
      const double enclosed = enclosed_fraction(*settings_.psf, centre, weights, area_);
      // A star lost in the noise gets the mask that suits noise alone.
      const double electrons = std::max(sum.flux, std::sqrt(sum.variance)) / enclosed;
      if (std::isfinite(electrons)) stars[i].electrons = electrons;
    }
    return stars;
  }

  double typical_variance() const {
    std::vector<double> variances;
    for (const detail::SkyUnderStar& sky : skies_)
      if (sky.variance > 0.0 && std::isfinite(sky.variance)) variances.push_back(sky.variance);
    if (variances.empty()) return 0.0;
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    return *middle;
  }

  void measure_masks(std::span<SourceMeasurement> sources) {
    const std::vector<FieldStar> stars = guess(sources);
    std::vector<std::size_t> targets(stars.size());
    for (std::size_t i = 0; i < targets.size(); ++i) targets[i] = i;
    GroundModel model;
    model.stars = stars;
    model.targets = targets;
    model.psf = settings_.psf.get();
    model.noise.background = typical_variance();
    PhotometrySettings masks;
    masks.method = settings_.method;
    if (masks.method == PhotometryMethod::kPsf) model.flux_doubt = kGuessDoubt;
    masks.mask_window = settings_.mask_window;
    masks.background = BackgroundMethod::kMesh;
    const std::vector<StarEstimator> estimators = build_estimators(frame_.pixels.layout(), model, masks);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      sources[i].flags |= estimators[i].flags;
      if (!estimators[i].terms.empty()) {
        finish(sources[i], mask_weights(estimators[i], area_), skies_[i]);
      } else if ((sources[i].flags & measurement_flag::kOutside) == 0U) {
        // No flux to begin with: the aperture met a pixel without a value.
        const Weights weights = aperture_weights({sources[i].x, sources[i].y}, settings_.aperture_radius.value());
        sources[i].flags |= sum_pixels(frame_, weights, skies_[i]).flags;
      }
    }
  }

  void finish(SourceMeasurement& source, const Weights& weights, const detail::SkyUnderStar& sky) const {
    const PixelPosition centre{source.x, source.y};
    const WeightedSum sum = sum_pixels(frame_, weights, sky);
    source.flags |= sum.flags;
    if (!std::isfinite(sum.flux)) return;
    source.flux = sum.flux;
    source.flux_err = std::sqrt(sum.variance);
    if (settings_.psf != nullptr) {
      const double enclosed = enclosed_fraction(*settings_.psf, centre, weights, area_);
      source.chi2 = reduced_chi2(frame_, *settings_.psf, centre, weights, sky, sum.flux / enclosed);
      if (settings_.whole_star) {
        source.flux /= enclosed;
        source.flux_err /= enclosed;
      }
    }
    if (source.flux_err > 0.0) source.snr = source.flux / source.flux_err;
    const auto magnitude = magnitude_of(Electrons(source.flux) / frame_.header.exposure_time, settings_.zero_point);
    if (magnitude) {
      source.mag = magnitude->value();
      source.mag_err = magnitude_error(source.snr).value();
    }
  }

  const Frame& frame_;
  const ImagePhotometrySettings& settings_;
  Rectangle area_;
  detail::ImageSky sky_;
  std::vector<detail::SkyUnderStar> skies_;
};

}  // namespace

std::vector<SourceMeasurement> measure_image(const Frame& frame, const SkyProjection* sky,
                                             std::span<const SourceRequest> sources,
                                             const ImagePhotometrySettings& settings) {
  check_settings(settings);
  check_positions(sources, sky);
  ASTROID_CHECK_EQ(frame.pixels.layout().regions().size(), std::size_t{1});
  std::vector<SourceMeasurement> measured(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    SourceMeasurement& m = measured[i];
    const PixelPosition centre = position_of(sources[i], sky);
    SkyPosition direction{kNaN, kNaN};
    if (sources[i].sky) {
      direction = *sources[i].sky;
    } else if (sky != nullptr && std::isfinite(centre.x) && std::isfinite(centre.y)) {
      direction = sky->to_sky(centre);
    }
    m.id = sources[i].id;
    m.x = centre.x;
    m.y = centre.y;
    m.ra = direction.ra;
    m.dec = direction.dec;
    m.flux = m.flux_err = m.mag = m.mag_err = m.background = m.snr = m.chi2 = kNaN;
  }
  ImageMeasurer(frame, settings).measure_all(measured);
  return measured;
}

}  // namespace astroid
