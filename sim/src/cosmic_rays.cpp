#include "astroid/sim/cosmic_rays.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "astroid/core/distributions.hpp"
#include "astroid/core/frame.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr double kHalf = 0.5;                      // a pixel begins half a pixel before its centre
constexpr double kMoyalMean = 1.2703628454614782;  // Euler's constant + ln 2
constexpr double kMoyalVariance = 0.5 * std::numbers::pi * std::numbers::pi;

/// Where the random words of a tile are.
class TileWords {
 public:
  TileWords(const RandomStream& stream, int tile_x, int tile_y, CosmicTime time)
      : stream_(stream),
        x_(static_cast<std::uint32_t>(tile_x)),
        y_(static_cast<std::uint32_t>(tile_y)),
        exposure_(time.exposure),
        read_(std::uint32_t{time.read} << kReadShift) {}
  [[nodiscard]] RandomWords number() const { return at(0); }
  [[nodiscard]] RandomWords track(std::uint32_t k) const { return at(1 + 2 * k); }
  [[nodiscard]] RandomWords charge(std::uint32_t k) const { return at(2 + 2 * k); }

 private:
  static constexpr unsigned kReadShift = 16;
  [[nodiscard]] RandomWords at(std::uint32_t draw) const {
    return philox4x32(stream_, {x_, y_, exposure_, read_ | draw});
  }
  const RandomStream& stream_;
  std::uint32_t x_;
  std::uint32_t y_;
  std::uint32_t exposure_;
  std::uint32_t read_;
};

std::uint32_t number_of(const CosmicRayModel& model, const TileWords& words) {
  const RandomWords drawn = words.number();
  const double mean = model.hits_per_pixel * kCosmicTile * kCosmicTile;
  return static_cast<std::uint32_t>(poisson_quantile(mean, drawn[0], [&] { return drawn[1]; }));
}

/// Path through the slab and its projection, px.
struct Crossing {
  double path;
  double length;
};
Crossing crossing(const CosmicRayModel& model, std::uint32_t word) {
  const double u = uniform_from(word);
  if (!model.is_slab) return {0.0, u * model.longest_track};
  // cos² is uniform; the smallest that is drawn belongs to the longest track.
  const double longest = model.longest_track / model.thickness;
  const double smallest = 1.0 / (1.0 + longest * longest);
  const double squared = smallest + (1.0 - smallest) * u;
  const double path = model.thickness / det::sqrt(squared);
  return {path, path * det::sqrt(1.0 - squared)};
}

CosmicRay track_of(const CosmicRayModel& model, const RandomWords& words, int tile_x, int tile_y) {
  const double angle = 2.0 * std::numbers::pi * uniform_from(words[2]);
  const double length = crossing(model, words[3]).length;
  return {.entry = {kCosmicTile * (tile_x + uniform_from(words[0])) - kHalf,
                    kCosmicTile * (tile_y + uniform_from(words[1])) - kHalf},
          .track = {length * det::cos(angle), length * det::sin(angle)}};
}

/// @param track  the words that the track was made from.
double charge_of_particle(const CosmicRayModel& model, const RandomWords& track, const RandomWords& words) {
  const double first = standard_normal(words[0]);
  if (model.is_slab) {
    // Moyal's approximation of Landau's distribution is that of -ln of the square of a normal.
    const double fluctuation = -det::log(first * first);
    const double path = crossing(model, track[3]).path;
    return std::max(0.0, path * model.electrons_per_path * (1.0 + model.fluctuation * fluctuation));
  }
  const double shape = model.charge_shape;
  const double delta = shape / det::sqrt(1.0 + shape * shape);
  const double rest = 1.0 / det::sqrt(1.0 + shape * shape);
  return std::max(
      0.0, model.charge_location + model.charge_scale * (delta * std::abs(first) + rest * standard_normal(words[1])));
}

int tile_of(int pixel) {
  return pixel >= 0 ? pixel / kCosmicTile : -((kCosmicTile - 1 - pixel) / kCosmicTile);
}

/// Whether the rectangle around a track meets an area, or nearly: rounding must not decide it.
bool may_meet(const CosmicRay& ray, const Rectangle& area) {
  constexpr double kMargin = 0.5;  // px
  const auto meets = [](double from, double shift, int begin, int end) {
    return std::max(from, from + shift) >= begin - kHalf - kMargin &&
           std::min(from, from + shift) <= end - kHalf + kMargin;
  };
  return meets(ray.entry.x, ray.track.dx, area.x0, area.x1()) && meets(ray.entry.y, ray.track.dy, area.y0, area.y1());
}

/// One coordinate of a walk from pixel to pixel along a track, which is gone through from 0 to 1.
struct Walk {
  Walk(double from, double shift) : pixel(static_cast<int>(std::floor(from + kHalf))), step(shift < 0.0 ? -1 : 1) {
    if (shift == 0.0) return;
    const double border = shift > 0.0 ? pixel + kHalf : pixel - kHalf;
    next = (border - from) / shift;
    across = 1.0 / std::abs(shift);
  }
  void cross() {
    pixel += step;
    next += across;
  }
  int pixel;
  int step;
  double next = std::numeric_limits<double>::infinity();  ///< where it crosses into the next pixel
  double across = 0.0;
};

}  // namespace

CosmicCharge charge_of(const CosmicRayModel& model) {
  if (model.is_slab) {
    const double longest = model.longest_track / model.thickness;
    const double smallest = 1.0 / (1.0 + longest * longest);
    // Moments of 1/cos where cos² is uniform from `smallest` to 1.
    const double inverse = 2.0 / (1.0 + det::sqrt(smallest));
    const double inverse_squared = -det::log(smallest) / (1.0 - smallest);
    const double unit_charge = model.thickness * model.electrons_per_path;
    const double factor = 1.0 + model.fluctuation * kMoyalMean;
    const double factor_squared = factor * factor + model.fluctuation * model.fluctuation * kMoyalVariance;
    const double mean = unit_charge * inverse * factor;
    return {mean, unit_charge * unit_charge * inverse_squared * factor_squared - mean * mean};
  }
  const double delta = model.charge_shape / det::sqrt(1.0 + model.charge_shape * model.charge_shape);
  const double shift = delta * det::sqrt(2.0 / std::numbers::pi);
  return {model.charge_location + model.charge_scale * shift,
          model.charge_scale * model.charge_scale * (1.0 - shift * shift)};
}

int reach_of(const CosmicRayModel& model) {
  return static_cast<int>(std::ceil(model.longest_track)) + 1;
}

std::vector<CosmicRay> cosmic_rays_of_tile(const CosmicRayModel& model, const RandomStream& stream, int tile_x,
                                           int tile_y, CosmicTime time) {
  const TileWords words(stream, tile_x, tile_y, time);
  std::vector<CosmicRay> rays;
  const std::uint32_t number = number_of(model, words);
  for (std::uint32_t k = 0; k < number; ++k) {
    const RandomWords track = words.track(k);
    rays.push_back(track_of(model, track, tile_x, tile_y));
    rays.back().electrons = charge_of_particle(model, track, words.charge(k));
  }
  return rays;
}

double leave_track(const CosmicRay& ray, const ImageView<double, unit::SampledElectrons>& electrons,
                   const ImageView<std::uint8_t, unit::Flags>* flags) {
  Walk x(ray.entry.x, ray.track.dx);
  Walk y(ray.entry.y, ray.track.dy);
  double left = 0.0;
  double done = 0.0;
  while (done < 1.0) {
    const double until = std::min({x.next, y.next, 1.0});
    if (until > done && electrons.area().contains(x.pixel, y.pixel)) {
      const double charge = (until - done) * ray.electrons;
      electrons.at(x.pixel, y.pixel) += charge;
      if (flags != nullptr) flags->at(x.pixel, y.pixel) |= pixel_flag::kCosmicRay;
      left += charge;
    }
    done = std::max(done, until);
    (x.next <= y.next ? x : y).cross();
  }
  return left;
}

double add_cosmic_rays(const CosmicRayModel& model, const RandomStream& stream, CosmicTime time,
                       const ImageView<double, unit::SampledElectrons>& electrons,
                       const ImageView<std::uint8_t, unit::Flags>* flags) {
  const Rectangle& area = electrons.area();
  if (area.empty()) return 0.0;
  const int reach = reach_of(model);
  double left = 0.0;
  for (int tile_y = tile_of(area.y0 - reach); tile_y <= tile_of(area.y1() - 1 + reach); ++tile_y) {
    for (int tile_x = tile_of(area.x0 - reach); tile_x <= tile_of(area.x1() - 1 + reach); ++tile_x) {
      const TileWords words(stream, tile_x, tile_y, time);
      const std::uint32_t number = number_of(model, words);
      for (std::uint32_t k = 0; k < number; ++k) {
        const RandomWords track = words.track(k);
        CosmicRay ray = track_of(model, track, tile_x, tile_y);
        if (!may_meet(ray, area)) continue;
        ray.electrons = charge_of_particle(model, track, words.charge(k));
        left += leave_track(ray, electrons, flags);
      }
    }
  }
  return left;
}

}  // namespace astroid
