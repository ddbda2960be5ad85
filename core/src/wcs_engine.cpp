#include "wcs_engine.hpp"

#include <wcslib/wcs.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace astroid {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBlock = 256;  // positions handed to WCSLIB in one call: its work arrays then stay in cache

}  // namespace

void WcsDeleter::operator()(wcsprm* wcs) const {
  wcsfree(wcs);
  delete wcs;
}

std::string wcs_message(int status) {
  return wcs_errmsg[status];
}

WcsPointer copy_wcs(const wcsprm& original, bool celestial_only) {
  auto copy = std::make_unique<wcsprm>();
  copy->flag = -1;  // tells WCSLIB that the structure holds nothing yet
  int axes_wanted = 2;
  std::array<int, 2> axes = {WCSSUB_CELESTIAL, WCSSUB_CELESTIAL};
  const int status = celestial_only ? wcssub(1, &original, &axes_wanted, axes.data(), copy.get())
                                    : wcssub(1, &original, nullptr, nullptr, copy.get());
  WcsPointer result(copy.release());
  if (status != 0) throw std::runtime_error(wcs_message(status));
  if (const int set = wcsset(result.get()); set != 0) throw std::runtime_error(wcs_message(set));
  return result;
}

/// One copy of the structure for the time of one call.
class WcsEngine::Lease {
 public:
  explicit Lease(const WcsEngine& engine) : engine_(engine) {
    const std::lock_guard lock(engine_.mutex_);
    if (engine_.idle_.empty()) {
      engine_.idle_.reserve(++engine_.copies_);  // so that giving a copy back cannot fail
      wcs_ = copy_wcs(*engine_.original_);
    } else {
      wcs_ = std::move(engine_.idle_.back());
      engine_.idle_.pop_back();
    }
  }
  ~Lease() {
    const std::lock_guard lock(engine_.mutex_);
    engine_.idle_.push_back(std::move(wcs_));
  }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;
  [[nodiscard]] wcsprm* get() const { return wcs_.get(); }

 private:
  const WcsEngine& engine_;
  WcsPointer wcs_;
};

WcsEngine::WcsEngine(WcsPointer wcs) : original_(std::move(wcs)) {}

void WcsEngine::to_pixels(std::span<const SkyPosition> world, std::span<PixelPosition> pixels) const {
  const Lease lease(*this);
  const auto lng = static_cast<std::size_t>(lease.get()->lng);
  const auto lat = static_cast<std::size_t>(lease.get()->lat);
  std::array<double, 2 * kBlock> coordinates{};
  std::array<double, 2 * kBlock> image{};
  std::array<double, 2 * kBlock> pixel{};
  std::array<double, kBlock> phi{};
  std::array<double, kBlock> theta{};
  std::array<int, kBlock> status{};
  for (std::size_t begin = 0; begin < world.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, world.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      coordinates[2 * i + lng] = world[begin + i].ra;
      coordinates[2 * i + lat] = world[begin + i].dec;
    }
    const int failure = wcss2p(lease.get(), static_cast<int>(count), 2, coordinates.data(), phi.data(), theta.data(),
                               image.data(), pixel.data(), status.data());
    // WCSERR_BAD_WORLD marks the bad positions in `status`; anything else spoils the whole block.
    const bool all_bad = failure != 0 && failure != WCSERR_BAD_WORLD;
    for (std::size_t i = 0; i < count; ++i) {
      pixels[begin + i] =
          all_bad || status[i] != 0 ? PixelPosition{kNan, kNan} : PixelPosition{pixel[2 * i], pixel[2 * i + 1]};
    }
  }
}

SkyPosition WcsEngine::to_world(PixelPosition pixel) const {
  const Lease lease(*this);
  const std::array<double, 2> coordinates = {pixel.x, pixel.y};
  std::array<double, 2> image{};
  std::array<double, 2> world{};
  double phi = 0.0;
  double theta = 0.0;
  int status = 0;
  if (wcsp2s(lease.get(), 1, 2, coordinates.data(), image.data(), &phi, &theta, world.data(), &status) != 0) {
    return {kNan, kNan};
  }
  return {world[static_cast<std::size_t>(lease.get()->lng)], world[static_cast<std::size_t>(lease.get()->lat)]};
}

}  // namespace astroid
