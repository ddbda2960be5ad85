#include "astroid/photometry/group_photometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/photometry/estimator.hpp"
#include "field/star_stamps.hpp"
#include "group/friends.hpp"
#include "source_places.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kLargestStamp = 40;  // px, half-side
constexpr double kLink = 2.0;      // FWHM
constexpr std::size_t kMostStars = 10;
constexpr int kMostSweeps = 4;

class GroupMeasurer {
 public:
  GroupMeasurer(const Frame& frame, std::span<SourceMeasurement> sources, const GroupPhotometrySettings& settings)
      : frame_(frame),
        sources_(sources),
        settings_(settings),
        psf_(*settings.psf),
        area_(frame.pixels.layout().regions()[0]),
        reach_(psf_, {area_.x0 + 0.5 * area_.nx, area_.y0 + 0.5 * area_.ny}, kLargestStamp),
        light_(area_) {
    make_noise();
  }

  void run() {
    std::vector<PixelPosition> places;
    for (SourceMeasurement& s : sources_) {
      const PixelPosition place{s.x, s.y};
      const bool on = detail::on_frame(place, area_);
      if (!on) s.flags |= measurement_flag::kOutside;
      places.push_back(on ? place : PixelPosition{kNaN, kNaN});
    }
    fitted_.resize(sources_.size());
    chi2_.assign(sources_.size(), kNaN);
    sky_.assign(sources_.size(), kNaN);
    believed_.assign(sources_.size(), {});
    for (std::size_t i = 0; i < places.size(); ++i) believed_[i] = {places[i], 0.0};
    const auto groups = detail::friends_of_friends(places, kLink * reach_.fwhm(), kMostStars);
    others_.assign(groups.size(), kNaN);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double largest = 0.0;
      for (std::size_t g = 0; g < groups.size(); ++g) largest = std::max(largest, fit(groups[g], others_[g]));
      constexpr double kSettled = 0.05;  // errors
      if (largest < kSettled) break;
    }
    for (const auto& group : groups)
      for (const std::size_t i : group) report(i);
  }

 private:
  void make_noise() {
    const BackgroundMap* map = settings_.map.get();
    std::shared_ptr<const BackgroundMap> own;
    if (map == nullptr) {
      own = std::make_shared<const BackgroundMap>(frame_, 0, settings_.mesh);
      map = own.get();
    }
    const double gain = frame_.header.gain.value();
    const double readout = frame_.header.readout_noise.value();
    const auto n = area_.size();
    electrons_.resize(n);
    level_.resize(n);
    variance_.resize(n);
    usable_.resize(n);
    std::vector<double> level(static_cast<std::size_t>(area_.nx));
    std::vector<double> rms(level.size());
    std::size_t k = 0;
    for (int y = area_.y0; y < area_.y1(); ++y) {
      map->level_row(y, level);
      map->rms_row(y, rms);
      const auto row = frame_.pixels.view(0).row(y);
      const auto flags = frame_.flags.view(0).row(y);
      for (std::size_t x = 0; x < row.size(); ++x, ++k) {
        constexpr double kRounding = 1.0 / 12.0;  // of counts to whole numbers
        const double noise = gain * gain * rms[x] * rms[x];
        electrons_[k] = gain * (static_cast<double>(row[x]) - level[x]);
        level_[k] = gain * (level[x] - frame_.header.bias.value());
        variance_[k] = std::max({noise, readout * readout, kRounding * gain * gain});
        usable_[k] = detail::may_be_fitted(flags[x], row[x]) && std::isfinite(electrons_[k]) ? 1 : 0;
      }
    }
  }

  void add_light(const GroupStar& star, double sign) {
    if (!(star.flux > 0.0)) return;
    constexpr double kFaintest = 0.01;  // e-
    const int half = reach_.half(star.flux, kFaintest);
    const Rectangle box = intersect(stamp_box(star.position, half), area_);
    if (box.size() == 0) return;
    stamp_.resize(box.size());
    psf_.integrate(star.position, box, stamp_);
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x, ++k) light_.at(x, y) += sign * star.flux * stamp_[k];
  }

  // @param others  [in,out] light of other groups in the pixels when the group was fitted last; NaN: never
  // @returns by how much a flux changed since the last time, in units of its error.
  double fit(const std::vector<std::size_t>& group, double& others) {
    std::vector<GroupStar> stars;
    for (const std::size_t i : group) {
      add_light(believed_[i], -1.0);
      // Where the stars are said to be is where they start from, always.
      stars.push_back({{sources_[i].x, sources_[i].y}, believed_[i].flux});
    }
    double light = 0.0;
    double variance = 0.0;
    const GroupPixels pixels = cut(stars, light, variance);
    constexpr double kNoticed = 0.01;  // of the noise of all the pixels
    if (std::abs(light - others) < kNoticed * std::sqrt(variance)) {
      for (const std::size_t i : group) add_light(believed_[i], 1.0);
      return 0.0;
    }
    others = light;
    const GroupFit result = fit_group(pixels, psf_, stars, settings_.fit);
    double largest = 0.0;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const std::size_t i = group[k];
      const FittedStar& star = result.stars[k];
      const double flux = std::isfinite(star.flux) ? star.flux : 0.0;
      const double error = std::sqrt(star.covariance[0]);
      if (error > 0.0 && std::isfinite(error)) largest = std::max(largest, std::abs(flux - believed_[i].flux) / error);
      fitted_[i] = star;
      believed_[i] = {star.position, flux};
      add_light(believed_[i], 1.0);
      chi2_[i] = result.chi2;
      sky_[i] = result.background;
    }
    return largest;
  }

  // @param light, variance  [out] sums of the light of others and of the noise
  [[nodiscard]] GroupPixels cut(const std::vector<GroupStar>& stars, double& light, double& variance) const {
    const int half = reach_.core() + static_cast<int>(std::ceil(reach_.fwhm()));
    Rectangle box = stamp_box(stars.front().position, half);
    for (const GroupStar& star : stars) {
      const Rectangle b = stamp_box(star.position, half);
      const int x1 = std::max(box.x1(), b.x1());
      const int y1 = std::max(box.y1(), b.y1());
      box.x0 = std::min(box.x0, b.x0);
      box.y0 = std::min(box.y0, b.y0);
      box.nx = x1 - box.x0;
      box.ny = y1 - box.y0;
    }
    GroupPixels pixels;
    pixels.box = intersect(box, area_);
    for (int y = pixels.box.y0; y < pixels.box.y1(); ++y)
      for (int x = pixels.box.x0; x < pixels.box.x1(); ++x) {
        const auto k = static_cast<std::size_t>(y - area_.y0) * static_cast<std::size_t>(area_.nx) +
                       static_cast<std::size_t>(x - area_.x0);
        const double others = light_.at(x, y);
        light += std::abs(others);
        variance += variance_[k];
        pixels.electrons.push_back(electrons_[k] - others);
        pixels.variance.push_back(variance_[k] + std::max(0.0, others));
        pixels.usable.push_back(usable_[k]);
      }
    return pixels;
  }

  void report(std::size_t i) {
    SourceMeasurement& s = sources_[i];
    const FittedStar& star = fitted_[i];
    // What the pixels' own flags say is more than that they were not used.
    s.flags |=
        (star.flags & ~measurement_flag::kBadPixel) | detail::pixel_flags_around(frame_, {s.x, s.y}, reach_.core());
    if (!std::isfinite(star.flux)) {
      if (s.flags == 0U) s.flags = measurement_flag::kBadPixel;
      return;
    }
    s.x = star.position.x;
    s.y = star.position.y;
    s.flux = star.flux;
    s.flux_err = std::hypot(std::sqrt(star.covariance[0]), settings_.psf_error * star.flux);
    s.position_err = std::sqrt(0.5 * (star.covariance[3] + star.covariance[5]));
    s.chi2 = chi2_[i];
    const int px = std::clamp(static_cast<int>(std::floor(s.x + 0.5)), area_.x0, area_.x1() - 1);
    const int py = std::clamp(static_cast<int>(std::floor(s.y + 0.5)), area_.y0, area_.y1() - 1);
    s.background = sky_[i] + level_[static_cast<std::size_t>(py - area_.y0) * static_cast<std::size_t>(area_.nx) +
                                    static_cast<std::size_t>(px - area_.x0)];
    if (!(s.flux_err > 0.0) || !std::isfinite(s.flux_err)) {
      s.flags |= measurement_flag::kUnsettled;
      return;
    }
    s.snr = s.flux / s.flux_err;
    if (const auto mag = magnitude_of(Electrons(s.flux) / frame_.header.exposure_time, settings_.zero_point)) {
      s.mag = mag->value();
      s.mag_err = magnitude_error(s.snr).value();
    }
  }

  const Frame& frame_;
  std::span<SourceMeasurement> sources_;
  const GroupPhotometrySettings& settings_;
  const PixelPsf& psf_;
  Rectangle area_;
  detail::PsfReach reach_;
  Image<double, unit::Electrons> light_;  // of all stars as last fitted
  std::vector<double> electrons_;         // above the mesh
  std::vector<double> level_;             // of the mesh
  std::vector<double> variance_;
  std::vector<char> usable_;
  std::vector<GroupStar> believed_;
  std::vector<FittedStar> fitted_;
  std::vector<double> others_;
  std::vector<double> chi2_;
  std::vector<double> sky_;
  std::vector<double> stamp_;
};

}  // namespace

std::vector<SourceMeasurement> measure_groups(const Frame& frame, const SkyProjection* sky,
                                              std::span<const SourceRequest> sources,
                                              const GroupPhotometrySettings& settings) {
  if (settings.psf == nullptr)
    throw InputError(Problem{
        .parameter = "psf", .value = "", .expected = "a PSF, given or measured", .message = "stars are fitted by it"});
  ASTROID_CHECK_EQ(frame.pixels.layout().regions().size(), std::size_t{1});
  std::vector<SourceMeasurement> measured = detail::rows_of(sources, sky);
  GroupMeasurer(frame, measured, settings).run();
  return measured;
}

}  // namespace astroid
