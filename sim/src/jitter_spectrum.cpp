#include "astroid/sim/jitter_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "named_columns.hpp"

namespace astroid {

PowerSpectrum::PowerSpectrum(std::vector<double> frequency, std::vector<double> density)
    : frequency_(std::move(frequency)), density_(std::move(density)) {
  ASTROID_CHECK_EQ(frequency_.size(), density_.size());
  ASTROID_CHECK_LE(std::size_t{2}, frequency_.size());
  ASTROID_CHECK_LT(0.0, frequency_.front());
}

double PowerSpectrum::density(double frequency) const {
  if (frequency < lowest() || frequency > highest()) return 0.0;
  const auto above = std::upper_bound(frequency_.begin() + 1, frequency_.end() - 1, frequency);
  const auto i = static_cast<std::size_t>(above - frequency_.begin()) - 1;
  const double f0 = frequency_[i];
  const double f1 = frequency_[i + 1];
  const double s0 = density_[i];
  const double s1 = density_[i + 1];
  if (!(s0 > 0.0 && s1 > 0.0)) return s0 + (s1 - s0) * (frequency - f0) / (f1 - f0);
  return s0 * det::pow(frequency / f0, det::log(s1 / s0) / det::log(f1 / f0));
}

double PowerSpectrum::power_within(std::size_t i, double low, double high) const {
  const double s0 = density_[i];
  const double s1 = density_[i + 1];
  if (!(s0 > 0.0 && s1 > 0.0)) return 0.5 * (density(low) + density(high)) * (high - low);
  // Integral of S (f/low)^p from low to high: S low (x^(p+1) - 1) / (p+1), x = high/low, without a hole at p = -1.
  const double p = det::log(s1 / s0) / det::log(frequency_[i + 1] / frequency_[i]);
  const double logarithm = det::log(high / low);
  const double exponent = (p + 1.0) * logarithm;
  const double growth = exponent == 0.0 ? 1.0 : det::expm1(exponent) / exponent;
  return s0 * det::pow(low / frequency_[i], p) * low * logarithm * growth;
}

double PowerSpectrum::power(double low, double high) const {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < frequency_.size(); ++i) {
    const double from = std::max(low, frequency_[i]);
    const double to = std::min(high, frequency_[i + 1]);
    if (from < to) sum += power_within(i, from, to);
  }
  return sum;
}

JitterSpectrum read_jitter_spectrum(const std::string& path) {
  constexpr std::array<const char*, 4> kNames{"frequency_hz", "yaw", "pitch", "roll"};
  const CsvTable table = read_csv(path);
  std::vector<Problem> problems;
  const auto columns =
      find_named_columns(table, kNames, "columns frequency_hz, yaw, pitch, roll (Hz, arcsec²/Hz, one-sided)", problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  std::vector<double> frequency;
  std::array<std::vector<double>, 3> density;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto values = finite_numbers(table, row, columns, problems);
    if (!values) continue;
    bool good = true;
    const double least = frequency.empty() ? 0.0 : frequency.back();
    if (!((*values)[0] > least)) {
      problems.push_back(
          table.problem(row, *columns[0], "frequency does not increase", fmt::format("more than {}", least)));
      good = false;
    }
    for (std::size_t axis = 0; axis < density.size(); ++axis) {
      if ((*values)[axis + 1] >= 0.0) continue;
      problems.push_back(table.problem(row, *columns[axis + 1], "density is negative", "0 or more arcsec²/Hz"));
      good = false;
    }
    if (!good) continue;
    frequency.push_back((*values)[0]);
    for (std::size_t axis = 0; axis < density.size(); ++axis) density[axis].push_back((*values)[axis + 1]);
  }
  if (problems.empty() && frequency.size() < 2)
    problems.push_back({.file = path,
                        .parameter = "Satellite/Jitter/File",
                        .expected = "at least two frequencies",
                        .message = fmt::format("the file has {}", frequency.size())});
  if (!problems.empty()) throw InputError(std::move(problems));
  return {PowerSpectrum(frequency, std::move(density[0])), PowerSpectrum(frequency, std::move(density[1])),
          PowerSpectrum(frequency, std::move(density[2]))};
}

}  // namespace astroid
