#include "field/star_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/units.hpp"
#include "field/place.hpp"

namespace astroid::detail {

PsfReach::PsfReach(const PixelPsf& psf, PixelPosition centre, int limit) {
  // The brightest of four sub-pixel phases bounds what any star leaves in a pixel that far away.
  constexpr double kLost = 1e-6;  // of the light of a star
  const int most = std::clamp(static_cast<int>(std::ceil(psf.stamp_half_width(kLost))), 2, limit);
  const int side = 2 * most + 1;
  const PixelPosition middle{std::floor(centre.x + 0.5), std::floor(centre.y + 0.5)};
  const Rectangle box{static_cast<int>(middle.x) - most, static_cast<int>(middle.y) - most, side, side};
  std::vector<double> fractions(box.size());
  edge_.assign(static_cast<std::size_t>(most) + 1, 0.0);
  std::vector<double> centred;
  for (const double dx : {0.0, 0.5}) {
    for (const double dy : {0.0, 0.5}) {
      psf.integrate({middle.x + dx, middle.y + dy}, box, fractions);
      if (centred.empty()) centred = fractions;
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          const int r = std::max(std::abs(i - most), std::abs(j - most));
          double& largest = edge_[static_cast<std::size_t>(r)];
          largest = std::max(largest, std::abs(fractions[place_in(i, j, side)]));
        }
      }
    }
  }
  for (std::size_t r = edge_.size() - 1; r > 0; --r) edge_[r - 1] = std::max(edge_[r - 1], edge_[r]);

  std::vector<double> squares(edge_.size(), 0.0);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double p = centred[place_in(i, j, side)];
      squares[static_cast<std::size_t>(std::max(std::abs(i - most), std::abs(j - most)))] += p * p;
    }
  double total = 0.0;
  for (const double s : squares) total += s;
  noise_pixels_ = total > 0.0 ? 1.0 / total : 1.0;
  // A Gaussian has 4 pi sigma² noise pixels (King1983), a pixel's own width of 1/12 px² included in sigma².
  constexpr double kPixelVariance = 1.0 / 12.0;
  fwhm_ = kFwhmPerSigma * std::sqrt(std::max(noise_pixels_ / (4.0 * kPi) - kPixelVariance, kPixelVariance));
  constexpr double kCoreShare = 0.999;
  double sum = squares[0];
  core_ = 0;
  while (core_ < most && sum < kCoreShare * total) sum += squares[static_cast<std::size_t>(++core_)];
  core_ = std::clamp(core_, 1, most);
  for (int j = -core_; j <= core_; ++j)
    for (int i = -core_; i <= core_; ++i) kernel_.push_back(centred[place_in(i + most, j + most, side)]);
}

int PsfReach::half(double flux, double level) const {
  for (int r = core_; r < most(); ++r)
    if (flux * edge_[static_cast<std::size_t>(r) + 1] < level) return r;
  return most();
}

void StarStamps::update(std::span<const ModelStar> stars) {
  // Keeps what it can in place; stars that moved are computed into the same room when it is large enough.
  places_.resize(stars.size());
  std::size_t needed = 0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto floats = place_in(0, 2 * stars[i].half + 1, 3 * stride_of(stars[i].half));
    Place& place = places_[i];
    if (place.half != stars[i].half || place.offset != needed) place.half = -1;
    place.offset = needed;
    needed += floats;
  }
  pool_.resize(needed + 4, 0.0F);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const ModelStar& star = stars[i];
    Place& place = places_[i];
    if (place.half == star.half && place.x == star.x && place.y == star.y) continue;
    compute(star, place);
  }
}

void StarStamps::compute(const ModelStar& star, Place& place) {
  const int side = 2 * star.half + 1;
  place.x = star.x;
  place.y = star.y;
  place.half = star.half;
  place.x0 = static_cast<int>(std::floor(star.x + 0.5)) - star.half;
  place.y0 = static_cast<int>(std::floor(star.y + 0.5)) - star.half;
  const Rectangle box{place.x0, place.y0, side, side};
  const std::size_t n = box.size();
  scratch_.resize(3 * n);
  const std::span<double> all(scratch_);
  psf_.integrate({star.x, star.y}, box, all.first(n));
  psf_.integrate_gradient({star.x, star.y}, box, all.subspan(n, n), all.subspan(2 * n, n));
  const auto stride = static_cast<std::size_t>(stride_of(star.half));
  const auto width = static_cast<std::size_t>(side);
  const double* from = scratch_.data();
  float* to = pool_.data() + place.offset;
  for (std::size_t row = 0; row < 3 * width; ++row, from += width, to += stride) {
    for (std::size_t i = 0; i < width; ++i) to[i] = static_cast<float>(from[i]);
    for (std::size_t i = width; i < stride; ++i) to[i] = 0.0F;
  }
}

StampView StarStamps::operator[](std::size_t i) const {
  const Place& place = places_[i];
  const int side = 2 * place.half + 1;
  const int stride = stride_of(place.half);
  const auto plane = place_in(0, side, stride);
  const float* p = pool_.data() + place.offset;
  return {p, p + plane, p + 2 * plane, place.x0, place.y0, side, stride};
}

}  // namespace astroid::detail
