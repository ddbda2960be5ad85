#include "astroid/sim/simulator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "astroid/core/digitise.hpp"

namespace astroid {

namespace {

bool is_pointing(const EffectSpec& spec) {
  return spec.level == EffectLevel::kPointing;
}
bool is_expectation(const EffectSpec& spec) {
  return spec.level <= EffectLevel::kPixelMean;
}
bool draws_electrons(const EffectSpec& spec) {
  return (spec.reads & plane_bit::kExpected) != 0 && (spec.writes & plane_bit::kSampled) != 0;
}

/// Attitude is the spacecraft's: its streams leave out the camera, so cameras share it.
std::uint32_t stream_camera(const EffectSpec& spec, int camera) {
  return is_pointing(spec) ? 0U : static_cast<std::uint32_t>(camera) + 1U;
}

void fill_header(const Scene& scene, int camera, std::int64_t exposure, FrameHeader& header) {
  const Mission& mission = scene.mission();
  header.camera = camera;
  header.exposure = exposure;
  header.mid_time = scene.mid_time(exposure);
  constexpr double kSecondsPerDay = 86400.0;
  header.mid_mjd = mission.simulation.start_mjd + header.mid_time.value() / kSecondsPerDay;
  header.exposure_time = mission.simulation.exposure_time;
  header.gain = mission.ccd.gain;
  header.readout_noise = mission.ccd.readout_noise;
  header.bias = mission.ccd.bias;
  header.saturation =
      std::min(mission.ccd.full_well / mission.ccd.gain + mission.ccd.bias, Adu(adc_top(mission.ccd.adc_bits)));
}

}  // namespace

std::shared_ptr<const AttitudeSeries> make_attitude_series(const Scene& scene, const Plan& plan) {
  auto series = std::make_shared<AttitudeSeries>();
  const JitterTreatment treatment = plan.knobs.jitter;
  if (treatment == JitterTreatment::kNone) return series;
  series->steps = plan.knobs.attitude_steps;
  scene.attitude().for_each_exposure(
      scene.mission().simulation.exposures, series->steps, [&](std::span<const Attitude> exposure) {
        series->moments.push_back(attitude_moments(exposure));
        for (const Attitude& a : exposure)
          series->farthest = {std::max(series->farthest.yaw, std::fabs(a.yaw)),
                              std::max(series->farthest.pitch, std::fabs(a.pitch)),
                              std::max(series->farthest.roll, std::fabs(a.roll))};
        // What grows with the exposures is kept small: steps only where nothing else will do.
        if (treatment == JitterTreatment::kSubSteps)
          series->samples.insert(series->samples.end(), exposure.begin(), exposure.end());
        if (treatment == JitterTreatment::kPolynomial) {
          const std::vector<float> weights = exposure_weights(plan.knobs.polynomial, exposure);
          series->weights.insert(series->weights.end(), weights.begin(), weights.end());
        }
      });
  return series;
}

Simulator::Simulator(std::shared_ptr<const Scene> scene, std::shared_ptr<const Plan> plan, int camera,
                     std::shared_ptr<const AttitudeSeries> attitude)
    : scene_(std::move(scene)),
      plan_(std::move(plan)),
      attitude_(std::move(attitude)),
      whole_(whole_strip(*scene_->layout())) {
  camera_.strips = make_strips(*scene_->layout(), kStripPixels);
  for (const Strip& strip : camera_.strips) longest_strip_ = std::max(longest_strip_, strip.size());
  if (attitude_ == nullptr) attitude_ = make_attitude_series(*scene_, *plan_);
  camera_.camera = camera;
  for (const PlannedEffect& planned : plan_->effects) {
    const EffectSpec& spec = planned.effect->spec();
    streams_.push_back(make_stream(scene_->mission().simulation.seed, spec.id, stream_camera(spec, camera), 0));
    if (planned.need.needed)
      planned.effect->prepare(
          camera_, {.scene = *scene_, .knobs = plan_->knobs, .stream = streams_.back(), .attitude = *attitude_});
  }
  if (plan_->still) still_ = render({});
  if (plan_->knobs.jitter == JitterTreatment::kPolynomial)
    moving_ = std::make_shared<const MovingImage>(plan_->knobs.polynomial);
  stages_ = make_stages(source(), false);
}

Simulator::Source Simulator::source() const {
  return !still_.empty() || moving_ != nullptr ? Source::kRecall : Source::kRender;
}

std::vector<Simulator::Stage> Simulator::make_stages(Source source, bool until_expected) const {
  std::vector<Stage> stages;
  const auto add = [&stages](bool local, Step step) {
    if (stages.empty() || stages.back().local != local) stages.push_back({.local = local, .steps = {}});
    stages.back().steps.push_back(step);
  };
  bool begun = false;
  for (std::size_t i = 0; i < plan_->effects.size(); ++i) {
    const EffectSpec& spec = plan_->effects[i].effect->spec();
    const bool needed = plan_->effects[i].need.needed;
    if (is_pointing(spec)) continue;  // begin()
    if (is_expectation(spec)) {
      if (!begun) add(true, {source == Source::kRecall ? Act::kRecall : Act::kClear, i});
      begun = true;
      if (source == Source::kRender && needed) add(is_local(spec), {Act::kApply, i});
    } else if (!until_expected && needed) {
      add(is_local(spec), {Act::kApply, i});
    } else if (!until_expected && draws_electrons(spec)) {
      add(true, {Act::kTakeExpected, i});
    }
  }
  return stages;
}

ExposureState Simulator::make_state() const {
  ExposureState state;
  const std::shared_ptr<const PixelLayout>& layout = scene_->layout();
  state.expected = {layout, longest_strip_};
  state.sampled = {layout, longest_strip_};
  state.analog = {layout, longest_strip_};
  state.frame.pixels = Plane<float, unit::Adu>(layout);
  state.frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  state.effect_seconds.assign(plan_->effects.size(), 0.0);
  // An effect that needs more than a strip finds whole planes.
  std::uint32_t whole = 0;
  for (const Stage& stage : stages_)
    for (const Step& step : stage.steps)
      if (!stage.local)
        whole |= plan_->effects[step.effect].effect->spec().reads | plan_->effects[step.effect].effect->spec().writes;
  if ((whole & plane_bit::kExpected) != 0) state.expected.make_whole();
  if ((whole & plane_bit::kSampled) != 0) state.sampled.make_whole();
  if ((whole & plane_bit::kAnalog) != 0) state.analog.make_whole();
  return state;
}

void Simulator::begin(std::int64_t exposure, ExposureState& state) const {
  state.camera = camera_.camera;
  state.exposure = exposure;
  state.attitude = {};
  state.attitude_steps = {};
  state.still = nullptr;
  state.lost_electrons = 0.0;
  state.clipped_pixels = 0;
  std::ranges::fill(state.frame.flags.pixels(), std::uint8_t{0});
  fill_header(*scene_, camera_.camera, exposure, state.frame.header);
  for (std::size_t i = 0; i < plan_->effects.size(); ++i)
    if (plan_->effects[i].need.needed && is_pointing(plan_->effects[i].effect->spec()))
      take({Act::kApply, i}, state, whole_);
  if (moving_ == nullptr) return;
  const std::size_t maps = plan_->knobs.polynomial.terms.size() - 1;
  const auto weights = std::span(attitude_->weights).subspan(static_cast<std::size_t>(exposure) * maps, maps);
  state.moving = moving_->exposure(state.attitude.mean, weights, [this](const Attitude& a) { return render(a); });
}

void Simulator::simulate(std::int64_t exposure, ExposureState& state, const StepObserver& observer) const {
  begin(exposure, state);
  if (!still_.empty() && !observer) state.still = &still_;
  if (observer) {
    state.expected.make_whole();
    state.sampled.make_whole();
    state.analog.make_whole();
    for (const PlannedEffect& planned : plan_->effects)
      if (planned.need.needed && is_pointing(planned.effect->spec())) observer(planned.effect->spec(), state);
    // What is recalled has no steps to see; they are shown as rendered, and the exposure goes on from what it has.
    if (source() == Source::kRecall) run(make_stages(Source::kRender, true), state, observer);
  }
  run(stages_, state, observer);
}

void Simulator::expect(std::int64_t exposure, ExposureState& state) const {
  begin(exposure, state);
  state.expected.make_whole();
  run(make_stages(source(), true), state);
}

Plane<double, unit::ExpectedElectrons> Simulator::render(const Attitude& attitude) const {
  ExposureState state;
  state.expected = {scene_->layout(), longest_strip_};
  state.expected.make_whole();
  state.effect_seconds.assign(plan_->effects.size(), 0.0);
  state.attitude.mean = attitude;
  run(make_stages(Source::kRender, true), state);
  return std::move(state.expected.whole());
}

void Simulator::run(const std::vector<Stage>& stages, ExposureState& state, const StepObserver& observer) const {
  for (const Stage& stage : stages) {
    const bool by_strips = stage.local && !observer;
    for (const Strip& strip : by_strips ? std::span<const Strip>(camera_.strips) : std::span(&whole_, 1)) {
      auto last = std::chrono::steady_clock::now();
      for (const Step& step : stage.steps) {
        take(step, state, strip);
        const auto now = std::chrono::steady_clock::now();
        state.effect_seconds[step.effect] += std::chrono::duration<double>(now - last).count();
        last = now;
        if (observer && step.act == Act::kApply) observer(plan_->effects[step.effect].effect->spec(), state);
      }
    }
  }
}

void Simulator::take(const Step& step, ExposureState& state, const Strip& strip) const {
  switch (step.act) {
    case Act::kApply:
      plan_->effects[step.effect].effect->apply(state,
                                                {.scene = *scene_,
                                                 .knobs = plan_->knobs,
                                                 .camera = camera_,
                                                 .stream = streams_[step.effect],
                                                 .attitude = *attitude_},
                                                strip);
      return;
    case Act::kClear:
      std::ranges::fill(state.expected.pixels(strip), 0.0);
      return;
    case Act::kRecall:
      if (state.still != nullptr) return;  // read where it lies
      if (moving_ != nullptr) {
        state.moving.recall(strip, state.expected.pixels(strip));
      } else {
        std::ranges::copy(still_.pixels().subspan(strip.begin, strip.size()), state.expected.pixels(strip).begin());
      }
      return;
    case Act::kTakeExpected:
      // Without shot noise a pixel holds what is expected of it.
      std::ranges::copy(state.expectation(strip), state.sampled.pixels(strip).begin());
      return;
  }
}

}  // namespace astroid
