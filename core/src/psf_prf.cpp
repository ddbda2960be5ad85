#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/psf.hpp"
#include "flux_spline.hpp"
#include "motion_nodes.hpp"
#include "phase_library.hpp"

namespace astroid {

namespace {

constexpr int kFewestPhases = 4;                        // where the search begins
constexpr double kMostBytes = 256.0 * 1024.0 * 1024.0;  // of a library; a stamp of 45 px has 128 phases then

double error_of(const detail::PhaseLibrary& library, const detail::FluxSpline& spline, double least) {
  return library.measured_error(spline, {.least = least, .outer = library.interior(), .hole = {}});
}

int refine(const detail::FluxSpline& spline, const PsfAccuracy& accuracy, const PixelResponse& response) {
  int phases = kFewestPhases;
  while (detail::PhaseLibrary::bytes(spline, 2 * phases) <= kMostBytes &&
         error_of(detail::PhaseLibrary(spline, phases, response), spline, accuracy.least_light) > accuracy.relative) {
    phases *= 2;
  }
  return phases;
}

class PrfPsf final : public PixelPsf {
 public:
  PrfPsf(detail::FluxSpline spline, double least, int phases, const PixelResponse& response)
      : spline_(std::move(spline)),
        library_(spline_, phases, response),
        error_(error_of(library_, spline_, least)),
        depth_(response.depth()) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    if (box.empty()) return;
    if (!is_usable(centre)) {
      std::ranges::fill(fractions, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    library_.integrate(centre, box, fractions);
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    if (box.empty()) return;
    if (!is_usable(centre)) {
      std::ranges::fill(dpdx, std::numeric_limits<double>::quiet_NaN());
      std::ranges::fill(dpdy, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    library_.integrate_gradient(centre, box, dpdx, dpdy);
  }

  void add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                std::vector<double>& /*scratch*/) const override {
    const Rectangle box = intersect(stamp_box(star.centre, star.half_width), image.area());
    if (box.empty()) return;
    if (!star.broadened) {
      library_.add(star.centre, star.electrons, box, image);
      return;
    }
    for (const detail::MotionNode& node : detail::motion_nodes(star.motion))
      library_.add({star.centre.x + node.shift.dx, star.centre.y + node.shift.dy}, star.electrons * node.weight, box,
                   image);
  }

  // From the outside inwards, since a table may have negative samples: the first square that loses too much ends it.
  [[nodiscard]] double stamp_half_width(double lost) const override {
    const double step = 0.5 / spline_.samples_per_pixel();
    const PixelPosition lower = spline_.lower();
    const PixelPosition upper = spline_.upper();
    const double reach = std::max({-lower.x, -lower.y, upper.x, upper.y});
    double r = std::max(reach, 0.0);
    while (r > step && 1.0 - spline_.flux({step - r, step - r}, {r - step, r - step}) < lost) r -= step;
    return r;
  }

  [[nodiscard]] double approximation_error() const override { return error_; }

  [[nodiscard]] std::string description() const override {
    return fmt::format("table of {} x {} samples, {} per px{}; library of {} x {} phases, aperture flux within {:.2g}",
                       spline_.nx(), spline_.ny(), spline_.samples_per_pixel(),
                       depth_ > 0.0 ? ", weighted with the response within the pixel" : "", library_.phases(),
                       library_.phases(), error_);
  }

 private:
  // Positions whose pixel an int can count, with room for the table.
  static bool is_usable(PixelPosition p) {
    constexpr double kFarthest = 1e9;
    return std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest;
  }

  detail::FluxSpline spline_;
  detail::PhaseLibrary library_;
  double error_;
  double depth_;  // of the response
};

}  // namespace

std::shared_ptr<const PixelPsf> make_prf_psf(const PsfTable& table, const PsfAccuracy& accuracy, int phases,
                                             const PixelResponse& response) {
  detail::FluxSpline spline(table);
  if (phases == 0) phases = refine(spline, accuracy, response);
  if (phases < 0 || detail::PhaseLibrary::bytes(spline, std::max(phases, 1)) > kMostBytes) {
    throw InputError(Problem{.parameter = "PSF/Phases",
                             .value = fmt::format("{}", phases),
                             .expected = "0, or a number whose library fits into 256 MiB",
                             .message = "a PSF library of so many phases cannot be made"});
  }
  return std::make_shared<const PrfPsf>(std::move(spline), accuracy.least_light, phases, response);
}

}  // namespace astroid
