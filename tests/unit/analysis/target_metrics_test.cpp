#include "astroid/analysis/target_metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/test/synthetic_targets.hpp"

namespace astroid {
namespace {

using test::plato_motion;
using test::plato_setup;
using test::synthetic_estimator;

constexpr double kPpm = 1e6;

TruthStar star_of(double magnitude, double electrons) {
  TruthStar star;
  star.id = "A";
  star.magnitude = magnitude;
  star.electrons = electrons;
  return star;
}

/// A series with the given relative mean and noise, as the estimators would see white noise in 24 hours.
SeriesSummary white_series(double mean, double nsr) {
  SeriesSummary series;
  series.exposures = 24 * 144;
  series.bins = 24;
  series.mean = mean;
  series.exposure = noise_estimate(nsr, series.exposures - 1);
  series.bin_within = noise_estimate(nsr / 12.0, series.exposures - 24);
  series.bin_means = noise_estimate(nsr / 12.0, 23);
  return series;
}

TEST(PredictNoise, FallsWithCamerasAndExposuresWhenNothingMoves) {
  const StarEstimator e = synthetic_estimator(148000.0, 0.0, 9, 0.975);
  const PredictedNoise noise = predict_noise(e, {}, plato_setup());
  EXPECT_DOUBLE_EQ(noise.exposure, e.nsr_exposure);
  EXPECT_NEAR(noise.bin.total(), kPpm * e.nsr_exposure / (12.0 * std::sqrt(24.0)), 1e-9);
  EXPECT_NEAR(noise.bin_simulated, kPpm * e.nsr_exposure / 12.0, 1e-9);
  EXPECT_NEAR(noise.bin_within, noise.bin_simulated, 1e-9);
  EXPECT_EQ(noise.bin_common, 0.0);
}

TEST(PredictNoise, DoesNotAverageJitterOverCameras) {
  const StarEstimator e = synthetic_estimator(148000.0, 0.0, 9, 0.975);
  RunSetup one = plato_setup();
  one.cameras = 1;
  const PredictedNoise few = predict_noise(e, plato_motion(), one);
  const PredictedNoise many = predict_noise(e, plato_motion(), plato_setup());
  EXPECT_DOUBLE_EQ(few.bin.jitter, many.bin.jitter);
  EXPECT_NEAR(few.bin.prnu_jitter / many.bin.prnu_jitter, std::sqrt(24.0), 1e-12);
  EXPECT_NEAR(few.bin.photon / many.bin.photon, std::sqrt(24.0), 1e-12);
}

TEST(PredictNoise, TakesJitterFromGradientAndMotion) {
  StarEstimator e = synthetic_estimator(148000.0, 0.0, 9, 0.975);
  e.gradient_x = 0.1;
  e.gradient_y = 0.2;
  const StarMotion motion{{1e-4, 0.0, 4e-4}, {1e-6, 1e-6, 4e-6}};
  const PredictedNoise noise = predict_noise(e, motion, plato_setup());
  // 0.1² 1e-6 + 2 · 0.1 · 0.2 · 1e-6 + 0.2² 4e-6
  EXPECT_NEAR(noise.bin.jitter, kPpm * std::sqrt(0.01e-6 + 0.04e-6 + 0.16e-6), 1e-9);
  // PRNU 1 %: sqrt(0.45² (sxx + syy)) / sqrt(24)
  EXPECT_NEAR(noise.bin.prnu_jitter, kPpm * 0.01 * 0.45 * std::sqrt(5e-6 / 24.0), 1e-9);
}

TEST(PredictNoise, IsRelativeToTheTargetAlone) {
  // The gradient is that of all light in the aperture; half of it the neighbours', so the target's noise is twice that.
  StarEstimator e = synthetic_estimator(1e5, 1e5 * 0.975, 9, 0.975);
  EXPECT_NEAR(e.spr_total, 0.5, 1e-12);
  e.gradient_y = 0.0;
  const StarMotion motion{{1e-4, 0.0, 0.0}, {1e-4, 0.0, 0.0}};
  EXPECT_NEAR(predict_noise(e, motion, plato_setup()).bin.jitter, kPpm * 2.0 * 0.06 * 0.01, 1e-9);
}

TEST(PredictNoise, IsInfiniteWithoutLight) {
  const PredictedNoise noise = predict_noise(synthetic_estimator(0.0, 10.0, 9, 0.975), {}, plato_setup());
  EXPECT_TRUE(std::isinf(noise.exposure));
  EXPECT_TRUE(std::isinf(noise.bin.total()));
}

TEST(PredictNoise, ExpectsWithinBinsWhatTheBinMeansHaveNotTaken) {
  StarEstimator e = synthetic_estimator(1e9, 0.0, 9, 0.975);  // so bright that only jitter counts
  e.prnu_gradient_x = e.prnu_gradient_y = 0.0;
  e.gradient_x = 1.0;
  e.gradient_y = 0.0;
  e.budget.var_target = e.budget.var_background = e.budget.var_readout = 0.0;
  e.budget.var_quantisation = e.budget.var_background_estimate = 0.0;
  const StarMotion motion{{1e-6, 0.0, 0.0}, {0.36e-6, 0.0, 0.0}};
  const PredictedNoise noise = predict_noise(e, motion, plato_setup());
  EXPECT_NEAR(noise.bin_simulated, 600.0, 1e-6);
  EXPECT_NEAR(noise.bin_within, std::sqrt(0.64 * 144.0 / 143.0 / 144.0) * 1000.0, 1e-6);
  EXPECT_DOUBLE_EQ(noise.bin_within_common, noise.bin_within);
}

TEST(TargetMetrics, SplitTheMagnitudeDifferenceIntoItsCauses) {
  // Neighbours add a tenth to the target's light in the aperture, the aperture misses a fifth.
  const StarEstimator e = synthetic_estimator(1e5, 8000.0, 9, 0.8);
  TargetMetrics target = predict_target(star_of(11.0, 1e5), e, {}, plato_setup());
  add_measurement(target, white_series(0.0, 3e-3), target.flux_expected, 0, plato_setup());
  EXPECT_NEAR(target.causes.contamination, -0.1034817129, 1e-9);  // +10 % -> -103.5 mmag
  EXPECT_NEAR(target.causes.aperture_loss, 0.2422750325, 1e-9);
  EXPECT_NEAR(target.causes.residual, 0.0, 1e-12);
  EXPECT_NEAR(target.mag_measured - 11.0, target.causes.contamination + target.causes.aperture_loss, 1e-12);
  EXPECT_NEAR(target.crowdsap, 1.0 / 1.1, 1e-12);
  EXPECT_DOUBLE_EQ(target.flfrcsap, 0.8);
}

TEST(TargetMetrics, KeepWhatIsNotExplainedAsResidual) {
  const StarEstimator e = synthetic_estimator(1e5, 0.0, 9, 0.975);
  TargetMetrics target = predict_target(star_of(11.0, 1e5), e, {}, plato_setup());
  add_measurement(target, white_series(-0.01, 3e-3), target.flux_expected, 0, plato_setup());
  EXPECT_NEAR(target.causes.residual, -2.5 * std::log10(0.99), 1e-12);
  EXPECT_NEAR(target.flux_measured, 0.99 * 97500.0, 1e-6);
}

TEST(TargetMetrics, CompareMeasuredNoiseRelativeToTheTarget) {
  const StarEstimator e = synthetic_estimator(1e5, 97500.0, 9, 0.975);  // SPR 1/2
  TargetMetrics target = predict_target(star_of(11.0, 1e5), e, {}, plato_setup());
  const double relative_to_all = e.nsr_exposure * 0.5;
  add_measurement(target, white_series(0.0, relative_to_all), target.flux_expected, 0, plato_setup());
  EXPECT_NEAR(target.nsr_exposure_measured.value / target.nsr_exposure, 1.0, 1e-4);
  EXPECT_NEAR(target.nsr_1h_measured.value * c4(24) / target.predicted.bin_simulated, 1.0, 1e-12);
}

TEST(TargetMetrics, HaveNoMagnitudeForAFluxThatIsNotPositive) {
  const StarEstimator e = synthetic_estimator(10.0, 0.0, 4, 0.7);
  TargetMetrics target = predict_target(star_of(21.0, 10.0), e, {}, plato_setup());
  SeriesSummary series = white_series(-1.5, 1.0);
  add_measurement(target, series, target.flux_expected, 0, plato_setup());
  EXPECT_LT(target.flux_measured, 0.0);
  EXPECT_TRUE(std::isnan(target.mag_measured));
  EXPECT_TRUE(std::isnan(target.causes.residual));
}

TEST(TargetMetrics, TakeThePredictedErrorForASingleExposure) {
  const StarEstimator e = synthetic_estimator(1e5, 0.0, 9, 0.975);
  TargetMetrics target = predict_target(star_of(11.0, 1e5), e, {}, plato_setup());
  SeriesSummary series;
  series.exposures = 1;
  add_measurement(target, series, target.flux_expected, measurement_flag::kEdge, plato_setup());
  EXPECT_NEAR(target.flux_err, target.flux_measured * e.nsr_exposure, 1e-9);
  EXPECT_TRUE(std::isnan(target.nsr_1h_measured.value));
  EXPECT_FALSE(is_clean(target));
}

TEST(ScaleToCameras, LetsOnlyTheIndependentPartFall) {
  RunSetup setup = plato_setup();
  setup.simulated_cameras = 6;
  NoiseEstimate noise = noise_estimate(50.0, 23);
  noise.value = 50.0;
  const NoiseEstimate scaled = scale_to_cameras(noise, 30.0, setup);
  EXPECT_NEAR(scaled.value, std::sqrt(40.0 * 40.0 / 4.0 + 30.0 * 30.0), 1e-12);
  EXPECT_NEAR(scaled.error, noise.error * 0.25 * 50.0 / scaled.value, 1e-12);
  EXPECT_LT(scaled.low, scaled.value);
  EXPECT_GT(scaled.high, scaled.value);
}

TEST(ScaleToCameras, LeavesNoiseBelowTheSharedPartAsItIs) {
  const NoiseEstimate noise = noise_estimate(20.0, 23);
  EXPECT_DOUBLE_EQ(scale_to_cameras(noise, 30.0, plato_setup()).value, noise.value);
}

TEST(ScaleToCameras, ChangesNothingWhenAllCamerasWereSimulated) {
  RunSetup setup = plato_setup();
  setup.simulated_cameras = setup.cameras;
  const NoiseEstimate noise = noise_estimate(50.0, 23);
  EXPECT_NEAR(scale_to_cameras(noise, 30.0, setup).value, noise.value, 1e-12);
  EXPECT_NEAR(scale_to_cameras(noise, 30.0, setup).error, noise.error, 1e-12);
}

TEST(Flags, AreDecodedByNameAndUnknownBitsByNumber) {
  EXPECT_EQ(flag_text(0), "");
  EXPECT_EQ(flag_text(measurement_flag::kEdge | measurement_flag::kSaturated | 1U << 20), "edge|saturated|bit20");
}

TEST(Flags, AllHaveADistinctBitAndAMeaning) {
  std::uint32_t seen = 0;
  for (const FlagName& flag : flag_names()) {
    EXPECT_EQ(seen & flag.bit, 0U) << flag.name;
    EXPECT_FALSE(flag.meaning.empty());
    seen |= flag.bit;
  }
}

}  // namespace
}  // namespace astroid
