#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"
#include "circular_profile.hpp"
#include "flux_spline.hpp"
#include "motion_nodes.hpp"
#include "phase_library.hpp"

namespace astroid {

namespace {

constexpr int kCore = 8;                  // px; farther out the light is so thin that a coarser library does
constexpr int kFewestPhases = 4;          // where the search begins
constexpr int kMostCorePhases = 128;      // 47 MB
constexpr int kMostWingPhases = 64;       // of a library of at most
constexpr double kMostWingBytes = 300e6;  // which leaves 32 phases at a reach of 90 px, and 64 at 43 px
constexpr std::size_t kMostCorePixels = 4UL * kCore * kCore;

/// A library of a profile out to a square, in fractions of all the star's light.
struct ScaledLibrary {
  double enclosed;  ///< fraction of the star's light in the square
  detail::FluxSpline spline;
  detail::PhaseLibrary library;

  /// The edges of pixels of all phases are edges of the table's samples: there the spline is exact. With two samples to
  /// a phase it is so for stars midway between them, which errors are judged by.
  /// @param samples  per px at least: what the edges of cells within the pixel, which lie anywhere, ask for
  static ScaledLibrary make(const detail::CircularProfile& profile, int half_width, int phases, int per_phase,
                            const PixelResponse& response, int samples = 0) {
    const int least = per_phase * phases;
    const int parts = std::max(1, (samples + least - 1) / least);
    const PsfTable table = detail::flux_table(profile, least * parts, half_width);
    double sum = 0.0;
    for (const double sample : table.samples.pixels()) sum += sample;
    detail::FluxSpline spline(table);
    detail::PhaseLibrary library(spline, phases, response);
    return {sum, std::move(spline), std::move(library)};
  }
};

/// A core of many phases, and wings of fewer out to `reach`.
class ProfilePsf final : public PixelPsf {
 public:
  ProfilePsf(const detail::CircularProfile& profile, const PsfWings& wings, const PsfAccuracy& accuracy, int phases,
             const PixelResponse& response)
      : name_(profile.name),
        reach_(wings.reach),
        depth_(response.depth()),
        core_(make_core(profile, wings, accuracy, phases, response)) {
    core_error_ = core_error(core_, reach_, accuracy.least_light);
    if (reach_ > kCore) make_wings(profile, accuracy, response);
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

  [[nodiscard]] double approximation_error() const override { return std::max(core_error_, wing_error_); }

  [[nodiscard]] std::string description() const override {
    const double beyond = 1.0 - (wings_ ? *wings_ : core_).enclosed;
    return fmt::format(
        "{}, {:.2g} of the light beyond {} px left out{}; library of {} x {} phases, aperture flux within {:.2g}",
        name_, beyond, reach_, depth_ > 0.0 ? ", weighted with the response within the pixel" : "",
        core_.library.phases(), core_.library.phases(), approximation_error());
  }

 private:
  /// Of the pixels that are taken from the core.
  static double core_error(const ScaledLibrary& core, int reach, double least) {
    return core.library.measured_error(core.spline,
                                       {.least = least / core.enclosed,
                                        .outer = reach > kCore ? core_box({0.5, 0.5}) : core.library.interior(),
                                        .hole = {}});
  }

  static ScaledLibrary make_core(const detail::CircularProfile& profile, const PsfWings& wings,
                                 const PsfAccuracy& accuracy, int phases, const PixelResponse& response) {
    const int half_width = std::min(wings.reach, kCore);
    // The spline leaves 4e-3 / (samples per sigma)⁴ of the light between the edges of samples, of which the response
    // sees its own depth; sigma is 0.85 of the scale.
    constexpr double kSplineError = 4e-3;
    constexpr double kSplineShare = 0.1;
    constexpr double kSigma = 0.85;
    const double width = kSigma * profile.scale;
    const double per_sigma = det::sqrt(det::sqrt(kSplineError * response.depth() / (kSplineShare * accuracy.relative)));
    const int samples = static_cast<int>(std::ceil(per_sigma / width));
    const auto make = [&](int n) { return ScaledLibrary::make(profile, half_width, n, 2, response, samples); };
    if (phases > 0) return make(std::min(phases, kMostCorePhases));
    int n = kFewestPhases;
    ScaledLibrary core = make(n);
    while (2 * n <= kMostCorePhases && core_error(core, wings.reach, accuracy.least_light) > accuracy.relative) {
      n *= 2;
      core = make(n);
    }
    return core;
  }

  void make_wings(const detail::CircularProfile& profile, const PsfAccuracy& accuracy, const PixelResponse& response) {
    const double pixels = 4.0 * reach_ * reach_;
    for (int n = kFewestPhases;; n *= 2) {
      // Between the edges of samples the spline errs by a ninth of what four points between phases do, the same way.
      constexpr double kSplinePart = 9.0 / 8.0;
      wings_.emplace(ScaledLibrary::make(profile, reach_, n, 1, response));
      // Of a star midway between any phases the core has at least these pixels.
      wing_error_ = kSplinePart *
                    wings_->library.measured_error(wings_->spline, {.least = accuracy.least_light / wings_->enclosed,
                                                                    .outer = wings_->library.interior(),
                                                                    .hole = core_box({0.5, 0.5})});
      const double next = sizeof(double) * pixels * 4.0 * n * n;
      if (wing_error_ <= accuracy.relative || 2 * n > kMostWingPhases || next > kMostWingBytes) return;
    }
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
  double depth_;  // of the response
  ScaledLibrary core_;
  std::optional<ScaledLibrary> wings_;
  double core_error_ = 0.0;
  double wing_error_ = 0.0;
};

}  // namespace

std::shared_ptr<const PixelPsf> make_moffat_psf(double fwhm, double beta, const PsfWings& wings,
                                                const PsfAccuracy& accuracy, int phases,
                                                const PixelResponse& response) {
  return std::make_shared<const ProfilePsf>(detail::as_imaged(detail::moffat_profile(fwhm, beta, wings), wings), wings,
                                            accuracy, phases, response);
}

std::shared_ptr<const PixelPsf> make_airy_psf(double lambda_over_d, double obscuration, const PsfWings& wings,
                                              const PsfAccuracy& accuracy, int phases, const PixelResponse& response) {
  return std::make_shared<const ProfilePsf>(
      detail::as_imaged(detail::airy_profile(lambda_over_d, obscuration, wings), wings), wings, accuracy, phases,
      response);
}

}  // namespace astroid
