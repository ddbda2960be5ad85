// The CMOS chain seen from outside: a fitted ramp gives the flux within its predicted error, from no light to beyond
// the full well; one read is a reset and a read; what all reads share is not in the fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 300;
constexpr double kFullWell = 80000.0;

/// A flat field of `level` e- per exposure (and one negligible star, since a scene needs a target).
Mission flat_field(double level, int reads, RampFit fit) {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.type = DetectorType::kCmos;
  mission.field.sky_background = ElectronsPerSecond(level / 21.0);
  mission.ccd.readout_noise = Electrons(13.0);
  mission.ccd.gain = Gain(1.92);
  mission.ccd.bias = Adu(5000.0);
  mission.ccd.full_well = Electrons(kFullWell);
  mission.ccd.adc_bits = 16;
  mission.cmos.reads = reads;
  mission.cmos.ramp_fit = fit;
  return mission;
}

struct FlatRun {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<Plan> plan;
  explicit FlatRun(const Mission& mission)
      : scene(std::make_shared<const Scene>(mission, test::lab_catalogue({{150.0, 150.0, 1e-9}}))),
        plan(std::make_shared<Plan>(make_plan(*scene))) {}
  void force(const std::string& effect) const {
    for (PlannedEffect& planned : plan->effects)
      if (planned.effect->spec().name == effect) planned.need.needed = true;
  }
  /// Electrons above the bias of every pixel, and its flags.
  [[nodiscard]] std::pair<std::vector<double>, std::vector<std::uint8_t>> exposure(std::int64_t number) const {
    const Simulator simulator(scene, plan, 0);
    ExposureState state = simulator.make_state();
    simulator.simulate(number, state);
    const CcdSettings& ccd = scene->mission().ccd;
    std::vector<double> electrons;
    for (const float count : state.frame.pixels.pixels())
      electrons.push_back((static_cast<double>(count) - ccd.bias.value()) * ccd.gain.value());
    const auto flags = state.frame.flags.pixels();
    return {electrons, {flags.begin(), flags.end()}};
  }
};

struct Moments {
  double mean = 0.0, variance = 0.0;
};
Moments moments(const std::vector<double>& values) {
  Moments m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) m.mean += v / n;
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean) / (n - 1.0);
  return m;
}

/// Expects the mean and the variance of N normal values; Poisson values of mean F add 1/F to 2 in the variance's own.
void expect_law(const std::vector<double>& values, double mean, double variance, const char* what) {
  const Moments m = moments(values);
  const auto n = static_cast<double>(values.size());
  const double z_mean = (m.mean - mean) / std::sqrt(variance / n);
  const double z_variance = (m.variance / variance - 1.0) / std::sqrt((2.0 + 1.0 / std::max(1.0, mean)) / n);
  std::printf("%-22s F %8.1f: mean %10.2f (z = %5.2f), rms %8.3f of %8.3f (z = %5.2f)\n", what, mean, m.mean, z_mean,
              std::sqrt(m.variance), std::sqrt(variance), z_variance);
  EXPECT_LT(std::abs(z_mean), 4.0) << what << " " << mean;
  EXPECT_LT(std::abs(z_variance), 4.0) << what << " " << mean;
}

TEST(CmosRamp, GivesTheFluxWithinItsPredictedError) {
  struct Case {
    const char* name;
    int reads;
    RampFit fit;
  };
  for (const Case& c :
       {Case{"optimal, 16 reads", 16, RampFit::kOptimal}, Case{"optimal, 4 reads", 4, RampFit::kOptimal},
        Case{"least squares, 16", 16, RampFit::kLeastSquares}, Case{"difference, 16", 16, RampFit::kDifference},
        Case{"two reads", 2, RampFit::kOptimal}}) {
    for (const double level : {1e-9, 20.0, 400.0, 6000.0, 75000.0}) {
      const Mission mission = flat_field(level, c.reads, c.fit);
      const double variance = expected_pixel_noise(mission).variance();
      expect_law(FlatRun(mission).exposure(3).first, level, variance, c.name);
    }
  }
}

TEST(CmosRamp, OfOneReadIsAResetAndARead) {
  const Mission cmos = flat_field(900.0, 1, RampFit::kOptimal);
  Mission ccd = cmos;
  ccd.simulation.type = DetectorType::kCcd;
  EXPECT_EQ(FlatRun(cmos).exposure(2).first, FlatRun(ccd).exposure(2).first);
  // With the charge that the reset leaves.
  Mission noisy = cmos;
  noisy.cmos.reset_noise = Electrons(44.0);
  EXPECT_TRUE(FlatRun(noisy).plan->runs("reset-noise"));
  expect_law(FlatRun(noisy).exposure(2).first, 900.0, expected_pixel_noise(noisy).variance(), "one read");
}

TEST(CmosRamp, DoesNotHaveWhatAllReadsShare) {
  Mission mission = flat_field(900.0, 8, RampFit::kOptimal);
  mission.cmos.reset_noise = Electrons(44.0);
  mission.cmos.offset_rms = Adu(100.0);
  const FlatRun without(mission);
  EXPECT_FALSE(without.plan->runs("reset-noise"));
  EXPECT_FALSE(without.plan->runs("pixel-offset"));
  const FlatRun with(mission);
  with.force("reset-noise");
  with.force("pixel-offset");
  const std::vector<double> a = without.exposure(1).first;
  const std::vector<double> b = with.exposure(1).first;
  // Reads are rounded elsewhere, each by the quantisation noise of F90; nothing else changes.
  std::vector<double> difference(a.size());
  std::ranges::transform(a, b, difference.begin(), std::minus<>());
  const double step = 1.92;
  const double factor = std::pow(fitted_readout_factor(mission), 2.0);
  const double rounding = 2.0 * (factor + 1.0) * step * step / 12.0;
  const Moments m = moments(difference);
  std::printf("rms difference %.3f e-, rounding gives %.3f e-\n", std::sqrt(m.variance), std::sqrt(rounding));
  EXPECT_NEAR(m.mean, 0.0, 4.0 * std::sqrt(rounding / static_cast<double>(a.size())));
  EXPECT_LT(m.variance, 1.1 * rounding);
  expect_law(b, 900.0, expected_pixel_noise(mission).variance(), "with reset noise");
}

TEST(CmosRamp, IsFittedToTheReadsBeforeTheFullWell) {
  // Half-way between two reads, far from where the choice of reads would follow the noise.
  constexpr int kReads = 9;
  for (const double usable : {1.5, 2.5, 4.5, 7.5}) {
    const double level = kFullWell * 8.0 / usable;
    Mission mission = flat_field(level, kReads, RampFit::kOptimal);
    const auto [electrons, flags] = FlatRun(mission).exposure(0);
    expect_law(electrons, level, expected_pixel_noise(mission).variance(), "short ramp");
    EXPECT_TRUE(std::ranges::all_of(flags, [](std::uint8_t f) { return f == pixel_flag::kShortRamp; }));
  }
  // Full before the second read: nothing to fit.
  const auto [electrons, flags] = FlatRun(flat_field(10.0 * kFullWell, kReads, RampFit::kOptimal)).exposure(0);
  EXPECT_TRUE(std::ranges::all_of(flags, [](std::uint8_t f) {
    return (f & (pixel_flag::kFullWell | pixel_flag::kAdcSaturated)) != 0 && (f & pixel_flag::kShortRamp) == 0;
  }));
}

TEST(CmosRamp, KeepsTheNoiseOfUnequalPixels) {
  Mission mission = flat_field(1e-9, 6, RampFit::kOptimal);
  mission.cmos.noise_rms = 0.4;
  const FlatRun run(mission);
  // Over many exposures of each pixel: the mean of the variances is the stated one, their logarithm has the spread.
  constexpr int kExposures = 60;
  std::vector<double> sum(static_cast<std::size_t>(kSide * kSide));
  std::vector<double> squares(sum.size());
  for (int k = 0; k < kExposures; ++k) {
    const std::vector<double> values = run.exposure(k).first;
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum[i] += values[i] / kExposures;
      squares[i] += values[i] * values[i] / kExposures;
    }
  }
  const PixelNoise noise = expected_pixel_noise(mission);
  const double rest = noise.quantisation * noise.quantisation * (noise.factors(0.0).readout + 1.0);
  std::vector<double> variances(sum.size());
  std::vector<double> logarithms(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    variances[i] = (squares[i] - sum[i] * sum[i]) * kExposures / (kExposures - 1.0);
    logarithms[i] = 0.5 * std::log(std::max(1e-3, variances[i] - rest));
  }
  const Moments variance = moments(variances);
  const auto n = static_cast<double>(sum.size());
  const double z = (variance.mean - noise.variance()) / std::sqrt(variance.variance / n);
  // Sampling scatters the logarithm of a deviation by 1 / sqrt(2 (n - 1)), to the next order in 1/n.
  const double spread =
      std::sqrt(moments(logarithms).variance - 1.0 / (2.0 * (kExposures - 1.0)) * (1.0 + 1.0 / (kExposures - 1.0)));
  std::printf("mean variance %.2f of %.2f e-² (z = %.2f), spread %.4f of 0.4\n", variance.mean, noise.variance(), z,
              spread);
  EXPECT_LT(std::abs(z), 4.0);
  EXPECT_NEAR(spread, 0.4, 0.008);  // 2 %: four times its error, and what the subtraction of the rest leaves
}

TEST(CmosRamp, SharesNoiseInColumnsAndRows) {
  Mission mission = flat_field(1e-9, 4, RampFit::kLeastSquares);
  mission.cmos.column_noise = Electrons(6.0);
  mission.cmos.row_noise = Electrons(3.0);
  const FlatRun run(mission);
  const PixelNoise noise = expected_pixel_noise(mission);
  const double factor = noise.factors(0.0).readout;
  std::vector<double> columns;
  std::vector<double> rows;
  constexpr int kExposures = 20;
  for (int k = 0; k < kExposures; ++k) {
    const std::vector<double> values = run.exposure(k).first;
    for (int a = 0; a < kSide; ++a) {
      double column = 0.0;
      double row = 0.0;
      for (int b = 0; b < kSide; ++b) {
        column += values[static_cast<std::size_t>(b * kSide + a)] / kSide;
        row += values[static_cast<std::size_t>(a * kSide + b)] / kSide;
      }
      columns.push_back(column);
      rows.push_back(row);
    }
  }
  // The mean over a column has its own number, the mean over rows of theirs and of what pixels have alone; the part
  // that is common to the means of one exposure adds 1/kSide of the other pattern, which is in the mean square too.
  const double alone = noise.variance() / kSide;
  expect_law(columns, 0.0, factor * (36.0 + 9.0 / kSide) + alone, "columns");
  expect_law(rows, 0.0, factor * (9.0 + 36.0 / kSide) + alone, "rows");
}

}  // namespace
}  // namespace astroid
