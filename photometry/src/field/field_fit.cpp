#include "field/field_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

// Beside other stars already this share of the threshold is worth a trial: only the fit with all others decides.
constexpr double kTrial = 0.75;

}  // namespace

FieldFit::FieldFit(const PixelPsf& psf, const PsfReach& reach, const FieldPixels& pixels,
                   const FieldFitSettings& settings)
    : settings_(settings),
      reach_(reach),
      solver_(psf, reach, pixels, settings.sky_cell),
      filter_(reach),
      local_(solver_) {}

void FieldFit::run() {
  solver_.render();
  solver_.assemble();
  for (int round = 0; round < settings_.rounds; ++round) {
    if (round > 1 && settings_.companions) add_companions();
    add_from_residuals();
    for (const Peak& peak : accepted_) solver_.stars().push_back({peak.x, peak.y, peak.flux});
    const std::size_t changed = accepted_.size();
    accepted_.clear();
    solver_.render();
    solver_.assemble();
    iterate(round == 0 ? 3 : 2, 0.05);
    prune();
    if (round > 1 && changed <= solver_.stars().size() / 1000) break;
  }
  for (int i = 0; i < 3; ++i) {
    iterate(6, 0.02, solver_.stars().size() / 1000);
    if (prune() == 0) break;
  }
  filter_.apply(solver_.residual(), solver_.weight());
}

void FieldFit::iterate(int steps, double tolerance, std::size_t enough) {
  constexpr int kMostIterations = 100;
  for (int i = 0; i < steps; ++i) {
    const std::size_t change = solver_.step(tolerance, kMostIterations);
    solver_.render();
    solver_.assemble();
    if (change <= enough) break;
  }
}

std::size_t FieldFit::prune() {
  auto& stars = solver_.stars();
  std::vector<char> remove(stars.size(), 0);
  std::size_t count = 0;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto& c = solver_.terms()[i].curvature;
    const double alone = stars[i].flux * std::sqrt(c[0]);
    const bool outside = stars[i].x < -1.0 || stars[i].y < -1.0 || stars[i].x > solver_.light().nx() ||
                         stars[i].y > solver_.light().ny();
    // A star whose neighbours are all far is told by its own curvature.
    const double distance = alone < 2.0 * settings_.threshold ? 1.5 : 1.0;  // FWHM
    solver_.neighbours().find(stars[i].x, stars[i].y, distance * reach_.fwhm(), near);
    const bool crowded = near.size() > 1;
    bool bad = outside || !(alone > settings_.threshold);
    if (!bad && crowded) {
      const StarCovariance covariance = local_.covariance(i);
      bad = !(stars[i].flux > settings_.threshold * std::sqrt(covariance.covariance[0]));
    }
    if (!bad) continue;
    // Of two that cannot be told apart only the fainter goes now.
    bool brightest_goes = false;
    for (const std::uint32_t k : near)
      if (remove[k] != 0 && !outside) brightest_goes = true;
    for (const std::uint32_t k : near)
      if (k != i && stars[k].flux < stars[i].flux && alone > settings_.threshold) {
        const double dx = stars[k].x - stars[i].x;
        const double dy = stars[k].y - stars[i].y;
        if (dx * dx + dy * dy < reach_.fwhm() * reach_.fwhm()) brightest_goes = true;
      }
    if (brightest_goes) continue;
    remove[i] = 1;
    refused_.push_back({stars[i].x, stars[i].y, stars[i].flux, alone});
    ++count;
  }
  if (count == 0) return 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < stars.size(); ++i)
    if (remove[i] == 0) stars[kept++] = stars[i];
  stars.resize(kept);
  solver_.render();
  solver_.assemble();
  return count;
}

// Whether a candidate is within what a wrong PSF leaves of the stars that are known.
bool FieldFit::may_be_psf_error(const Peak& peak) const {
  if (!(settings_.psf_doubt > 0.0)) return false;
  const int px = std::clamp(static_cast<int>(std::floor(peak.x + 0.5)), 0, solver_.light().nx() - 1);
  const int py = std::clamp(static_cast<int>(std::floor(peak.y + 0.5)), 0, solver_.light().ny() - 1);
  const auto light = static_cast<double>(*solver_.light().at(px, py));
  return peak.flux * reach_.peak() < settings_.psf_doubt * light;
}

bool FieldFit::was_refused(const Peak& peak) const {
  const double least = 0.5 * reach_.fwhm();
  int times = 0;
  for (const Peak& old : refused_)
    times += std::abs(old.x - peak.x) < least && std::abs(old.y - peak.y) < least ? 1 : 0;
  return times > 1;
}

bool FieldFit::accept(const Peak& peak) {
  const double least = 0.8 * reach_.fwhm();
  for (auto it = accepted_.rbegin(); it != accepted_.rend(); ++it) {
    const double dx = it->x - peak.x;
    const double dy = it->y - peak.y;
    if (dx * dx + dy * dy < least * least) return false;
  }
  accepted_.push_back(peak);
  return true;
}

std::size_t FieldFit::add_from_residuals() {
  filter_.apply(solver_.residual(), solver_.weight());
  constexpr double kLeast = 3.0;
  const double trial = kTrial * settings_.threshold;
  const bool first = solver_.stars().empty();
  std::vector<Peak> peaks = filter_.peaks(first ? settings_.threshold : std::min(kLeast, settings_.threshold));
  if (first) {
    accepted_ = std::move(peaks);
    return accepted_.size();
  }
  std::size_t added = 0;
  std::vector<Peak> found;
  for (Peak& peak : peaks) {
    const FluxEstimate estimate = local_.candidate(peak.x, peak.y);
    if (!(estimate.flux > (local_.nearest() < 2.0 * reach_.fwhm() ? trial : settings_.threshold) * estimate.error))
      continue;
    if (may_be_psf_error({peak.x, peak.y, estimate.flux, 0.0})) continue;
    if (!settings_.companions && local_.nearest() < reach_.fwhm()) continue;
    found.push_back({peak.x, peak.y, estimate.flux, estimate.flux / estimate.error});
  }
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.significance > b.significance; });
  for (const Peak& peak : found) added += !was_refused(peak) && accept(peak) ? 1 : 0;
  return added;
}

std::size_t FieldFit::add_companions() {
  const auto& stars = solver_.stars();
  const double ring = 0.5 * reach_.fwhm();
  const int half = std::max(1, static_cast<int>(std::lround(0.8 * reach_.fwhm())));
  const double trial = kTrial * settings_.threshold;
  constexpr int kAngles = 8;
  std::size_t added = 0;
  std::vector<Peak> found;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto& c = solver_.terms()[i].curvature;
    if (stars[i].flux * std::sqrt(c[0]) < 2.0 * settings_.threshold) continue;
    const int x0 = static_cast<int>(std::floor(stars[i].x + 0.5)) - half;
    const int y0 = static_cast<int>(std::floor(stars[i].y + 0.5)) - half;
    double chi2 = 0.0;
    for (int j = 0; j <= 2 * half; ++j) {
      const float* r = solver_.residual().at(x0, y0 + j);
      const float* w = solver_.weight().at(x0, y0 + j);
      for (int k = 0; k <= 2 * half; ++k) chi2 += static_cast<double>(r[k] * r[k] * w[k]);
    }
    const double pixels = (2.0 * half + 1.0) * (2.0 * half + 1.0);
    if (chi2 - pixels < 0.5 * settings_.threshold * settings_.threshold) continue;
    Peak best;
    for (int a = 0; a < kAngles; ++a) {
      const double angle = 2.0 * kPi * a / kAngles;
      const double x = stars[i].x + ring * det::cos(angle);
      const double y = stars[i].y + ring * det::sin(angle);
      const FluxEstimate estimate = local_.candidate(x, y);
      if (may_be_psf_error({x, y, estimate.flux, 0.0})) continue;
      if (estimate.flux > trial * estimate.error && estimate.flux / estimate.error > best.significance)
        best = {x, y, estimate.flux, estimate.flux / estimate.error};
    }
    if (best.significance > 0.0) found.push_back(best);
  }
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.significance > b.significance; });
  for (const Peak& peak : found) added += !was_refused(peak) && accept(peak) ? 1 : 0;
  return added;
}

}  // namespace astroid::detail
