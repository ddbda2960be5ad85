#include "astroid/sim/simulator.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "astroid/sim/digitise.hpp"

namespace astroid {

namespace {

bool is_pointing(const Effect& effect) {
  return effect.spec().level == EffectLevel::kPointing;
}
bool is_expectation(const Effect& effect) {
  return effect.spec().level <= EffectLevel::kPixelMean;
}

/// Attitude is the spacecraft's: its streams leave out the camera, so cameras share it.
std::uint32_t stream_camera(const Effect& effect, int camera) {
  return is_pointing(effect) ? 0U : static_cast<std::uint32_t>(camera) + 1U;
}

}  // namespace

std::shared_ptr<const AttitudeSeries> make_attitude_series(const Scene& scene, const Plan& plan) {
  auto series = std::make_shared<AttitudeSeries>();
  if (plan.knobs.jitter == JitterTreatment::kNone) return series;
  series->steps = plan.knobs.attitude_steps;
  const bool keep_steps = plan.knobs.jitter == JitterTreatment::kSubSteps;
  scene.attitude().for_each_exposure(
      scene.mission().simulation.exposures, series->steps, [&](std::span<const Attitude> exposure) {
        series->moments.push_back(attitude_moments(exposure));
        if (keep_steps) series->samples.insert(series->samples.end(), exposure.begin(), exposure.end());
      });
  return series;
}

Simulator::Simulator(std::shared_ptr<const Scene> scene, std::shared_ptr<const Plan> plan, int camera,
                     std::shared_ptr<const AttitudeSeries> attitude)
    : scene_(std::move(scene)), plan_(std::move(plan)), attitude_(std::move(attitude)) {
  if (attitude_ == nullptr) attitude_ = make_attitude_series(*scene_, *plan_);
  camera_.camera = camera;
  for (const PlannedEffect& planned : plan_->effects) {
    streams_.push_back(make_stream(scene_->mission().simulation.seed, planned.effect->spec().id,
                                   stream_camera(*planned.effect, camera), 0));
    if (planned.need.needed) planned.effect->prepare(camera_, *scene_, streams_.back());
  }
  if (plan_->still) {
    ExposureState state = make_state();
    expect(0, state);
    camera_.still = std::move(state.expected);
  }
}

ExposureState Simulator::make_state() const {
  ExposureState state;
  const std::shared_ptr<const PixelLayout>& layout = scene_->layout();
  state.expected = Plane<double, unit::ExpectedElectrons>(layout);
  state.sampled = Plane<double, unit::SampledElectrons>(layout);
  state.analog = Plane<double, unit::Adu>(layout);
  state.frame.pixels = Plane<float, unit::Adu>(layout);
  state.frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  state.effect_seconds.assign(plan_->effects.size(), 0.0);
  return state;
}

void Simulator::simulate(std::int64_t exposure, ExposureState& state, const StepObserver& observer) const {
  run(exposure, state, false, observer);
}

void Simulator::expect(std::int64_t exposure, ExposureState& state) const {
  run(exposure, state, true, {});
}

void Simulator::run(std::int64_t exposure, ExposureState& state, bool until_expected,
                    const StepObserver& observer) const {
  const Mission& mission = scene_->mission();
  state.camera = camera_.camera;
  state.exposure = exposure;
  state.attitude = {};
  state.attitude_steps = {};
  state.lost_electrons = 0.0;
  state.clipped_pixels = 0;
  std::ranges::fill(state.frame.flags.pixels(), std::uint8_t{0});
  FrameHeader& header = state.frame.header;
  header.camera = camera_.camera;
  header.exposure = exposure;
  header.mid_time = scene_->mid_time(exposure);
  constexpr double kSecondsPerDay = 86400.0;
  header.mid_mjd = mission.simulation.start_mjd + header.mid_time.value() / kSecondsPerDay;
  header.exposure_time = mission.simulation.exposure_time;
  header.gain = mission.ccd.gain;
  header.readout_noise = mission.ccd.readout_noise;
  header.bias = mission.ccd.bias;
  header.saturation =
      std::min(mission.ccd.full_well / mission.ccd.gain + mission.ccd.bias, Adu(adc_top(mission.ccd.adc_bits)));

  // An observer wants to see every step, so nothing is taken from the cache.
  const bool use_still = !camera_.still.empty() && !observer;
  if (use_still) {
    std::ranges::copy(camera_.still.pixels(), state.expected.pixels().begin());
  } else {
    std::ranges::fill(state.expected.pixels(), 0.0);
  }
  for (std::size_t i = 0; i < plan_->effects.size(); ++i) {
    const Effect& effect = *plan_->effects[i].effect;
    if (!plan_->effects[i].need.needed) {
      // Without shot noise a pixel holds what is expected of it.
      const bool draws_electrons =
          (effect.spec().reads & plane_bit::kExpected) != 0 && (effect.spec().writes & plane_bit::kSampled) != 0;
      if (draws_electrons && !until_expected)
        std::ranges::copy(state.expected.pixels(), state.sampled.pixels().begin());
      continue;
    }
    if (is_expectation(effect) ? use_still : until_expected) continue;
    const auto start = std::chrono::steady_clock::now();
    effect.apply(
        state,
        {.scene = *scene_, .knobs = plan_->knobs, .camera = camera_, .stream = streams_[i], .attitude = *attitude_});
    state.effect_seconds[i] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (observer) observer(effect.spec(), state);
  }
}

}  // namespace astroid
