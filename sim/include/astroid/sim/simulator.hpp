// Makes exposures according to a plan.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "astroid/sim/effect.hpp"
#include "astroid/sim/moving_image.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/recent_images.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Called after each effect of an exposure, for `--dump-steps`.
using StepObserver = std::function<void(const EffectSpec&, const ExposureState&)>;

/// The attitude of every exposure as the plan wants it.
std::shared_ptr<const AttitudeSeries> make_attitude_series(const Scene& scene, const Plan& plan);

/// Simulates the exposures of one camera. Immutable after construction; workers share it, each with its own state.
///
/// Effects that work on each pixel alone run strip by strip, all of them on one strip before the next, so what they
/// hand on stays in the cache. Effects that need more than a pixel see the whole frame. A noiseless image that does not
/// change, or changes little, is computed once and recalled; light that differs from exposure to exposure is added.
/// Where effects reach beyond the delivered pixels, those that they depend on are computed too and left out at the end.
class Simulator {
 public:
  /// Draws what is fixed for the camera and computes what does not change. @param camera  0-based
  /// @param attitude  of make_attitude_series(), for cameras to share; computed here when there is none
  Simulator(std::shared_ptr<const Scene> scene, std::shared_ptr<const Plan> plan, int camera,
            std::shared_ptr<const AttitudeSeries> attitude = nullptr);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Plan& plan() const { return *plan_; }
  [[nodiscard]] int camera() const { return camera_.camera; }

  /// A state whose planes have the right size, to be used again and again by one worker.
  [[nodiscard]] ExposureState make_state() const;

  /// Makes one exposure; the result is state.frame. The same bits whatever was in the state before.
  /// @param observer  sees every step, each on the whole frame.
  /// @thread safe for different states
  void simulate(std::int64_t exposure, ExposureState& state, const StepObserver& observer = {}) const;

  /// Expected electrons of an exposure (everything up to photon noise) in state.expected.whole(), the same as
  /// simulate() draws from.
  void expect(std::int64_t exposure, ExposureState& state) const;

  /// Applies one effect of the plan to the planes of a state as they are, on all computed pixels: for tests of what an
  /// effect alone does.  @param state  with whole planes
  void apply_alone(std::size_t effect, std::int64_t exposure, ExposureState& state) const;

 private:
  using StillImages = RecentImages<std::int64_t, Plane<double, unit::ExpectedElectrons>>;
  using PastImages = RecentImages<std::int64_t, Plane<float, unit::ExpectedElectrons>>;
  /// The noiseless image.
  enum class Source : std::uint8_t {
    kRender,  ///< effect by effect
    kRecall,  ///< from what was computed once
  };
  enum class Act : std::uint8_t {
    kApply,         ///< an effect
    kClear,         ///< no light yet
    kRecall,        ///< the noiseless image
    kAddRecalled,   ///< to the light that varies
    kTakeExpected,  ///< as drawn electrons, where photon noise is off
  };
  struct Step {
    Act act;
    std::size_t effect;     ///< of the plan, or the one that the time is put down to
    bool per_read = false;  ///< taken again for every read of an exposure
  };
  /// Steps that run one after the other on each strip, or on the whole frame.
  struct Stage {
    bool local;
    bool per_read;  ///< the stage and its neighbours of the same kind are run again for every read
    std::vector<Step> steps;
  };

  /// @param whole_frame  each step sees the whole frame, as an observer wants it.
  [[nodiscard]] std::vector<Stage> make_stages(Source source, bool until_expected, bool whole_frame = false) const;
  [[nodiscard]] bool reads_by_strips() const;
  [[nodiscard]] std::vector<Step> expected_steps(Source source) const;
  [[nodiscard]] Source source() const;
  void begin(std::int64_t exposure, ExposureState& state) const;
  void begin_light(std::int64_t exposure, ExposureState& state) const;  // all but what earlier exposures left
  [[nodiscard]] std::shared_ptr<const Plane<float, unit::ExpectedElectrons>> past_image(std::int64_t exposure) const;
  void recall_moving(const ExposureState& state, const Strip& strip, std::span<double> expected) const;
  void run(const std::vector<Stage>& stages, ExposureState& state, const StepObserver& observer = {}) const;
  void run(const Stage& stage, ExposureState& state, const StepObserver& observer) const;
  void take_expected(ExposureState& state, const Strip& strip) const;
  void take(const Step& step, ExposureState& state, const Strip& strip) const;
  [[nodiscard]] const Strip& exposed_or_whole(const Step& step) const;
  [[nodiscard]] bool is_for(const Step& step, const Strip& strip) const;
  void deliver(ExposureState& state) const;
  [[nodiscard]] Plane<double, unit::ExpectedElectrons> render(const Attitude& attitude,
                                                              const Conditions& conditions) const;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const Plan> plan_;
  CameraState camera_;
  std::vector<RandomStream> streams_;  // of plan().effects
  std::shared_ptr<const AttitudeSeries> attitude_;
  Strip whole_;
  Strip exposed_;
  std::size_t longest_strip_ = 0;
  bool varies_ = false;                        // light differs from exposure to exposure
  bool remembers_ = false;                     // what earlier exposures left is added
  Conditions constant_;                        // where conditions do not change
  FrameHeader header_;                         // what exposures have in common
  std::shared_ptr<const StillImages> still_;   // the noiseless images, if nothing moves, one for each epoch
  std::shared_ptr<const MovingImage> moving_;  // if little does
  std::shared_ptr<const PastImages> past_;     // what traps saw in earlier exposures, if they remember
  std::vector<Stage> stages_;                  // of an exposure
};

}  // namespace astroid
