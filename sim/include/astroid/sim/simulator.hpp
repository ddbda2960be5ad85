// Makes exposures according to a plan.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "astroid/sim/effect.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Called after each effect of an exposure, for `--dump-steps`.
using StepObserver = std::function<void(const EffectSpec&, const ExposureState&)>;

/// The attitude of every exposure as the plan wants it.
std::shared_ptr<const AttitudeSeries> make_attitude_series(const Scene& scene, const Plan& plan);

/// Simulates the exposures of one camera. Immutable after construction; workers share it, each with its own state.
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
  /// @thread safe for different states
  void simulate(std::int64_t exposure, ExposureState& state, const StepObserver& observer = {}) const;

  /// Expected electrons of an exposure (everything up to photon noise), without drawing anything per exposure.
  void expect(std::int64_t exposure, ExposureState& state) const;

 private:
  void run(std::int64_t exposure, ExposureState& state, bool until_expected, const StepObserver& observer) const;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const Plan> plan_;
  CameraState camera_;
  std::vector<RandomStream> streams_;  // of plan().effects
  std::shared_ptr<const AttitudeSeries> attitude_;
};

}  // namespace astroid
