#include "astroid/test/effect_contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

namespace astroid::test {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Run {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<Plan> plan;
  [[nodiscard]] Simulator simulator() const { return {scene, plan, 0}; }
};

Run run_of(const Mission& mission, const std::vector<LabStar>& stars) {
  Run run;
  run.scene = std::make_shared<const Scene>(mission, lab_catalogue(stars));
  run.plan = std::make_shared<Plan>(make_plan(*run.scene));
  return run;
}

/// Everything of an exposure that is delivered.
struct Delivered {
  std::vector<float> pixels;
  std::vector<std::uint8_t> flags;
  double lost = 0.0;
  friend bool operator==(const Delivered&, const Delivered&) = default;
};

Delivered delivered(const Simulator& simulator, std::int64_t exposure, ExposureState& state) {
  simulator.simulate(exposure, state);
  const auto pixels = std::as_const(state.frame.pixels).pixels();
  const auto flags = std::as_const(state.frame.flags).pixels();
  return {{pixels.begin(), pixels.end()}, {flags.begin(), flags.end()}, state.lost_electrons};
}
Delivered delivered(const Run& run, std::int64_t exposure) {
  const Simulator simulator = run.simulator();
  ExposureState state = simulator.make_state();
  return delivered(simulator, exposure, state);
}

void force(Plan& plan, const std::string& effect, bool runs) {
  for (PlannedEffect& planned : plan.effects)
    if (planned.effect->spec().name == effect) planned.need.needed = runs;
}

EffectLevel level_of(const Plan& plan, const std::string& effect) {
  for (const PlannedEffect& planned : plan.effects)
    if (planned.effect->spec().name == effect) return planned.effect->spec().level;
  throw BugError("no effect " + effect);
}

void expect_runs_and_changes(const EffectScene& s) {
  const Run with = run_of(s.mission, s.stars);
  ASSERT_TRUE(with.plan->runs(s.effect)) << s.effect << " does not run in a mission that calls for it";
  Run without = with;
  without.plan = std::make_shared<Plan>(*with.plan);
  force(*without.plan, s.effect, false);
  const bool moves = with.plan->knobs.jitter != JitterTreatment::kNone;  // then the attitude is the effect
  if (!moves || with.plan->layout == with.scene->layout()) {
    EXPECT_FALSE(delivered(with, 1) == delivered(without, 1)) << s.effect << " changes nothing";
  }
  const Simulator simulator = with.simulator();
  ExposureState state = simulator.make_state();
  simulator.expect(1, state);
  for (const double value : state.expected.whole().pixels())
    ASSERT_TRUE(value >= 0.0) << "an expectation of " << value << " e-";
  const Delivered frame = delivered(simulator, 1, state);
  for (const float value : frame.pixels) ASSERT_TRUE(std::isfinite(value));
}

void expect_identity_at_zero(const EffectScene& s) {
  if (!s.switch_off) return;
  Mission mission = s.mission;
  s.switch_off(mission);
  const Run off = run_of(mission, s.stars);
  EXPECT_FALSE(off.plan->runs(s.effect)) << s.effect << " runs at zero strength";
  if (level_of(*off.plan, s.effect) == EffectLevel::kPointing) return;  // nothing moves
  Run forced = off;
  forced.plan = std::make_shared<Plan>(*off.plan);
  force(*forced.plan, s.effect, true);
  EXPECT_TRUE(delivered(off, 1) == delivered(forced, 1)) << s.effect << " is no identity at zero strength";
}

/// The planes of a state, filled with something else for each `salt`, and NaN where the effect may not look.
void fill(ExposureState& state, std::uint32_t reads, int salt) {
  const auto values = [&](std::uint32_t bit, std::span<double> pixels) {
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = (reads & bit) != 0 ? 500.0 + 37.0 * static_cast<double>(i % 101) : salt == 0 ? kNan : 1.0 / salt;
  };
  values(plane_bit::kExpected, state.expected.whole().pixels());
  values(plane_bit::kSampled, state.sampled.whole().pixels());
  values(plane_bit::kAnalog, state.analog.whole().pixels());
  Frame& frame = state.computed();
  std::ranges::fill(frame.pixels.pixels(), (reads & plane_bit::kDigital) != 0 ? 700.0F : static_cast<float>(salt));
  std::ranges::fill(frame.flags.pixels(), std::uint8_t{0});
}

template <class T>
std::vector<T> copy_of(std::span<const T> values) {
  return {values.begin(), values.end()};
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

struct Planes {
  std::vector<double> expected, sampled, analog;
  std::vector<float> digital;
  std::vector<std::uint8_t> flags;
};
Planes planes_of(ExposureState& state) {
  return {copy_of<double>(state.expected.whole().pixels()), copy_of<double>(state.sampled.whole().pixels()),
          copy_of<double>(state.analog.whole().pixels()), copy_of<float>(state.computed().pixels.pixels()),
          copy_of<std::uint8_t>(state.computed().flags.pixels())};
}

void expect_declared_planes_only(const EffectScene& s) {
  const Run run = run_of(s.mission, s.stars);
  const Effect* effect = nullptr;
  std::size_t number = 0;
  for (std::size_t i = 0; i < run.plan->effects.size(); ++i)
    if (run.plan->effects[i].effect->spec().name == s.effect) {
      effect = run.plan->effects[i].effect;
      number = i;
    }
  ASSERT_NE(effect, nullptr);
  const EffectSpec& spec = effect->spec();
  if (spec.level == EffectLevel::kPointing) return;  // changes the attitude, no plane
  // What adds to an image needs the image.
  const bool adds = spec.role != ImageRole::kNone;
  const std::uint32_t reads = spec.reads | (adds ? plane_bit::kExpected : 0U);
  const Simulator simulator = run.simulator();
  std::vector<Planes> before;
  std::vector<Planes> after;
  for (const int salt : {0, 3}) {
    ExposureState state = simulator.make_state();
    state.expected.make_whole();
    state.sampled.make_whole();
    state.analog.make_whole();
    fill(state, reads, salt);
    before.push_back(planes_of(state));
    simulator.apply_alone(number, 1, state);
    after.push_back(planes_of(state));
  }
  const auto check = [&](std::uint32_t bit, const char* name, auto member) {
    if ((spec.writes & bit) == 0)
      EXPECT_TRUE(same_bits(before[0].*member, after[0].*member)) << s.effect << " changes " << name << " unsaid";
    else
      EXPECT_TRUE(same_bits(after[0].*member, after[1].*member))
          << s.effect << " makes " << name << " of a plane that it does not say it reads";
  };
  check(plane_bit::kExpected, "the expected electrons", &Planes::expected);
  check(plane_bit::kSampled, "the drawn electrons", &Planes::sampled);
  check(plane_bit::kAnalog, "the analogue signal", &Planes::analog);
  check(plane_bit::kDigital, "the digital signal", &Planes::digital);
  check(plane_bit::kFlags, "the flags", &Planes::flags);
}

void expect_same_bits_however_it_runs(const EffectScene& s) {
  const Run run = run_of(s.mission, s.stars);
  const Delivered once = delivered(run, 2);
  const Simulator simulator = run.simulator();
  ExposureState used = simulator.make_state();
  simulator.simulate(3, used);
  EXPECT_TRUE(delivered(simulator, 2, used) == once) << "the bits depend on what the state held before";
  ExposureState seen = simulator.make_state();
  simulator.simulate(2, seen, [](const EffectSpec&, const ExposureState&) {});
  const auto pixels = std::as_const(seen.frame.pixels).pixels();
  EXPECT_TRUE(std::ranges::equal(pixels, once.pixels)) << "the bits depend on whether somebody looks";
  std::vector<Delivered> results(2);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < results.size(); ++i)
      threads.emplace_back([&, i] {
        ExposureState state = simulator.make_state();
        for (const std::int64_t exposure : {std::int64_t{1}, std::int64_t{2}})
          results[i] = delivered(simulator, exposure, state);
      });
  }
  for (const Delivered& result : results) EXPECT_TRUE(result == once) << "the bits depend on the threads";
  Mission longer = s.mission;
  longer.simulation.exposures += 7;
  EXPECT_TRUE(delivered(run_of(longer, s.stars), 2) == once) << "a longer run does not begin with the shorter one";
}

void expect_window_equals_full_frame(const EffectScene& s) {
  const Run whole = run_of(s.mission, s.stars);
  const Simulator full = whole.simulator();
  ExposureState expected = full.make_state();
  full.simulate(2, expected);
  Mission sub = s.mission;
  sub.ccd.has_sub_field = true;
  sub.ccd.sub_x0 = 53;
  sub.ccd.sub_y0 = 61;
  sub.ccd.sub_columns = 71;
  sub.ccd.sub_rows = 47;
  Mission windows = s.mission;
  windows.ccd.window = 7;
  for (const Mission& part : {sub, windows}) {
    const Run run = run_of(part, s.stars);
    const Simulator simulator = run.simulator();
    ExposureState state = simulator.make_state();
    simulator.simulate(2, state);
    const PixelLayout& layout = *run.scene->layout();
    std::size_t different = 0;
    for (std::size_t r = 0; r < layout.exposed_regions().size(); ++r) {
      const Rectangle area = layout.regions()[r];
      for (int y = area.y0; y < area.y1(); ++y)
        for (int x = area.x0; x < area.x1(); ++x)
          if (state.frame.pixels.view(r).at(x, y) != expected.frame.pixels.view(0).at(x, y) ||
              state.frame.flags.view(r).at(x, y) != expected.frame.flags.view(0).at(x, y))
            ++different;
    }
    EXPECT_EQ(different, 0U) << "pixels of a " << (part.ccd.window > 0 ? "window" : "sub-field")
                             << " that the full frame has otherwise";
  }
}

}  // namespace

std::vector<LabStar> EffectScene::some_stars() {
  constexpr int kStars = 60;
  std::vector<LabStar> stars;
  for (int i = 0; i < kStars; ++i)
    stars.push_back({5.3 + 3.17 * i, 8.0 + std::fmod(47.31 * i, 144.0), 2000.0 * std::pow(1000.0, i / (kStars - 1.0))});
  return stars;
}

void expect_effect_contract(const EffectScene& scene) {
  SCOPED_TRACE(scene.effect);
  expect_runs_and_changes(scene);
  if (testing::Test::HasFatalFailure()) return;
  expect_identity_at_zero(scene);
  expect_declared_planes_only(scene);
  expect_same_bits_however_it_runs(scene);
  expect_window_equals_full_frame(scene);
}

}  // namespace astroid::test
