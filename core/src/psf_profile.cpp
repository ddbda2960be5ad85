#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"
#include "bessel.hpp"
#include "circular_profile.hpp"
#include "flux_spline.hpp"
#include "motion_nodes.hpp"
#include "phase_library.hpp"
#include "psf_diffusion.hpp"

namespace astroid {

namespace {

constexpr int kCore = 8;                  // px; farther out the light is so thin that a coarser library does
constexpr int kFewestPhases = 4;          // where the search begins
constexpr int kMostCorePhases = 128;      // 47 MB
constexpr int kMostWingPhases = 32;       // 300 MB at a reach of 90 px
constexpr double kDiffusionMargin = 6.5;  // sigmas of diffusion that a table is made wider by, before it is cut
constexpr std::size_t kMostCorePixels = 4UL * kCore * kCore;

/// The middle (2 half_width)² px of a table.
PsfTable cropped(const PsfTable& table, int half_width) {
  const int half = static_cast<int>(table.samples_per_pixel) * half_width;
  const int margin = table.samples.nx() / 2 - half;
  PsfTable part;
  part.samples = Image<double, unit::Relative>(2 * half, 2 * half);
  part.samples_per_pixel = table.samples_per_pixel;
  part.centre_x = part.centre_y = half - 0.5;
  for (int y = 0; y < 2 * half; ++y)
    for (int x = 0; x < 2 * half; ++x) part.samples.at(x, y) = table.samples.at(x + margin, y + margin);
  return part;
}

/// A library of a profile out to a square, in fractions of all the star's light.
struct ScaledLibrary {
  double enclosed;  ///< fraction of the star's light in the square
  detail::FluxSpline spline;
  detail::PhaseLibrary library;

  /// The edges of pixels of all phases, and of stars midway between them, are edges of the table's samples: there the
  /// spline is exact.
  static ScaledLibrary make(const detail::CircularProfile& profile, double diffusion, int half_width, int phases) {
    const int margin = static_cast<int>(std::ceil(kDiffusionMargin * diffusion));
    PsfTable table = detail::flux_table(profile, 2 * phases, half_width + margin);
    if (diffusion > 0.0) table = cropped(detail::diffuse(table, diffusion, 1), half_width);
    double sum = 0.0;
    for (const double sample : table.samples.pixels()) sum += sample;
    detail::FluxSpline spline(table);
    detail::PhaseLibrary library(spline, phases);
    return {sum, std::move(spline), std::move(library)};
  }
};

/// A core of many phases, and wings of fewer out to `reach`.
class ProfilePsf final : public PixelPsf {
 public:
  ProfilePsf(const detail::CircularProfile& profile, double diffusion, int reach, double accuracy, int phases)
      : name_(profile.name), reach_(reach), core_(make_core(profile, diffusion, reach, accuracy, phases)) {
    core_error_ = core_.library.measured_error(core_.spline);
    if (reach_ > kCore) make_wings(profile, diffusion, accuracy);
  }

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    if (box.empty() || !usable_or_nan(centre, fractions)) return;
    if (!wings_) {
      core_.library.integrate(centre, box, fractions);
      scale(core_.enclosed, fractions);
      return;
    }
    wings_->library.integrate(centre, box, fractions);
    scale(wings_->enclosed, fractions);
    const Rectangle inner = intersect(box, core_box(centre));
    std::array<double, kMostCorePixels> part{};
    core_.library.integrate(centre, inner, std::span(part).first(inner.size()));
    replace(part, inner, box, fractions);
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    if (box.empty() || !usable_or_nan(centre, dpdx) || !usable_or_nan(centre, dpdy)) {
      std::ranges::copy(dpdx, dpdy.begin());
      return;
    }
    const ScaledLibrary& outer = wings_ ? *wings_ : core_;
    outer.library.integrate_gradient(centre, box, dpdx, dpdy);
    scale(outer.enclosed, dpdx);
    scale(outer.enclosed, dpdy);
    if (!wings_) return;
    const Rectangle inner = intersect(box, core_box(centre));
    std::array<double, kMostCorePixels> along_x{};
    std::array<double, kMostCorePixels> along_y{};
    core_.library.integrate_gradient(centre, inner, std::span(along_x).first(inner.size()),
                                     std::span(along_y).first(inner.size()));
    replace(along_x, inner, box, dpdx);
    replace(along_y, inner, box, dpdy);
  }

  void add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                std::vector<double>& /*scratch*/) const override {
    const Rectangle box = intersect(stamp_box(star.centre, star.half_width), image.area());
    if (box.empty()) return;
    if (!star.broadened) {
      add(star.centre, star.electrons, box, image);
      return;
    }
    for (const detail::MotionNode& node : detail::motion_nodes(star.motion))
      add({star.centre.x + node.shift.dx, star.centre.y + node.shift.dy}, star.electrons * node.weight, box, image);
  }

  // Of the light that there is: what falls beyond the reach is not in the image, whatever the stamp.
  [[nodiscard]] double stamp_half_width(double lost) const override {
    const ScaledLibrary& outer = wings_ ? *wings_ : core_;
    const double step = 0.5 / outer.spline.samples_per_pixel();
    double r = reach_;
    while (r > step && outer.enclosed * (1.0 - outer.spline.flux({step - r, step - r}, {r - step, r - step})) < lost)
      r -= step;
    return r;
  }

  [[nodiscard]] double approximation_error() const override { return core_error_ + wing_error_; }

  [[nodiscard]] std::string description() const override {
    const double beyond = 1.0 - (wings_ ? *wings_ : core_).enclosed;
    return fmt::format(
        "{}, {:.2g} of the light beyond {} px left out; library of {} x {} phases, aperture flux within {:.2g}", name_,
        beyond, reach_, core_.library.phases(), core_.library.phases(), approximation_error());
  }

 private:
  static ScaledLibrary make_core(const detail::CircularProfile& profile, double diffusion, int reach, double accuracy,
                                 int phases) {
    const int half_width = std::min(reach, kCore);
    if (phases > 0) return ScaledLibrary::make(profile, diffusion, half_width, std::min(phases, kMostCorePhases));
    int n = kFewestPhases;
    ScaledLibrary core = ScaledLibrary::make(profile, diffusion, half_width, n);
    while (2 * n <= kMostCorePhases && core.library.measured_error(core.spline) > accuracy) {
      n *= 2;
      core = ScaledLibrary::make(profile, diffusion, half_width, n);
    }
    return core;
  }

  void make_wings(const detail::CircularProfile& profile, double diffusion, double accuracy) {
    for (int n = kFewestPhases;; n *= 2) {
      wings_.emplace(ScaledLibrary::make(profile, diffusion, reach_, n));
      wing_error_ = measured_wing_error();
      if (wing_error_ <= accuracy || 2 * n > kMostWingPhases) return;
    }
  }

  /// Largest error of the light in 3 x 3 px next to the core, of stars midway between phases, as a fraction of all the
  /// star's light.
  [[nodiscard]] double measured_wing_error() const {
    constexpr int kSide = 3;
    std::array<double, static_cast<std::size_t>(kSide * kSide)> fractions{};
    const double midway = 0.5 / wings_->library.phases();
    double worst = 0.0;
    for (int p = 0; p < wings_->library.phases(); ++p) {
      const PixelPosition star{midway * (2 * p + 1), midway};
      for (const auto& [x, y] :
           {std::pair{kCore, -1}, std::pair{kCore, kCore}, std::pair{-1, kCore}, std::pair{kCore, 3}}) {
        wings_->library.integrate(star, {x, y, kSide, kSide}, fractions);
        double flux = 0.0;
        for (const double fraction : fractions) flux += fraction;
        const double exact = wings_->spline.flux({x - 0.5 - star.x, y - 0.5 - star.y},
                                                 {x + kSide - 0.5 - star.x, y + kSide - 0.5 - star.y});
        worst = std::max(worst, wings_->enclosed * std::abs(flux - exact));
      }
    }
    return worst;
  }

  /// The pixels that the core's library has wholly, at every phase that the interpolation uses.
  static Rectangle core_box(PixelPosition centre) {
    const int x = static_cast<int>(std::floor(centre.x));
    const int y = static_cast<int>(std::floor(centre.y));
    return {x - kCore + 2, y - kCore + 2, 2 * kCore - 2, 2 * kCore - 2};
  }

  void add(PixelPosition centre, double electrons, Rectangle box,
           const ImageView<double, unit::ExpectedElectrons>& image) const {
    if (!wings_) {
      core_.library.add(centre, electrons * core_.enclosed, box, image);
      return;
    }
    const Rectangle inner = intersect(box, core_box(centre));
    if (inner.empty()) {
      wings_->library.add(centre, electrons * wings_->enclosed, box, image);
      return;
    }
    core_.library.add(centre, electrons * core_.enclosed, inner, image);
    const int below = inner.y0 - box.y0;
    const int left = inner.x0 - box.x0;
    const std::array<Rectangle, 4> around = {{{box.x0, box.y0, box.nx, below},
                                              {box.x0, inner.y1(), box.nx, box.y1() - inner.y1()},
                                              {box.x0, inner.y0, left, inner.ny},
                                              {inner.x1(), inner.y0, box.x1() - inner.x1(), inner.ny}}};
    for (const Rectangle& part : around)
      if (!part.empty()) wings_->library.add(centre, electrons * wings_->enclosed, part, image);
  }

  static bool usable_or_nan(PixelPosition p, std::span<double> values) {
    constexpr double kFarthest = 1e9;  // px; what an int can count, with room for the library
    if (std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest) return true;
    std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
    return false;
  }

  static void scale(double factor, std::span<double> values) {
    for (double& value : values) value *= factor;
  }

  void replace(std::span<const double> part, Rectangle inner, Rectangle box, std::span<double> values) const {
    const double* from = part.data();
    for (int y = inner.y0; y < inner.y1(); ++y) {
      double* to = values.data() + static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx) +
                   static_cast<std::size_t>(inner.x0 - box.x0);
      for (int i = 0; i < inner.nx; ++i) to[i] = core_.enclosed * from[i];
      from += inner.nx;
    }
  }

  std::string name_;
  int reach_;
  ScaledLibrary core_;
  std::optional<ScaledLibrary> wings_;
  double core_error_ = 0.0;
  double wing_error_ = 0.0;
};

void require(bool holds, const char* parameter, double value, const char* expected, std::vector<Problem>& problems) {
  if (holds && std::isfinite(value)) return;
  problems.push_back({.parameter = parameter,
                      .value = fmt::format("{}", value),
                      .expected = expected,
                      .message = "the PSF cannot be made"});
}

void require_wings(const PsfWings& wings, std::vector<Problem>& problems) {
  require(wings.reach >= 2 && wings.reach <= PsfWings::kLongestReach, "PSF/Reach", wings.reach, "2 .. 90 px", problems);
  require(wings.diffusion >= 0.0 && wings.diffusion <= 3.0, "PSF/ChargeDiffusion", wings.diffusion, "0 .. 3 px",
          problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

std::shared_ptr<const PixelPsf> make_moffat_psf(double fwhm, double beta, const PsfWings& wings, double accuracy,
                                                int phases) {
  std::vector<Problem> problems;
  require(fwhm >= 0.2 && fwhm <= 20.0, "PSF/FWHM", fwhm, "0.2 .. 20 px", problems);
  require(beta > 1.0 && beta <= 100.0, "PSF/Beta", beta, "more than 1, at most 100", problems);
  require_wings(wings, problems);
  const double alpha = 0.5 * fwhm / det::sqrt(det::expm1(det::log(2.0) / beta));
  const double peak = (beta - 1.0) / (kPi * alpha * alpha);
  const double per_alpha2 = 1.0 / (alpha * alpha);
  const detail::CircularProfile profile{
      .density = [=](double r2) { return peak * det::exp(-beta * det::log1p(r2 * per_alpha2)); },
      .scale = 0.5 * fwhm,
      .name = fmt::format("Moffat of FWHM {} px, beta {}", fwhm, beta)};
  return std::make_shared<const ProfilePsf>(profile, wings.diffusion, wings.reach, accuracy, phases);
}

std::shared_ptr<const PixelPsf> make_airy_psf(double lambda_over_d, double obscuration, const PsfWings& wings,
                                              double accuracy, int phases) {
  std::vector<Problem> problems;
  require(lambda_over_d >= 0.3 && lambda_over_d <= 20.0, "PSF/LambdaOverD", lambda_over_d, "0.3 .. 20 px", problems);
  require(obscuration >= 0.0 && obscuration < 1.0, "PSF/Obscuration", obscuration, "0 to less than 1", problems);
  require_wings(wings, problems);
  const double e2 = obscuration * obscuration;
  // The peak is the area of the aperture in units of (lambda / px)²; the amplitude that of a disc less its centre.
  const double peak = 0.25 * kPi * (1.0 - e2) / (lambda_over_d * lambda_over_d);
  const double per_px = kPi / lambda_over_d;
  const detail::CircularProfile profile{
      .density =
          [=](double r2) {
            const double v = per_px * det::sqrt(r2);
            const double full = detail::jinc(v);
            const double amplitude = e2 > 0.0 ? (full - e2 * detail::jinc(obscuration * v)) / (1.0 - e2) : full;
            return peak * amplitude * amplitude;
          },
      .scale = 0.5 * lambda_over_d,
      .name = fmt::format("Airy pattern of lambda/D {} px, obscuration {}", lambda_over_d, obscuration)};
  return std::make_shared<const ProfilePsf>(profile, wings.diffusion, wings.reach, accuracy, phases);
}

}  // namespace astroid
