// What every effect promises, as one line of a test.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "astroid/core/mission.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid::test {

/// An effect, a mission that calls for it, and how to take its cause away.
struct EffectScene {
  std::string effect;                         ///< its name in the table
  Mission mission;                            ///< in which it runs
  std::function<void(Mission&)> switch_off;   ///< sets its strength to zero; null for what is never off
  std::vector<LabStar> stars = some_stars();  ///< on a detector of at least 200 x 160 px

  /// Stars from 2e3 to 2e6 e- all over 200 x 160 px.
  static std::vector<LabStar> some_stars();
  friend void PrintTo(const EffectScene& scene, std::ostream* out) { *out << scene.effect; }
};

/// Checks that the effect
/// * runs where its mission calls for it, changes the exposure, and leaves no NaN and no negative expectation;
/// * does not run at zero strength, and changes no bit when it is made to;
/// * reads and writes only the planes that it declares;
/// * gives the same bits whatever the state held before, in several threads, in a sub-field, in windows, and in a
///   longer run.
/// Failures are recorded with EXPECT; the macro adds where it was called.
void expect_effect_contract(const EffectScene& scene);

}  // namespace astroid::test

#define EXPECT_EFFECT_CONTRACT(...)                       \
  do {                                                    \
    SCOPED_TRACE("the contract of an effect");            \
    ::astroid::test::expect_effect_contract(__VA_ARGS__); \
  } while (false)
