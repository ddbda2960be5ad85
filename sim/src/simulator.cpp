#include "astroid/sim/simulator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/units.hpp"
#include "astroid/sim/rolling_shutter.hpp"

namespace astroid {

namespace {

bool is_pointing(const EffectSpec& spec) {
  return spec.level == EffectLevel::kPointing;
}
bool is_expectation(const EffectSpec& spec) {
  return spec.level <= EffectLevel::kPixelMean;
}
bool makes_light(const EffectSpec& spec) {
  return spec.role == ImageRole::kVaryingLight;
}
bool remembers(const EffectSpec& spec) {
  return spec.role == ImageRole::kMemory;
}
bool draws_electrons(const EffectSpec& spec) {
  return (spec.reads & plane_bit::kExpected) != 0 && (spec.writes & plane_bit::kSampled) != 0;
}

void add_image(std::span<double> sum, std::span<const double> image) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += image[i];
}

/// Attitude is the spacecraft's: its streams leave out the camera, so cameras share it.
std::uint32_t stream_camera(const EffectSpec& spec, int camera) {
  return is_pointing(spec) ? 0U : static_cast<std::uint32_t>(camera) + 1U;
}

/// What all exposures of a camera have in common.
FrameHeader common_header(const Mission& mission, int camera) {
  FrameHeader header;
  header.camera = camera;
  header.exposure_time = mission.simulation.exposure_time;
  header.gain = mission.ccd.gain;
  // Of a fitted ramp: the noise that the fit leaves, and the range of what is delivered.
  header.readout_noise = mission.ccd.readout_noise * fitted_readout_factor(mission);
  header.bias = mission.ccd.bias;
  const Adu top(adc_top(delivered_bits(mission)));
  header.saturation = std::min(mission.ccd.full_well / mission.ccd.gain + mission.ccd.bias, top);
  if (ramp_noise(mission).reads > 1)
    header.saturation = std::min(Electrons(saturation_electrons(mission)) / mission.ccd.gain + mission.ccd.bias, top);
  return header;
}

void set_time(const Scene& scene, std::int64_t exposure, FrameHeader& header) {
  header.exposure = exposure;
  header.mid_time = scene.mid_time(exposure);
  header.mid_mjd = scene.mission().simulation.start_mjd + header.mid_time.value() / kSecondsPerDay;
}

}  // namespace

std::shared_ptr<const AttitudeSeries> make_attitude_series(const Scene& scene, const Plan& plan) {
  auto series = std::make_shared<AttitudeSeries>();
  const JitterTreatment treatment = plan.knobs.jitter;
  if (treatment == JitterTreatment::kNone) return series;
  series->steps = plan.knobs.attitude_steps;
  // What the plan leaves out is left out here too.
  const AttitudeParts parts{.jitter = plan.runs("jitter-model") || plan.runs("jitter-file"),
                            .drift = plan.runs("drift"),
                            .repointing = plan.runs("re-pointing")};
  const auto add = [&](std::span<const Attitude> exposure) {
    series->moments.push_back(attitude_moments(exposure));
    for (const Attitude& a : exposure)
      series->farthest = {std::max(series->farthest.yaw, std::fabs(a.yaw)),
                          std::max(series->farthest.pitch, std::fabs(a.pitch)),
                          std::max(series->farthest.roll, std::fabs(a.roll))};
    // What grows with the exposures is kept small: steps only where nothing else will do.
    if (treatment == JitterTreatment::kSubSteps)
      series->samples.insert(series->samples.end(), exposure.begin(), exposure.end());
    if (treatment == JitterTreatment::kPolynomial) {
      const auto number = static_cast<std::int64_t>(series->moments.size() - 1) / series->bands;
      const std::vector<float> weights = exposure_weights(plan.knobs.polynomial, exposure, plan.place_in_epoch(number));
      series->weights.insert(series->weights.end(), weights.begin(), weights.end());
    }
  };
  const SimulationSettings& simulation = scene.mission().simulation;
  if (!plan.runs("rolling-shutter") || plan.knobs.band_rows <= 0) {
    scene.attitude(parts)->for_each_exposure(simulation.exposures, series->steps, add);
    return series;
  }
  const std::vector<Seconds> times = band_times(scene.mission(), plan.knobs.band_rows);
  series->bands = static_cast<int>(times.size());
  const auto steps = static_cast<std::size_t>(series->steps);
  for_each_exposure_at(*scene.gapless_attitude(parts), simulation, times, simulation.exposures, series->steps,
                       [&](std::span<const Attitude> bands) {
                         for (std::size_t b = 0; b < times.size(); ++b) add(bands.subspan(b * steps, steps));
                       });
  return series;
}

Simulator::Simulator(std::shared_ptr<const Scene> scene, std::shared_ptr<const Plan> plan, int camera,
                     std::shared_ptr<const AttitudeSeries> attitude)
    : scene_(std::move(scene)),
      plan_(std::move(plan)),
      attitude_(std::move(attitude)),
      whole_(whole_strip(*plan_->layout)),
      exposed_(exposed_strip(*plan_->layout)) {
  constexpr std::size_t kMostEpochs = 3;  // workers are at most a block of exposures apart
  camera_.layout = plan_->layout;
  camera_.strips = make_strips(*plan_->layout, kStripPixels, plan_->knobs.band_rows);
  for (const Strip& strip : camera_.strips) longest_strip_ = std::max(longest_strip_, strip.size());
  if (attitude_ == nullptr) attitude_ = make_attitude_series(*scene_, *plan_);
  camera_.camera = camera;
  varies_ = std::ranges::any_of(plan_->effects,
                                [](const PlannedEffect& e) { return e.need.needed && makes_light(e.effect->spec()); });
  remembers_ = std::ranges::any_of(plan_->effects,
                                   [](const PlannedEffect& e) { return e.need.needed && remembers(e.effect->spec()); });
  constant_ = conditions_of(*plan_, *scene_, 0);
  header_ = common_header(scene_->mission(), camera);
  for (const PlannedEffect& planned : plan_->effects) {
    const EffectSpec& spec = planned.effect->spec();
    streams_.push_back(make_stream(scene_->mission().simulation.seed, spec.id, stream_camera(spec, camera), 0));
    if (planned.need.needed)
      planned.effect->prepare(
          camera_, {.scene = *scene_, .knobs = plan_->knobs, .stream = streams_.back(), .attitude = *attitude_});
  }
  if (plan_->still) {
    still_ = std::make_shared<const StillImages>(kMostEpochs);
    still_->get(0, [this] { return render({}, constant_); });
  }
  if (plan_->knobs.jitter == JitterTreatment::kPolynomial)
    moving_ = std::make_shared<const MovingImage>(plan_->knobs.polynomial, plan_->layout->size());
  if (remembers_) {
    // Those of the latest exposure, and of workers that are a few blocks behind.
    const std::int64_t block = plan_->knobs.memory_block;
    const std::size_t images = block > 0 ? static_cast<std::size_t>(camera_.cmos.persistence->reach() / block) : 0;
    constexpr std::size_t kMore = 4;
    past_ = std::make_shared<const PastImages>(images + kMore);
  }
  stages_ = make_stages(source(), false);
}

Simulator::Source Simulator::source() const {
  return still_ != nullptr || moving_ != nullptr ? Source::kRecall : Source::kRender;
}

std::vector<Simulator::Step> Simulator::expected_steps(Source source) const {
  std::vector<Step> steps;
  std::size_t light =
      plan_->effects.size();  // the first effect that makes light: the image as a whole is put down to it
  for (std::size_t i = 0; i < plan_->effects.size(); ++i) {
    const EffectSpec& spec = plan_->effects[i].effect->spec();
    if (is_pointing(spec) || !is_expectation(spec)) continue;  // begin()
    if (spec.role == ImageRole::kLight) light = std::min(light, i);
    // What is recalled has everything but the varying light, which goes its own way through the responses.
    const bool applies = source == Source::kRender || makes_light(spec) || spec.role == ImageRole::kResponse;
    if (plan_->effects[i].need.needed && applies && !remembers(spec)) steps.push_back({Act::kApply, i});
  }
  if (source == Source::kRender || varies_) steps.insert(steps.begin(), {Act::kClear, light});
  if (source == Source::kRecall && varies_) steps.push_back({Act::kAddRecalled, light});
  if (source == Source::kRecall && !varies_) steps = {{Act::kRecall, light}};
  for (std::size_t i = 0; i < plan_->effects.size(); ++i)
    if (plan_->effects[i].need.needed && remembers(plan_->effects[i].effect->spec())) steps.push_back({Act::kApply, i});
  return steps;
}

bool Simulator::reads_by_strips() const {
  return std::ranges::all_of(plan_->effects, [](const PlannedEffect& e) {
    return !e.need.needed || !e.effect->spec().per_read || is_local(e.effect->spec());
  });
}

std::vector<Simulator::Stage> Simulator::make_stages(Source source, bool until_expected, bool whole_frame) const {
  // A strip sees all its reads while it is in the cache, unless something between them needs more than a strip.
  const bool by_strips = !whole_frame && reads_by_strips();
  std::vector<Stage> stages;
  const auto add = [&](Step step) {
    const EffectSpec& spec = plan_->effects[step.effect].effect->spec();
    const bool local = step.act != Act::kApply || is_local(spec);
    step.per_read = plan_->reads > 1 && spec.per_read;
    const bool per_read = step.per_read && !by_strips;
    if (stages.empty() || stages.back().local != local || stages.back().per_read != per_read)
      stages.push_back({.local = local, .per_read = per_read, .steps = {}});
    stages.back().steps.push_back(step);
  };
  for (const Step& step : expected_steps(source)) add(step);
  for (std::size_t i = 0; !until_expected && i < plan_->effects.size(); ++i) {
    const EffectSpec& spec = plan_->effects[i].effect->spec();
    if (is_expectation(spec)) continue;
    if (plan_->effects[i].need.needed) {
      add({Act::kApply, i});
    } else if (draws_electrons(spec)) {
      add({Act::kTakeExpected, i});
    }
  }
  return stages;
}

ExposureState Simulator::make_state() const {
  ExposureState state;
  const std::shared_ptr<const PixelLayout>& layout = plan_->layout;
  state.expected = {layout, longest_strip_};
  state.sampled = {layout, longest_strip_};
  state.analog = {layout, longest_strip_};
  state.frame.pixels = Plane<float, unit::Adu>(scene_->layout());
  state.frame.flags = Plane<std::uint8_t, unit::Flags>(scene_->layout());
  if (layout != scene_->layout()) {
    state.more = std::make_unique<Frame>();
    state.more->pixels = Plane<float, unit::Adu>(layout);
    state.more->flags = Plane<std::uint8_t, unit::Flags>(layout);
  }
  state.effect_seconds.assign(plan_->effects.size(), 0.0);
  // An effect that needs more than a strip finds whole planes, and so does the next read.
  std::uint32_t whole = 0;
  for (const Stage& stage : stages_)
    for (const Step& step : stage.steps)
      if (!stage.local || stage.per_read)
        whole |= plan_->effects[step.effect].effect->spec().reads | plan_->effects[step.effect].effect->spec().writes;
  if ((whole & plane_bit::kExpected) != 0) state.expected.make_whole();
  if ((whole & plane_bit::kSampled) != 0) state.sampled.make_whole();
  if ((whole & plane_bit::kAnalog) != 0) state.analog.make_whole();
  if (plan_->reads > 1) {
    state.ramps = RampPlanes(layout, longest_strip_);
    if ((whole & plane_bit::kRamp) != 0) state.ramps.make_whole();
  }
  return state;
}

void Simulator::begin(std::int64_t exposure, ExposureState& state) const {
  begin_light(exposure, state);
  if (!remembers_) return;
  state.still = false;
  const Mission& mission = scene_->mission();
  const double quarter = mission.satellite.quarter_days * kSecondsPerDay / mission.simulation.cycle.value();
  for (const PastCharge& past : past_charge(*camera_.cmos.persistence, exposure, plan_->knobs.memory_block, quarter))
    state.past.push_back({.electrons = past_image(past.exposure), .share = past.share});
}

std::shared_ptr<const Plane<float, unit::ExpectedElectrons>> Simulator::past_image(std::int64_t exposure) const {
  return past_->get(exposure, [&] {
    ExposureState state = make_state();
    state.expected.make_whole();
    begin_light(exposure, state);
    std::vector<Stage> stages = make_stages(source(), true);
    for (Stage& stage : stages)
      std::erase_if(stage.steps, [this](const Step& step) {
        return step.act == Act::kApply && remembers(plan_->effects[step.effect].effect->spec());
      });
    run(stages, state);
    const std::span<const double> electrons = state.still ? state.recalled->pixels() : state.expected.whole().pixels();
    Plane<float, unit::ExpectedElectrons> image(plan_->layout);
    const double full_well = scene_->mission().ccd.full_well.value();
    std::ranges::transform(electrons, image.pixels().begin(),
                           [&](double e) { return static_cast<float>(std::min(e, full_well)); });
    return image;
  });
}

void Simulator::begin_light(std::int64_t exposure, ExposureState& state) const {
  state.camera = camera_.camera;
  state.exposure = exposure;
  state.number = scene_->mission_number(exposure);
  state.read = 0;
  state.attitude = {};
  state.attitude_steps = {};
  state.bands = {};
  state.line_time = Seconds(0.0);
  state.moving.clear();
  state.past.clear();
  state.recalled = nullptr;
  state.still = false;
  state.lost_electrons = 0.0;
  state.clipped_pixels = 0;
  state.ringing = {};
  std::ranges::fill(state.computed().flags.pixels(), std::uint8_t{0});
  state.frame.header = header_;
  set_time(*scene_, exposure, state.frame.header);
  const std::int64_t epoch = plan_->epoch(exposure);
  state.conditions =
      plan_->epoch_exposures > 0 ? conditions_of(*plan_, *scene_, epoch, plan_->place_in_epoch(exposure)) : constant_;
  for (std::size_t i = 0; i < plan_->effects.size(); ++i)
    if (plan_->effects[i].need.needed && is_pointing(plan_->effects[i].effect->spec()))
      take({Act::kApply, i}, state, whole_);
  const Conditions& conditions = state.conditions;
  if (still_ != nullptr) {
    state.recalled = still_->get(epoch, [&] { return render({}, conditions); });
    state.still = !varies_;
  }
  if (moving_ == nullptr) return;
  const std::size_t maps = plan_->knobs.polynomial.terms.size() - 1;
  const auto bands = static_cast<std::size_t>(attitude_->bands);
  const bool in_time = plan_->knobs.polynomial.highest_power_of_time() > 0;
  const RenderAt at = [&](const MotionPoint& point) {
    return render(point.attitude, in_time ? conditions_of(*plan_, *scene_, epoch, point.time) : conditions);
  };
  for (std::size_t band = 0; band < bands; ++band) {
    const std::size_t window = static_cast<std::size_t>(exposure) * bands + band;
    const Attitude& mean = bands > 1 ? attitude_->moments[window].mean : state.attitude.mean;
    state.moving.push_back(
        moving_->exposure(epoch, mean, std::span(attitude_->weights).subspan(window * maps, maps), at));
  }
}

void Simulator::recall_moving(const ExposureState& state, const Strip& strip, std::span<double> expected) const {
  if (state.moving.size() == 1) {
    state.moving.front().recall(strip, expected);
    return;
  }
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {  // each within one band
    const Rectangle& area = strip.areas[a];
    Strip part{.begin = strip.area_begins[a], .end = strip.area_begins[a], .areas = {}, .area_begins = {}};
    part.add(area);
    const auto band = static_cast<std::size_t>(std::max(0, area.y0 / plan_->knobs.band_rows));
    state.moving[std::min(band, state.moving.size() - 1)].recall(
        part, expected.subspan(part.begin - strip.begin, part.size()));
  }
}

void Simulator::simulate(std::int64_t exposure, ExposureState& state, const StepObserver& observer) const {
  begin(exposure, state);
  if (observer) {
    state.expected.make_whole();
    state.sampled.make_whole();
    state.analog.make_whole();
    if (plan_->reads > 1) state.ramps.make_whole();
    for (const PlannedEffect& planned : plan_->effects)
      if (planned.need.needed && is_pointing(planned.effect->spec())) observer(planned.effect->spec(), state);
    // What is recalled has no steps to see; they are shown as rendered, and the exposure goes on from what it has.
    if (source() == Source::kRecall) run(make_stages(Source::kRender, true), state, observer);
  }
  run(observer ? make_stages(source(), false, true) : stages_, state, observer);
  deliver(state);
}

void Simulator::expect(std::int64_t exposure, ExposureState& state) const {
  begin(exposure, state);
  state.expected.make_whole();
  run(make_stages(source(), true), state);
  if (!state.still) return;
  std::ranges::copy(state.recalled->pixels(), state.expected.whole().pixels().begin());
  state.still = false;
}

void Simulator::apply_alone(std::size_t effect, std::int64_t exposure, ExposureState& state) const {
  begin(exposure, state);
  state.still = false;
  run({{.local = is_local(plan_->effects[effect].effect->spec()), .per_read = false, .steps = {{Act::kApply, effect}}}},
      state);
}

Plane<double, unit::ExpectedElectrons> Simulator::render(const Attitude& attitude, const Conditions& conditions) const {
  ExposureState state;
  state.expected = {plan_->layout, longest_strip_};
  state.expected.make_whole();
  state.effect_seconds.assign(plan_->effects.size(), 0.0);
  state.attitude.mean = attitude;
  state.conditions = conditions;
  std::vector<Stage> stages = make_stages(Source::kRender, true);
  for (Stage& stage : stages)
    std::erase_if(stage.steps, [this](const Step& step) {
      if (step.act != Act::kApply) return false;
      const EffectSpec& spec = plan_->effects[step.effect].effect->spec();
      return makes_light(spec) || remembers(spec);
    });
  run(stages, state);
  return std::move(state.expected.whole());
}

void Simulator::run(const std::vector<Stage>& stages, ExposureState& state, const StepObserver& observer) const {
  for (auto stage = stages.begin(); stage != stages.end();) {
    const auto next = std::find_if(stage, stages.end(), [&](const Stage& s) { return s.per_read != stage->per_read; });
    const int reads = stage->per_read ? plan_->reads : 1;
    for (state.read = 0; state.read < reads; ++state.read)
      for (auto s = stage; s != next; ++s) run(*s, state, observer);
    state.read = 0;
    stage = next;
  }
}

void Simulator::run(const Stage& stage, ExposureState& state, const StepObserver& observer) const {
  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  const auto timed = [&](const Step& step, const Strip& strip) {
    if (!is_for(step, strip)) return;
    take(step, state, strip);
    const auto now = Clock::now();
    state.effect_seconds[step.effect] += std::chrono::duration<double>(now - last).count();
    last = now;
  };
  if (observer) {  // who wants to see every step on the whole frame
    for (const Step& step : stage.steps) {
      if (stage.local)
        for (const Strip& strip : camera_.strips) timed(step, strip);
      else
        timed(step, exposed_or_whole(step));
      if (step.act == Act::kApply) observer(plan_->effects[step.effect].effect->spec(), state);
    }
    return;
  }
  if (!stage.local) {
    for (const Step& step : stage.steps) timed(step, exposed_or_whole(step));
    return;
  }
  for (const Strip& strip : camera_.strips) {
    last = Clock::now();
    if (stage.per_read || plan_->reads == 1) {
      for (const Step& step : stage.steps) timed(step, strip);
      continue;
    }
    for (auto step = stage.steps.begin(); step != stage.steps.end();) {
      const auto next =
          std::find_if(step, stage.steps.end(), [&](const Step& s) { return s.per_read != step->per_read; });
      const int reads = step->per_read ? plan_->reads : 1;
      for (state.read = 0; state.read < reads; ++state.read)
        for (auto again = step; again != next; ++again) timed(*again, strip);
      state.read = 0;
      step = next;
    }
  }
}

const Strip& Simulator::exposed_or_whole(const Step& step) const {
  return plan_->effects[step.effect].effect->spec().pixels == PixelSet::kAll ? whole_ : exposed_;
}

bool Simulator::is_for(const Step& step, const Strip& strip) const {
  return strip.exposed || step.act != Act::kApply ||
         plan_->effects[step.effect].effect->spec().pixels == PixelSet::kAll;
}

void Simulator::take_expected(ExposureState& state, const Strip& strip) const {
  // Without shot noise a pixel holds what is expected of it: all of it, or what has come until this read.
  if (plan_->reads > 1) {
    const double share = static_cast<double>(state.read) / (plan_->reads - 1);
    scale_values(state.expectation(strip), share, state.sampled.pixels(strip));
  } else {
    std::ranges::copy(state.expectation(strip), state.sampled.pixels(strip).begin());
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
      if (moving_ != nullptr)
        recall_moving(state, strip, state.expected.pixels(strip));
      else if (!state.still)  // which is read where it lies, unless something is done to it
        std::ranges::copy(state.recalled->pixels().subspan(strip.begin, strip.size()),
                          state.expected.pixels(strip).begin());
      return;
    case Act::kAddRecalled: {
      const std::span<double> expected = state.expected.pixels(strip);
      if (state.recalled != nullptr) {
        add_image(expected, state.recalled->pixels().subspan(strip.begin, strip.size()));
        return;
      }
      state.scratch.resize(strip.size());
      recall_moving(state, strip, state.scratch);
      add_image(expected, state.scratch);
      return;
    }
    case Act::kTakeExpected:
      take_expected(state, strip);
      return;
  }
}

void Simulator::deliver(ExposureState& state) const {
  if (state.more == nullptr) return;
  const PixelLayout& delivered = *scene_->layout();
  const PixelLayout& computed = *plan_->layout;
  for (std::size_t r = 0; r < delivered.regions().size(); ++r) {
    const Rectangle& region = delivered.regions()[r];
    // Exposed regions keep their order, unless all of the detector is computed; reference regions are joined anew.
    const std::span<const Rectangle> exposed = computed.exposed_regions();
    const bool whole = exposed.size() == 1 && exposed.front() == scene_->detector();
    std::size_t from = whole ? 0 : r;
    if (r >= delivered.exposed_regions().size()) {
      const auto holds = [&](const Rectangle& area) { return intersect(area, region) == region; };
      const auto found = std::ranges::find_if(computed.reference_regions(), holds);
      ASTROID_CHECK_EQ(found != computed.reference_regions().end(), true);
      from = exposed.size() + static_cast<std::size_t>(found - computed.reference_regions().begin());
    }
    const auto first = static_cast<std::size_t>(region.x0 - computed.regions()[from].x0);
    for (int y = region.y0; y < region.y1(); ++y) {
      const auto width = static_cast<std::size_t>(region.nx);
      std::ranges::copy(state.more->pixels.view(from).row(y).subspan(first, width),
                        state.frame.pixels.view(r).row(y).begin());
      std::ranges::copy(state.more->flags.view(from).row(y).subspan(first, width),
                        state.frame.flags.view(r).row(y).begin());
    }
  }
}

}  // namespace astroid
