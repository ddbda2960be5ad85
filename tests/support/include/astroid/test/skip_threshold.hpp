// Where a plan begins to need an effect, and what the effect would do just below: for tests that skipping is harmless.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid::test {

inline constexpr int kSkipSide = 96;  ///< px, of the detector that has nine_stars()

/// Nine stars of 3e3 to 8e5 e-, 32 px apart, each at another place within its pixel.
inline std::vector<LabStar> nine_stars() {
  std::vector<LabStar> stars;
  for (int i = 0; i < 9; ++i)
    stars.push_back(
        {16.0 + 32.0 * (i % 3) + 0.11 * i - 0.4, 16.0 + 32.0 * (i / 3) - 0.09 * i + 0.3, 3e3 * std::pow(2.0, i)});
  return stars;
}

/// Photon noise and readout noise alone; effects under test are added with a strength.
inline Mission quiet_mission() {
  Mission mission = bare_mission(kSkipSide, kSkipSide);
  mission.ccd.readout_noise = Electrons(20.0);
  mission.simulation.exposures = 32;
  return mission;
}

struct Planned {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};
inline Planned planned(const Mission& mission) {
  Planned p;
  p.scene = std::make_shared<const Scene>(mission, lab_catalogue(nine_stars()));
  p.plan = std::make_shared<const Plan>(make_plan(*p.scene));
  return p;
}

/// The same plan with one effect switched on or off.
inline std::shared_ptr<const Plan> with_effect(const Plan& plan, std::string_view name, bool runs = true) {
  auto changed = std::make_shared<Plan>(plan);
  for (PlannedEffect& effect : changed->effects)
    if (effect.effect->spec().name == name) effect.need.needed = runs;
  return changed;
}

/// Puts a strength into a mission.
using SetStrength = std::function<void(Mission&, double)>;

/// An effect and how its strength is set.
struct SkipCase {
  const char* effect;
  SetStrength set;
  double high;  ///< surely needed
  friend void PrintTo(const SkipCase& c, std::ostream* out) { *out << c.effect; }
};

/// The largest strength (to 1 %) at which the plan of a mission leaves the effect out; 0 where it never does.
inline double skip_threshold(const Mission& quiet, const SkipCase& c) {
  double low = 0.0;
  double high = c.high;
  for (int i = 0; i < 60 && high - low > 0.01 * high; ++i) {
    const double middle = 0.5 * (low + high);
    Mission mission = quiet;
    c.set(mission, middle);
    (planned(mission).plan->runs(c.effect) ? high : low) = middle;
  }
  return low;
}

/// The name of an effect as a test may have it.
inline std::string test_name(std::string_view effect) {
  std::string name(effect);
  std::erase(name, '-');
  return name;
}

/// Sums over 6 x 6 px around each star of the whole frame.
template <class T, class Unit>
std::vector<double> star_sums(const Scene& scene, const ImageView<T, Unit>& image) {
  std::vector<double> sums;
  for (const SceneStar& star : scene.stars()) {
    double sum = 0.0;
    const int x0 = static_cast<int>(std::floor(star.position.x)) - 2;
    const int y0 = static_cast<int>(std::floor(star.position.y)) - 2;
    for (int y = y0; y < y0 + 6; ++y)
      for (int x = x0; x < x0 + 6; ++x) sum += image.at(x, y);
    sums.push_back(sum);
  }
  return sums;
}

/// The largest difference of a star's flux relative to its tolerance.
inline double worst_change(const Scene& scene, const std::vector<double>& without, const std::vector<double>& with) {
  double worst = 0.0;
  for (std::size_t i = 0; i < with.size(); ++i)
    worst =
        std::max(worst, std::abs(with[i] - without[i]) / scene.summary().flux_tolerance(scene.stars()[i].electrons));
  return worst;
}

}  // namespace astroid::test
