#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"
#include "gaussian_profiles.hpp"
#include "gaussian_tail.hpp"
#include "vector/stamp_kernels.hpp"

namespace astroid {

namespace {

constexpr double kPointSigma = 1e-8;  // px; narrower than this the star is a point
constexpr double kRootTwo = 1.41421356237309504880168872420969808;
constexpr double kRootTwoPi = 2.50662827463100050241576528481104525;
constexpr int kChunk = 64;  // pixels per axis whose profiles are held on the stack at a time

using Profile = std::array<double, kChunk>;
using Edges = std::array<double, kChunk + 1>;

// What a point at `offset` px from the pixel's centre leaves in the pixel along one axis.
double point_fraction(double offset) {
  const double distance = std::abs(offset);
  if (distance < 0.5) return 1.0;
  return distance == 0.5 ? 0.5 : 0.0;
}

class GaussianPsf final : public PixelPsf {
 public:
  explicit GaussianPsf(double sigma)
      : sigma_(sigma), per_root_two_sigma_(1.0 / (kRootTwo * sigma)), tails_(detail::erfc_table()) {}

  /// With the table that add_star() is fast by.
  static std::shared_ptr<const GaussianPsf> with_profiles(double sigma) {
    auto psf = std::make_shared<GaussianPsf>(sigma);
    if (sigma >= detail::GaussianProfiles::kNarrowest && sigma <= detail::GaussianProfiles::kWidest)
      psf->profiles_.emplace(sigma);
    return psf;
  }

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    if (!is_finite(centre)) {
      std::ranges::fill(fractions, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    Profile x_profile;
    Profile y_profile;
    for (int x = 0; x < box.nx; x += kChunk) {
      const int nx = std::min(kChunk, box.nx - x);
      integrate_axis(centre.x, box.x0 + x, nx, x_profile);
      for (int y = 0; y < box.ny; y += kChunk) {
        const int ny = std::min(kChunk, box.ny - y);
        integrate_axis(centre.y, box.y0 + y, ny, y_profile);
        multiply({x, y, nx, ny}, box.nx, x_profile, y_profile, fractions);
      }
    }
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    if (!is_finite(centre)) {
      std::ranges::fill(dpdx, std::numeric_limits<double>::quiet_NaN());
      std::ranges::fill(dpdy, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    Profile x_profile;
    Profile x_slope;
    Profile y_profile;
    Profile y_slope;
    for (int x = 0; x < box.nx; x += kChunk) {
      const int nx = std::min(kChunk, box.nx - x);
      integrate_axis(centre.x, box.x0 + x, nx, x_profile);
      differentiate_axis(centre.x, box.x0 + x, nx, x_slope);
      for (int y = 0; y < box.ny; y += kChunk) {
        const int ny = std::min(kChunk, box.ny - y);
        integrate_axis(centre.y, box.y0 + y, ny, y_profile);
        differentiate_axis(centre.y, box.y0 + y, ny, y_slope);
        multiply({x, y, nx, ny}, box.nx, x_slope, y_profile, dpdx);
        multiply({x, y, nx, ny}, box.nx, x_profile, y_slope, dpdy);
      }
    }
  }

  void integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                           std::span<double> fractions, std::vector<double>& scratch) const override {
    const double sigma_x = det::sqrt(sigma_ * sigma_ + motion.sxx);
    const double sigma_y = det::sqrt(sigma_ * sigma_ + motion.syy);
    if (!is_finite(centre) || !(std::min(sigma_x, sigma_y) > kPointSigma)) {
      PixelPsf::integrate_broadened(centre, motion, box, fractions, scratch);
      return;
    }
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    const GaussianPsf along_x(sigma_x);
    const GaussianPsf along_y(sigma_y);
    Profile x_profile;
    Profile x_slope;
    Profile y_profile;
    Profile y_slope;
    for (int x = 0; x < box.nx; x += kChunk) {
      const int nx = std::min(kChunk, box.nx - x);
      along_x.integrate_axis(centre.x, box.x0 + x, nx, x_profile);
      along_x.differentiate_axis(centre.x, box.x0 + x, nx, x_slope);
      for (int y = 0; y < box.ny; y += kChunk) {
        const int ny = std::min(kChunk, box.ny - y);
        along_y.integrate_axis(centre.y, box.y0 + y, ny, y_profile);
        along_y.differentiate_axis(centre.y, box.y0 + y, ny, y_slope);
        multiply({x, y, nx, ny}, box.nx, x_profile, y_profile, fractions);
        // What the correlation of the two axes adds, first order in it: sxy d²p/dxdy.
        for (auto& slope : std::span(y_slope).first(static_cast<std::size_t>(ny))) slope *= motion.sxy;
        add_product({x, y, nx, ny}, box.nx, x_slope, y_slope, fractions);
      }
    }
  }

  void add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                std::vector<double>& scratch) const override {
    // The table's profiles are broadened to the second order of the variance: 0.3 (s²/sigma²)³ of the peak is left out.
    constexpr double kMostMotion = 5e-3;  // s²/sigma²
    const double largest = star.broadened ? std::max(star.motion.sxx, star.motion.syy) : 0.0;
    if (!profiles_ || largest > kMostMotion * sigma_ * sigma_) {
      PixelPsf::add_star(star, image, scratch);
      return;
    }
    Rectangle box = intersect(stamp_box(star.centre, star.half_width), image.area());
    if (box.empty()) return;
    const MotionCovariance motion = star.broadened ? star.motion : MotionCovariance{};
    detail::SeparableStamp stamp{.x = profiles_->axis(star.centre.x, motion.sxx),
                                 .y = profiles_->axis(star.centre.y, motion.syy),
                                 .electrons = star.electrons,
                                 .covariance = motion.sxy,
                                 .table_stride = profiles_->stride()};
    box = intersect(box, {stamp.x.first, stamp.y.first, stamp.x.size, stamp.y.size});
    if (box.empty()) return;
    if (motion.sxy != 0.0) {
      stamp.x_slope = profiles_->slope(star.centre.x);
      stamp.y_slope = profiles_->slope(star.centre.y);
      stamp.x_slope.rows += box.x0 - stamp.x.first;
      stamp.y_slope.rows += box.y0 - stamp.y.first;
    }
    stamp.x.rows += box.x0 - stamp.x.first;
    stamp.y.rows += box.y0 - stamp.y.first;
    detail::add_separable_stamp(stamp, detail::stamp_pixels(image, box));
  }

  // Outside a square of half-width r lies 1 - erf(q)^2 with q = r / (sqrt(2) sigma), so erfc(q) = lost / (1 + sqrt(1 -
  // lost)).
  [[nodiscard]] double stamp_half_width(double lost) const override {
    const double tail = lost / (1.0 + std::sqrt(1.0 - lost));
    double low = 0.0;
    double high = detail::kTailEnd;
    constexpr int kHalvings = 60;  // to the last bit of a double
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (det::erfc(middle) >= tail ? low : high) = middle;
    }
    return high * kRootTwo * sigma_;
  }

  [[nodiscard]] double approximation_error() const override { return 0.0; }

  [[nodiscard]] std::string description() const override {
    return fmt::format("Gaussian of sigma {} px, integrated over pixels exactly", sigma_);
  }

 private:
  static bool is_finite(PixelPosition p) { return std::isfinite(p.x) && std::isfinite(p.y); }

  // Distance of the lower edge of pixel `pixel` from the star, in units of sqrt(2) sigma.
  [[nodiscard]] double edge(double star, int pixel) const {
    return (static_cast<double>(pixel) - 0.5 - star) * per_root_two_sigma_;
  }

  void integrate_axis(double star, int first, int n, Profile& fractions) const {
    const auto count = static_cast<std::size_t>(n);
    if (sigma_ < kPointSigma) {
      for (std::size_t i = 0; i < count; ++i) fractions[i] = point_fraction(first + static_cast<int>(i) - star);
      return;
    }
    Edges distance;
    Edges tail;
    for (std::size_t i = 0; i <= count; ++i) {
      distance[i] = edge(star, first + static_cast<int>(i));
      tail[i] = detail::gaussian_tail(tails_, std::abs(distance[i]));
    }
    // Differences of the tail that both edges share keep their relative accuracy however far the star is.
    for (std::size_t i = 0; i < count; ++i) {
      if (distance[i] >= 0.0) {
        fractions[i] = 0.5 * (tail[i] - tail[i + 1]);
      } else if (distance[i + 1] <= 0.0) {
        fractions[i] = 0.5 * (tail[i + 1] - tail[i]);
      } else {
        fractions[i] = 1.0 - 0.5 * (tail[i] + tail[i + 1]);
      }
    }
  }

  // d/dx_star [Phi(b) - Phi(a)] = (phi(a) - phi(b)) / sigma with the densities phi at the pixel's lower and upper edge.
  void differentiate_axis(double star, int first, int n, Profile& slopes) const {
    const auto count = static_cast<std::size_t>(n);
    if (sigma_ < kPointSigma) {
      std::fill_n(slopes.begin(), n, 0.0);
      return;
    }
    const double scale = 1.0 / (kRootTwoPi * sigma_);
    double lower = density(edge(star, first));
    for (std::size_t i = 0; i < count; ++i) {
      const double upper = density(edge(star, first + static_cast<int>(i) + 1));
      slopes[i] = scale * (lower - upper);
      lower = upper;
    }
  }

  static double density(double distance) {
    return std::abs(distance) < detail::kTailEnd ? det::exp(-distance * distance) : 0.0;
  }

  static void multiply(Rectangle part, int row_length, const Profile& x_profile, const Profile& y_profile,
                       std::span<double> product) {
    const auto nx = static_cast<std::size_t>(part.nx);
    for (int j = 0; j < part.ny; ++j) {
      const double weight = y_profile[static_cast<std::size_t>(j)];
      const auto offset = static_cast<std::size_t>(part.y0 + j) * static_cast<std::size_t>(row_length) +
                          static_cast<std::size_t>(part.x0);
      double* row = product.data() + offset;
      for (std::size_t i = 0; i < nx; ++i) row[i] = weight * x_profile[i];
    }
  }

  static void add_product(Rectangle part, int row_length, const Profile& x_profile, const Profile& y_profile,
                          std::span<double> sum) {
    const auto nx = static_cast<std::size_t>(part.nx);
    for (int j = 0; j < part.ny; ++j) {
      const double weight = y_profile[static_cast<std::size_t>(j)];
      const auto offset = static_cast<std::size_t>(part.y0 + j) * static_cast<std::size_t>(row_length) +
                          static_cast<std::size_t>(part.x0);
      double* row = sum.data() + offset;
      for (std::size_t i = 0; i < nx; ++i) row[i] += weight * x_profile[i];
    }
  }

  double sigma_;
  double per_root_two_sigma_;
  const detail::ErfcTable& tails_;
  std::optional<detail::GaussianProfiles> profiles_;
};

}  // namespace

std::shared_ptr<const PixelPsf> make_gaussian_psf(double sigma) {
  if (!(sigma >= 0.0) || std::isinf(sigma)) {
    throw InputError(Problem{.parameter = "PSF/Sigma",
                             .value = fmt::format("{}", sigma),
                             .expected = "a finite number of pixels >= 0",
                             .message = "the width of the PSF is not usable"});
  }
  return GaussianPsf::with_profiles(sigma);
}

}  // namespace astroid
