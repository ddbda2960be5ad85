#include "astroid/photometry/field_photometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/photometry/estimator.hpp"
#include "field/field_fit.hpp"
#include "field/field_pixels.hpp"
#include "field/hidden_stars.hpp"
#include "field/unsettled_star.hpp"
#include "source_places.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kLargestStamp = 40;      // px, half-side
constexpr double kBlendedShare = 0.5;  // of the information about a flux that neighbours leave: error √2 larger

void check_settings(const FieldPhotometrySettings& settings) {
  if (settings.threshold > 0.0 && settings.rounds > 0) return;
  throw InputError(Problem{.parameter = "threshold, rounds",
                           .value = fmt::format("{}, {}", settings.threshold, settings.rounds),
                           .expected = "both more than 0",
                           .message = "nothing can be detected"});
}

double core_chi2(const detail::FieldSolver& field, const detail::ModelStar& star, int core) {
  const int x0 = static_cast<int>(std::floor(star.x + 0.5)) - core;
  const int y0 = static_cast<int>(std::floor(star.y + 0.5)) - core;
  double chi2 = 0.0;
  int count = 0;
  for (int j = 0; j <= 2 * core; ++j) {
    const float* w = field.weight().at(x0, y0 + j);
    const float* r = field.residual().at(x0, y0 + j);
    for (int i = 0; i <= 2 * core; ++i) {
      if (!(w[i] > 0.0F)) continue;
      chi2 += static_cast<double>(r[i] * r[i] * w[i]);
      ++count;
    }
  }
  return count > 0 ? chi2 / count : kNaN;
}

}  // namespace

std::vector<SourceMeasurement> measure_field(const Frame& frame, const SkyProjection* sky, const PixelPsf& psf,
                                             const FieldPhotometrySettings& settings) {
  check_settings(settings);
  ASTROID_CHECK_EQ(frame.pixels.layout().regions().size(), std::size_t{1});
  const Rectangle area = frame.pixels.layout().regions()[0];
  ASTROID_CHECK_EQ(area.x0, 0);  // the PSF may vary over the frame, and is asked for in its pixels
  ASTROID_CHECK_EQ(area.y0, 0);
  const detail::PsfReach reach(psf, {area.x0 + 0.5 * area.nx, area.y0 + 0.5 * area.ny}, kLargestStamp);
  constexpr int kMargin = 8;  // px: stars may lie a little outside, and vectors are read whole
  detail::FieldPixels pixels = detail::field_pixels(frame, settings.mesh, reach.most() + kMargin);
  if (!pixels.any) return {};
  // What an error of the flux is in single pixels, where it is positive and negative.
  constexpr double kDoubtPerError = 5.0;
  const detail::FieldFitSettings fit_settings{.threshold = settings.threshold,
                                              .rounds = settings.rounds,
                                              .sky_cell = settings.mesh.cell,
                                              .psf_doubt = kDoubtPerError * settings.psf_error};
  detail::FieldFit fit(psf, reach, pixels, fit_settings);
  fit.run();
  detail::FieldSolver& field = fit.solver();
  const detail::HiddenStars hidden(field, fit.filter(), settings.threshold);
  detail::LocalFit local(field);
  std::vector<SourceMeasurement> sources;
  for (std::size_t i = 0; i < field.stars().size(); ++i) {
    detail::ModelStar star = field.stars()[i];
    detail::StarCovariance c = local.covariance(i);
    std::uint32_t flags = c.share < kBlendedShare ? measurement_flag::kBlended : 0U;
    if (detail::is_unsettled(star) && !c.degenerate) {
      const FittedStar settled = detail::settle(field, i);
      constexpr std::uint32_t kNot = measurement_flag::kUnsettled | measurement_flag::kMerged;
      if ((settled.flags & kNot) == 0U && std::isfinite(settled.flux)) {
        star.flux = settled.flux;
        star.x = settled.position.x;
        star.y = settled.position.y;
        c.covariance = settled.covariance;
      } else {
        flags |= measurement_flag::kUnsettled;
      }
    }
    const double error = std::sqrt(c.covariance[0] * (1.0 + hidden.excess(star.flux)));
    if (c.degenerate || !(star.flux >= settings.threshold * error)) continue;
    SourceMeasurement s;
    s.id = fmt::format("{}", sources.size());
    s.x = area.x0 + star.x;
    s.y = area.y0 + star.y;
    s.ra = kNaN;
    s.dec = kNaN;
    if (sky != nullptr) {
      const SkyPosition direction = sky->to_sky({s.x, s.y});
      s.ra = direction.ra;
      s.dec = direction.dec;
    }
    s.flux = star.flux;
    s.flux_err = std::hypot(error, settings.psf_error * star.flux);
    s.snr = star.flux / s.flux_err;
    s.background = field.sky_at(star.x, star.y);
    s.chi2 = core_chi2(field, star, reach.core());
    s.flags = flags | detail::pixel_flags_around(frame, {area.x0 + star.x, area.y0 + star.y}, reach.core());
    s.mag = kNaN;
    s.mag_err = kNaN;
    if (const auto mag = magnitude_of(Electrons(s.flux) / frame.header.exposure_time, settings.zero_point)) {
      s.mag = mag->value();
      s.mag_err = magnitude_error(s.snr).value();
    }
    sources.push_back(std::move(s));
  }
  return sources;
}

}  // namespace astroid
