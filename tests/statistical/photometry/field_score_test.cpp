// Blind photometry of whole fields against the Cramér–Rao bound, with the PSF given and measured from the image.
#include "astroid/test/field_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/psf_measurement.hpp"
#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

struct Kind {
  const char* name;
  int seeds;  // fields of 512² px
  int stars;  // in each
  double fwhm;
  double slope;
  // Bars with the PSF given.
  double found;
  double bad;
  double bias;
  double scatter;
};

constexpr double kExcess = 1.3;  // of what is lacking, with the PSF measured

std::vector<test::MeasuredStar> measure(const Frame& frame, const PixelPsf& psf, double psf_error) {
  std::vector<test::MeasuredStar> result;
  FieldPhotometrySettings settings;
  settings.psf_error = psf_error;
  for (const SourceMeasurement& s : measure_field(frame, nullptr, psf, settings))
    result.push_back({s.x, s.y, s.flux, s.flux_err});
  return result;
}

void expect_bars(const test::FieldScore& score, const Kind& kind, double excess) {
  const double n = static_cast<double>(score.stars());
  ASSERT_GT(n, 200.0);
  constexpr double kSigmas = 2.0;
  const auto share = [&](double p) { return kSigmas * std::sqrt(p * (1.0 - p) / n); };
  const double lost = excess * (1.0 - kind.found);
  EXPECT_GT(score.found(), 1.0 - lost - share(lost));
  EXPECT_LT(score.bad(), excess * kind.bad + share(excess * kind.bad));
  EXPECT_LT(std::abs(score.bias()), excess * kind.bias + kSigmas * score.median_bias_error());
  EXPECT_LT(score.scatter(),
            1.0 + excess * (kind.scatter - 1.0) + kSigmas * test::FieldScore::width_error(score.stars()));
  for (const double mag : {13.0, 15.0, 17.0, 18.0}) {
    std::size_t count = 0;
    const double width = score.pull_width(mag, count);
    EXPECT_NEAR(width, 1.0, 0.1 * excess + kSigmas * test::FieldScore::width_error(count))
        << "mag " << mag << ", " << count << " stars";
  }
}

class FieldScores : public testing::TestWithParam<Kind> {};

TEST_P(FieldScores, ReachTheBoundWithThePsfGivenAndMeasured) {
  const Kind& kind = GetParam();
  test::FieldScore given;
  test::FieldScore measured;
  for (int seed = 1; seed <= kind.seeds; ++seed) {
    const test::StarFieldSettings settings{
        .stars = kind.stars, .fwhm = kind.fwhm, .slope = kind.slope, .seed = static_cast<std::uint64_t>(seed)};
    const test::StarField field = test::make_star_field(settings);
    given.add(field, settings, measure(field.frame, *make_gaussian_psf(kind.fwhm / kFwhmPerSigma), 0.0));
    const MeasuredPsf psf = measure_psf(field.frame);
    EXPECT_EQ(psf.psf.order, 0);
    measured.add(field, settings, measure(field.frame, *make_effective_psf(psf.psf), psf.flux_error));
  }
  {
    SCOPED_TRACE("PSF given");
    expect_bars(given, kind, 1.0);
  }
  SCOPED_TRACE("PSF measured");
  expect_bars(measured, kind, kExcess);
  RecordProperty("scatter_given", std::to_string(given.scatter()));
  RecordProperty("scatter_measured", std::to_string(measured.scatter()));
}

INSTANTIATE_TEST_SUITE_P(Kinds, FieldScores,
                         testing::Values(Kind{"Sparse", 8, 375, 2.5, 0.10, 0.995, 0.01, 0.002, 1.01},
                                         Kind{"Crowded", 4, 3750, 2.5, 0.25, 0.998, 0.02, 0.004, 1.13},
                                         Kind{"Undersampled", 8, 750, 1.3, 0.15, 0.994, 0.019, 0.002, 1.05}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace astroid
