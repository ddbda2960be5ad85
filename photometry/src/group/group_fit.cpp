#include "astroid/photometry/group_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"
#include "field/star_stamps.hpp"
#include "group/group_problem.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kLargestStamp = 40;  // px, half-side
constexpr double kUntold = 1.0;    // FWHM, within which a star whose error exceeds its flux is another's

// Stars that are fitted, each standing for one or more of those that were given.
struct Member {
  std::vector<std::size_t> given;
  PixelPosition place{0.0, 0.0};
  double flux = 0.0;
};

class Fitter {
 public:
  Fitter(const GroupPixels& pixels, const PixelPsf& psf, std::span<const GroupStar> stars,
         const GroupFitSettings& settings)
      : pixels_(pixels),
        psf_(psf),
        settings_(settings),
        reach_(psf, {pixels.box.x0 + 0.5 * pixels.box.nx, pixels.box.y0 + 0.5 * pixels.box.ny}, kLargestStamp),
        usable_(pixels.usable) {
    ASTROID_CHECK_EQ(pixels.electrons.size(), pixels.box.size());
    ASTROID_CHECK_EQ(pixels.variance.size(), pixels.box.size());
    ASTROID_CHECK_EQ(pixels.usable.size(), pixels.box.size());
    fit_.stars.resize(stars.size());
    for (std::size_t k = 0; k < usable_.size(); ++k) {
      const bool good =
          std::isfinite(pixels.electrons[k]) && std::isfinite(pixels.variance[k]) && pixels.variance[k] > 0.0;
      usable_[k] = usable_[k] != 0 && good ? 1 : 0;
    }
    for (std::size_t i = 0; i < stars.size(); ++i) {
      FittedStar& star = fit_.stars[i];
      star.position = stars[i].position;
      star.flux = kNaN;
      star.covariance.fill(kNaN);
      const bool inside = stars[i].position.x > pixels.box.x0 - 1.0 && stars[i].position.x < pixels.box.x1() &&
                          stars[i].position.y > pixels.box.y0 - 1.0 && stars[i].position.y < pixels.box.y1();
      if (inside) {
        members_.push_back({{i}, stars[i].position, stars[i].flux});
      } else {
        star.flags |= measurement_flag::kOutside;
      }
    }
  }

  GroupFit run() {
    merge_near(settings_.merge_distance * reach_.fwhm());
    while (!members_.empty()) {
      drop_unseen();
      if (members_.empty()) break;
      fit_once();
      if (merge_near(settings_.merge_distance * reach_.fwhm())) continue;
      if (merge_untold()) continue;
      report();
      break;
    }
    return std::move(fit_);
  }

 private:
  [[nodiscard]] bool near(const Member& member, std::size_t k, double fwhms) const {
    const int x = pixels_.box.x0 + static_cast<int>(k % static_cast<std::size_t>(pixels_.box.nx));
    const int y = pixels_.box.y0 + static_cast<int>(k / static_cast<std::size_t>(pixels_.box.nx));
    const double radius = std::max(1.5, fwhms * reach_.fwhm());
    return std::hypot(x - member.place.x, y - member.place.y) <= radius;
  }

  [[nodiscard]] std::size_t count_usable() const {
    return static_cast<std::size_t>(std::ranges::count_if(usable_, [](char c) { return c != 0; }));
  }

  // Stars without enough pixels of their own to be told.
  void drop_unseen() {
    constexpr double kWings = 2.0;  // FWHM: a star whose core is saturated is told by them
    constexpr std::size_t kLeastPixels = 6;
    std::erase_if(members_, [&](const Member& m) {
      std::size_t seen = 0;
      for (std::size_t k = 0; k < usable_.size(); ++k) seen += usable_[k] != 0 && near(m, k, kWings) ? 1 : 0;
      if (seen >= kLeastPixels) return false;
      for (const std::size_t i : m.given) fit_.stars[i].flags |= measurement_flag::kBadPixel;
      return true;
    });
    const std::size_t unknowns = 3 * members_.size() + 1;
    if (count_usable() > unknowns) return;
    for (const Member& m : members_)
      for (const std::size_t i : m.given) fit_.stars[i].flags |= measurement_flag::kBadPixel;
    members_.clear();
  }

  void join(std::size_t a, std::size_t b) {
    Member& first = members_[a];
    Member& second = members_[b];
    const double f = std::max(first.flux, 0.0);
    const double g = std::max(second.flux, 0.0);
    const double share = f + g > 0.0 ? g / (f + g) : 0.5;
    first.place.x += share * (second.place.x - first.place.x);
    first.place.y += share * (second.place.y - first.place.y);
    // The brighter one names both.
    if (second.flux > first.flux) std::swap(first.given, second.given);
    first.given.insert(first.given.end(), second.given.begin(), second.given.end());
    first.flux += second.flux;
    members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(b));
  }

  bool merge_near(double least) {
    bool any = false;
    for (bool again = true; again;) {
      again = false;
      for (std::size_t a = 0; a < members_.size() && !again; ++a)
        for (std::size_t b = a + 1; b < members_.size() && !again; ++b) {
          const double d =
              std::hypot(members_[a].place.x - members_[b].place.x, members_[a].place.y - members_[b].place.y);
          if (d < least || d == 0.0) {
            join(a, b);
            any = again = true;
          }
        }
    }
    return any;
  }

  // Joins the nearest two of which one cannot be told from the other.
  bool merge_untold() {
    std::optional<std::pair<std::size_t, std::size_t>> pair;
    double nearest = kUntold * reach_.fwhm();
    for (std::size_t a = 0; a < members_.size(); ++a)
      for (std::size_t b = a + 1; b < members_.size(); ++b) {
        const double d =
            std::hypot(members_[a].place.x - members_[b].place.x, members_[a].place.y - members_[b].place.y);
        const auto untold = [&](std::size_t i) {
          return !covariance_.known || !(std::sqrt(covariance_.stars[i][0]) < members_[i].flux);
        };
        if (d < nearest && (untold(a) || untold(b))) {
          nearest = d;
          pair = {a, b};
        }
      }
    if (!pair) return false;
    join(pair->first, pair->second);
    return true;
  }

  // Model of the stars, and the variance with their photons.
  void render(const detail::GroupParameters& p) {
    light_.assign(pixels_.box.size(), 0.0);
    std::vector<double> stamp(pixels_.box.size());
    for (std::size_t i = 0; i < p.flux.size(); ++i) {
      psf_.integrate({p.place[i][0], p.place[i][1]}, pixels_.box, stamp);
      for (std::size_t k = 0; k < stamp.size(); ++k) light_[k] += p.flux[i] * stamp[k];
    }
    variance_.resize(light_.size());
    for (std::size_t k = 0; k < light_.size(); ++k)
      variance_[k] = usable_[k] != 0 ? pixels_.variance[k] + std::max(0.0, light_[k] + p.background) : 1.0;
  }

  void doubt_light() {
    for (std::size_t k = 0; k < light_.size(); ++k) {
      const double doubt = settings_.psf_doubt * light_[k];
      variance_[k] += doubt * doubt;
    }
  }

  void fit_once() {
    detail::GroupParameters p;
    bool known = true;
    for (const Member& m : members_) {
      known = known && m.flux > 0.0 && std::isfinite(m.flux);
      p.flux.push_back(m.flux);
      p.place.push_back({m.place.x, m.place.y});
    }
    detail::GroupSolve solve{.positions = false,
                             .background = settings_.fit_background,
                             .outlier = settings_.outlier,
                             .most_shift = std::max(1.0, reach_.fwhm()),
                             .most_iterations = settings_.most_iterations};
    std::vector<char> use = usable_;
    if (!known) {
      // Fluxes at the places given follow at once, with the noise of the sky alone.
      std::ranges::fill(p.flux, 0.0);
      render(p);
      (void)detail::solve_group(pixels_, variance_, use, psf_, solve, p);
    }
    solve.positions = settings_.fit_positions;
    const std::vector<std::array<double, 2>> start = p.place;
    // First a fit that a cosmic ray does not pull, to see which pixels are its.
    constexpr int kRobustPasses = 2;
    solve.robust = true;
    for (int pass = 0; pass < kRobustPasses; ++pass) {
      render(p);
      doubt_light();
      (void)detail::solve_group(pixels_, variance_, use, psf_, solve, p);
    }
    render(p);
    doubt_light();
    outlier_.assign(use.size(), 0);
    fit_.outliers = 0;
    for (std::size_t k = 0; k < use.size(); ++k) {
      if (use[k] == 0) continue;
      const double r = pixels_.electrons[k] - light_[k] - p.background;
      if (!(r * r > settings_.outlier * settings_.outlier * variance_[k])) continue;
      outlier_[k] = 1;
      use[k] = 0;
      ++fit_.outliers;
    }
    solve.robust = false;
    constexpr int kPasses = 3;  // the variance follows the model
    for (int pass = 0; pass < kPasses; ++pass) {
      render(p);
      converged_ = detail::solve_group(pixels_, variance_, use, psf_, solve, p);
    }
    render(p);
    covariance_ = detail::group_covariance(pixels_, variance_, use, psf_, solve, p);
    double chi2 = 0.0;
    std::size_t used = 0;
    for (std::size_t k = 0; k < use.size(); ++k) {
      if (use[k] == 0) continue;
      const double r = pixels_.electrons[k] - light_[k] - p.background;
      chi2 += r * r / variance_[k];
      ++used;
    }
    const std::size_t unknowns = (settings_.fit_positions ? 3 : 1) * p.flux.size() + (settings_.fit_background ? 1 : 0);
    fit_.chi2 = used > unknowns ? chi2 / static_cast<double>(used - unknowns) : kNaN;
    fit_.background = p.background;
    fit_.background_error = settings_.fit_background && covariance_.known ? std::sqrt(covariance_.background) : kNaN;
    ran_.assign(members_.size(), 0);
    constexpr double kAtBound = 0.99;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      members_[i].flux = p.flux[i];
      members_[i].place = {p.place[i][0], p.place[i][1]};
      for (std::size_t axis = 0; axis < 2; ++axis)
        if (std::abs(p.place[i][axis] - start[i][axis]) > kAtBound * solve.most_shift) ran_[i] = 1;
    }
  }

  void report() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Member& m = members_[i];
      std::uint32_t flags = m.given.size() > 1 ? measurement_flag::kMerged : 0U;
      if (!converged_ || !covariance_.known || ran_[i] != 0 || !std::isfinite(m.flux))
        flags |= measurement_flag::kUnsettled;
      for (std::size_t k = 0; k < outlier_.size(); ++k) {
        if (outlier_[k] != 0 && near(m, k, 1.0)) flags |= measurement_flag::kOutlier;
        if (usable_[k] == 0 && near(m, k, 1.0)) flags |= measurement_flag::kBadPixel;
      }
      for (const std::size_t g : m.given) {
        fit_.stars[g].position = m.place;
        fit_.stars[g].flags |= flags;
      }
      FittedStar& star = fit_.stars[m.given.front()];
      star.flux = m.flux;
      if (covariance_.known) star.covariance = covariance_.stars[i];
    }
  }

  const GroupPixels& pixels_;
  const PixelPsf& psf_;
  const GroupFitSettings& settings_;
  detail::PsfReach reach_;
  std::vector<char> usable_;
  std::vector<char> outlier_;
  std::vector<char> ran_;
  std::vector<Member> members_;
  std::vector<double> light_;
  std::vector<double> variance_;
  detail::GroupCovariance covariance_;
  bool converged_ = false;
  GroupFit fit_;
};

}  // namespace

GroupFit fit_group(const GroupPixels& pixels, const PixelPsf& psf, std::span<const GroupStar> stars,
                   const GroupFitSettings& settings) {
  if (pixels.box.nx <= 0 || pixels.box.ny <= 0) {
    GroupFit none;
    for (const GroupStar& star : stars)
      none.stars.push_back({star.position, kNaN, {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN}, measurement_flag::kOutside});
    return none;
  }
  return Fitter(pixels, psf, stars, settings).run();
}

}  // namespace astroid
