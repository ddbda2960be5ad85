#include "astroid/photometry/psf_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"
#include "field/field_fit.hpp"
#include "field/field_pixels.hpp"
#include "psf/psf_fit.hpp"
#include "psf/psf_gauge.hpp"
#include "psf/psf_guess.hpp"
#include "psf/psf_spread.hpp"
#include "psf/psf_stars.hpp"

namespace astroid {

namespace {

constexpr int kLargestStamp = 40;  // px, half-side
constexpr int kMargin = 8;         // px
constexpr std::size_t kLeastStars = 10;
constexpr double kPixelVariance = 1.0 / 12.0;  // px²

void check(const PsfMeasurementSettings& s) {
  if (s.rounds > 0 && s.most_stars >= kLeastStars && s.most_order >= 0 && s.most_order <= 2 && s.snr > 0.0) return;
  throw InputError(Problem{.parameter = "rounds, most stars, most order, snr",
                           .value = fmt::format("{}, {}, {}, {}", s.rounds, s.most_stars, s.most_order, s.snr),
                           .expected = fmt::format("> 0, at least {}, 0 to 2, > 0", kLeastStars),
                           .message = "no PSF can be measured so"});
}

void require_stars(std::size_t count) {
  if (count >= kLeastStars) return;
  throw InputError(
      Problem{.parameter = "--psf",
              .value = fmt::format("measured, of {} stars", count),
              .expected = fmt::format("at least {} bright stars that stand alone, or a PSF that is given", kLeastStars),
              .message = "the PSF cannot be measured from this image"});
}

// How much better left-out stars are foretold.
struct Gain {
  double sum = 0.0;
  double error = 0.0;
};

// Every fourth star is left out and foretold from the others.
class Foretelling {
 public:
  Foretelling(const detail::PsfFit& fit, std::size_t stars) : fit_(fit), use_(stars, 1) {
    for (std::size_t i = 0; i < stars; i += kFold) use_[i] = 0;
  }
  [[nodiscard]] std::vector<double> chi2(const detail::PsfFreedom& freedom) const {
    return fit_.chi2(fit_.solve(freedom, use_));
  }
  [[nodiscard]] Gain gain(std::span<const double> before, std::span<const double> after) const {
    Gain gain;
    double squares = 0.0;
    for (std::size_t i = 0; i < use_.size(); i += kFold) {
      gain.sum += before[i] - after[i];
      squares += (before[i] - after[i]) * (before[i] - after[i]);
    }
    gain.error = std::sqrt(squares);
    return gain;
  }

 private:
  static constexpr std::size_t kFold = 4;
  const detail::PsfFit& fit_;
  std::vector<char> use_;
};

// What foretells best: first how near to the prior, then the order of the variation, from that of `least` on.
detail::PsfFreedom choose_freedom(const detail::PsfFit& fit, std::size_t stars, detail::PsfFreedom least, int most) {
  const Foretelling foretelling(fit, stars);
  detail::PsfFreedom best = least;
  std::vector<double> before = foretelling.chi2(best);
  for (const double nearer : {0.3, 0.1, 0.03}) {
    detail::PsfFreedom next = best;
    next.from_prior = nearer;
    std::vector<double> after = foretelling.chi2(next);
    if (!(foretelling.gain(before, after).sum > 0.0)) break;
    best = next;
    before = std::move(after);
  }
  constexpr std::size_t kStarsPerTerm = 10;
  constexpr double kSignificant = 2.0;
  for (int order = best.order + 1; order <= most; ++order) {
    const auto terms = static_cast<std::size_t>((order + 1) * (order + 2) / 2);
    if (stars < kStarsPerTerm * terms) break;
    detail::PsfFreedom next = best;
    next.order = order;
    std::vector<double> after = foretelling.chi2(next);
    const Gain gain = foretelling.gain(before, after);
    if (!(gain.sum > kSignificant * gain.error)) break;
    best = next;
    before = std::move(after);
  }
  return best;
}

// The PSF's own error, from how those of two halves of the stars differ: each has twice the variance of the whole.
double error_of(const detail::FieldSolver& field, std::span<const std::size_t> stars, const detail::PsfFit& fit,
                const detail::PsfFreedom& freedom, double window) {
  std::vector<char> even(stars.size(), 0);
  std::vector<char> odd(stars.size(), 0);
  for (std::size_t i = 0; i < stars.size(); ++i) (i % 2 == 0 ? even : odd)[i] = 1;
  EffectivePsf a = fit.solve(freedom, even);
  EffectivePsf b = fit.solve(freedom, odd);
  detail::fix_gauge(a, window);
  detail::fix_gauge(b, window);
  return 0.5 * detail::flux_spread(field, stars, *make_effective_psf(std::move(a)), *make_effective_psf(std::move(b)));
}

}  // namespace

MeasuredPsf measure_psf(const Frame& frame, const PsfMeasurementSettings& settings) {
  check(settings);
  ASTROID_CHECK_EQ(frame.pixels.layout().regions().size(), std::size_t{1});
  const Rectangle area = frame.pixels.layout().regions()[0];
  ASTROID_CHECK_EQ(area.x0, 0);
  ASTROID_CHECK_EQ(area.y0, 0);
  const detail::FieldPixels pixels = detail::field_pixels(frame, settings.mesh, kLargestStamp + kMargin);
  double sigma = detail::guess_sigma(pixels);
  if (!(sigma > 0.0)) require_stars(0);

  const double wide = std::sqrt(sigma * sigma + kPixelVariance);
  constexpr double kSamplesPerSigma = 2.0;  // a spline then misses 1e-3 of a Gaussian's peak
  constexpr int kMostSamples = 4;
  const int samples = std::clamp(static_cast<int>(std::ceil(kSamplesPerSigma / wide)), 2, kMostSamples);
  constexpr double kGridFwhm = 4.0;
  constexpr int kLeastReach = 6;  // px
  constexpr int kMostReach = 24;
  const int reach = std::clamp(static_cast<int>(std::ceil(kGridFwhm * kFwhmPerSigma * wide)), kLeastReach, kMostReach);
  EffectivePsf present = detail::effective_gaussian(sigma, samples, reach * samples);
  present.field_centre = {area.x0 + 0.5 * (area.nx - 1), area.y0 + 0.5 * (area.ny - 1)};
  present.field_scale = {std::max(1.0, 0.5 * area.nx), std::max(1.0, 0.5 * area.ny)};
  std::shared_ptr<const PixelPsf> psf = make_effective_psf(present);
  MeasuredPsf result;
  detail::PsfFreedom freedom;
  double misfit = 1.0;
  for (int round = 0; round < settings.rounds; ++round) {
    const bool first = round == 0;
    const detail::PsfReach stamps(*psf, present.field_centre, kLargestStamp);
    // Only bright stars at first: with a wrong PSF what is left of them looks like more stars.
    const detail::FieldFitSettings field_settings{.threshold = first ? 10.0 : 5.0,
                                                  .rounds = first ? 1 : 2,
                                                  .sky_cell = settings.mesh.cell,
                                                  .psf_doubt = first ? 0.2 : 0.1,
                                                  .companions = false};
    detail::FieldFit field(*psf, stamps, pixels, field_settings);
    field.run();
    const std::vector<std::size_t> stars = detail::choose_psf_stars(field.solver(), settings.snr, settings.most_stars);
    require_stars(stars.size());
    constexpr double kLeastMisfit = 0.003;
    const double before = std::exchange(misfit, detail::psf_misfit(field.solver(), stars));
    const detail::PsfFitSettings fit_settings{.model_error = std::max(misfit, kLeastMisfit), .window = wide};
    const EffectivePsf prior = detail::effective_gaussian(sigma, samples, reach * samples);
    const detail::PsfFit fit(field.solver(), stars, present, prior, fit_settings);
    if (!first) freedom = choose_freedom(fit, stars.size(), {.order = freedom.order}, settings.most_order);
    present = fit.solve(freedom);
    detail::fix_gauge(present, wide);
    sigma = detail::nearest_sigma(present);
    const std::shared_ptr<const PixelPsf> better = make_effective_psf(present);
    const double change = detail::flux_spread(field.solver(), stars, *psf, *better);
    const std::vector<double> chi2 = fit.chi2(present);
    result.stars = stars.size();
    result.chi2 = std::accumulate(chi2.begin(), chi2.end(), 0.0) / static_cast<double>(fit.usable_pixels());
    constexpr double kGain = 0.8;           // of the misfit: more than this is no gain
    constexpr double kLeastChange = 0.001;  // of fluxes
    const bool settled = misfit <= kLeastMisfit ? change < kLeastChange : misfit > kGain * before;
    if (round + 1 == settings.rounds || (!first && settled)) {
      // A prior that holds the shape does not know its width better than the photons say.
      double electrons = 0.0;
      for (const std::size_t i : stars) electrons += field.solver().stars()[i].flux;
      result.flux_error = std::hypot(error_of(field.solver(), stars, fit, freedom, wide), 1.0 / std::sqrt(electrons));
      break;
    }
    psf = better;
  }
  result.from_prior = freedom.from_prior;
  result.psf = std::move(present);
  return result;
}

}  // namespace astroid
