// Power-law fields: the slope and rms that were asked for, the same in every direction, and no mean (hard case N22).
#include "astroid/sim/power_law_field.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "astroid/core/jitter_noise.hpp"
#include "fourier.hpp"

namespace astroid {
namespace {

constexpr int kSide = 128;

RandomStream stream_of(std::uint64_t seed) {
  return make_stream(seed, StreamId{50}, 0, 0);
}

/// |transform|² of a field on its own grid, at [ky * kSide + kx].
std::vector<double> power_of(const PowerLawField& field) {
  std::vector<double> real(kSide * kSide);
  std::vector<double> imaginary(kSide * kSide);
  const auto transpose = [](std::vector<double>& values) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < y; ++x)
        std::swap(values[static_cast<std::size_t>(y * kSide + x)], values[static_cast<std::size_t>(x * kSide + y)]);
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) real[static_cast<std::size_t>(y * kSide + x)] = field.at(x, y);
  FourierTransform transform(kSide, kSide);
  for (int pass = 0; pass < 2; ++pass) {
    transform.transform(real, imaginary);
    transpose(real);
    transpose(imaginary);
  }
  for (std::size_t i = 0; i < real.size(); ++i) real[i] = real[i] * real[i] + imaginary[i] * imaginary[i];
  return real;
}

struct Fit {
  double sxx = 0.0, sxy = 0.0, sx = 0.0, sy = 0.0, n = 0.0;
  void add(double x, double y, double weight) {
    sxx += weight * x * x;
    sxy += weight * x * y;
    sx += weight * x;
    sy += weight * y;
    n += weight;
  }
  [[nodiscard]] double slope() const { return (n * sxy - sx * sy) / (n * sxx - sx * sx); }
};

TEST(PowerLawField, HasTheSlopeThatWasAskedFor) {
  for (const double exponent : {0.0, 1.0, 2.0, 3.0}) {
    constexpr int kRealisations = 100;
    std::array<double, kSide / 2> power{};
    std::array<double, kSide / 2> modes{};
    std::array<double, 4> sectors{};  // of direction, power relative to the law
    std::array<double, 4> sector_modes{};
    std::array<std::array<double, 2>, 2> special{};  // frequencies that are their own negative
    for (int r = 0; r < kRealisations; ++r) {
      const PowerLawField field(stream_of(static_cast<std::uint64_t>(r)), kSide, kSide, exponent, 0.01);
      const std::vector<double> spectrum = power_of(field);
      for (int ky = 0; ky < kSide; ++ky)
        for (int kx = 0; kx < kSide; ++kx) {
          const int x = kx < kSide / 2 ? kx : kx - kSide;
          const int y = ky < kSide / 2 ? ky : ky - kSide;
          const double f = std::hypot(x, y);
          const double p = spectrum[static_cast<std::size_t>(ky * kSide + kx)];
          if (kx % (kSide / 2) == 0 && ky % (kSide / 2) == 0)
            special[kx == 0 ? 0 : 1][ky == 0 ? 0 : 1] += p * std::pow(f, exponent) / kRealisations;
          const auto bin = static_cast<std::size_t>(f + 0.5);
          if (bin < 1 || bin >= power.size()) continue;
          power[bin] += p;
          modes[bin] += 1.0;
          const double angle = std::atan2(std::abs(y), x);  // 0 .. pi
          const auto sector = static_cast<std::size_t>(std::min(3.0, std::floor(4.0 * angle / std::numbers::pi)));
          sectors[sector] += p * std::pow(f, exponent);
          sector_modes[sector] += 1.0;
        }
    }
    Fit fit;
    for (std::size_t bin = 2; bin < power.size(); ++bin)
      fit.add(std::log(static_cast<double>(bin)), std::log(power[bin] / modes[bin]), modes[bin]);
    std::printf("exponent %.1f: slope %.4f\n", exponent, fit.slope());
    EXPECT_NEAR(fit.slope(), -exponent, 0.05);
    double mean = 0.0;
    for (std::size_t s = 0; s < 4; ++s) mean += sectors[s] / sector_modes[s] / 4.0;
    for (std::size_t s = 0; s < 4; ++s) {
      std::printf("  sector %zu: %.4f of the mean power\n", s, sectors[s] / sector_modes[s] / mean);
      EXPECT_NEAR(sectors[s] / sector_modes[s] / mean, 1.0, 0.1);
    }
    // The Nyquist frequencies have their power although they are real (a chi-square of one degree of freedom each);
    // frequency zero has none.
    const double error = std::sqrt(2.0 / kRealisations);
    EXPECT_LT(special[0][0], 1e-10 * mean);
    for (const double nyquist : {special[0][1], special[1][0], special[1][1]}) {
      std::printf("  Nyquist: %.3f of the mean power\n", nyquist / mean);
      EXPECT_NEAR(nyquist / mean, 1.0, 5.0 * error);
    }
  }
}

TEST(PowerLawField, HasTheStatedRmsAndNoMeanOnAnyDetector) {
  struct Case {
    int columns, rows;
  };
  for (const Case& c : {Case{128, 128}, Case{113, 57}, Case{1, 40}, Case{40, 1}, Case{3, 2}, Case{9001, 3}}) {
    const PowerLawField field(stream_of(3), c.columns, c.rows, 1.0, 0.02);
    EXPECT_EQ(field.cell(), c.columns > 8192 ? 2 : 1);
    double mean = 0.0;
    double squares = 0.0;
    const double n = static_cast<double>(c.columns) * c.rows;
    for (int y = 0; y < c.rows; ++y)
      for (int x = 0; x < c.columns; ++x) {
        mean += field.at(x, y) / n;
        squares += field.at(x, y) * field.at(x, y) / n;
      }
    // Cells at the far edges of a detector with an odd number of columns are cut.
    const double tolerance = field.cell() == 1 ? 1e-6 : 1e-2;
    EXPECT_NEAR(mean, 0.0, 0.02 * tolerance) << c.columns << " x " << c.rows;
    EXPECT_NEAR(std::sqrt(squares) / 0.02, 1.0, tolerance) << c.columns << " x " << c.rows;
  }
}

TEST(FlatField, ScattersFluxesAsPredicted) {
  // Stars in the middle of pixels all over a field: rms of the mean sensitivity that each sees.
  constexpr int kField = 512;
  for (const double sigma : {0.6, 1.0, 2.0}) {
    std::vector<double> weights;
    const int half = static_cast<int>(4.0 * sigma) + 1;
    double sum = 0.0;
    for (int i = -half; i <= half; ++i) {
      weights.push_back(std::erf((i + 0.5) / sigma / std::numbers::sqrt2) -
                        std::erf((i - 0.5) / sigma / std::numbers::sqrt2));
      sum += weights.back();
    }
    double share = 0.0;
    for (double& w : weights) {
      w /= sum;
      share += w * w;  // of one axis; both: the square, whose root is this
    }
    for (const double exponent : {0.0, 1.0, 1.5, 3.0}) {
      const PowerLawField field(stream_of(8), kField, kField, exponent, 0.01);
      double squares = 0.0;
      int stars = 0;
      for (int y = half; y < kField - half; y += 3)
        for (int x = half; x < kField - half; x += 3) {
          double seen = 0.0;
          for (int j = -half; j <= half; ++j)
            for (int i = -half; i <= half; ++i)
              seen += weights[static_cast<std::size_t>(i + half)] * weights[static_cast<std::size_t>(j + half)] *
                      field.at(x + i, y + j);
          squares += seen * seen;
          ++stars;
        }
      const double predicted = flat_field_static_noise(0.01, exponent, share);
      std::printf("sigma %.1f px, exponent %.1f: scatter %.5f, predicted %.5f\n", sigma, exponent,
                  std::sqrt(squares / stars), predicted);
      EXPECT_NEAR(std::sqrt(squares / stars) / predicted, 1.0, 0.2);
    }
  }
}

TEST(PowerLawField, OfASinglePixelIsNothing) {
  EXPECT_EQ(PowerLawField(stream_of(3), 1, 1, 1.0, 0.02).at(0, 0), 0.0);
}

TEST(PowerLawField, IsAnotherForAnotherCamera) {
  double product = 0.0;
  const PowerLawField a(make_stream(1, StreamId{50}, 0, 0), 64, 64, 0.0, 1.0);
  const PowerLawField b(make_stream(1, StreamId{50}, 1, 0), 64, 64, 0.0, 1.0);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) product += a.at(x, y) * b.at(x, y) / 4096.0;
  EXPECT_LT(std::abs(product), 5.0 / 64.0);
}

}  // namespace
}  // namespace astroid
