#include "astroid/photometry/reference_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

/// A deviation from the plain mean that makes a closer look worth while, in sigma: even where five outliers (or half of
/// a few values) have pulled the mean towards them, each is still this far from it.
double suspicion(std::size_t values) {
  constexpr double kOutliers = 5.0;
  return kReferenceClip * std::max(0.5, 1.0 - kOutliers / static_cast<double>(values));
}

double mean_near_median(std::vector<float>& values, const ReferenceNoise& noise) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  const auto value = [&values](std::size_t i) { return static_cast<double>(values[i]); };
  const double median = values.size() % 2 == 1 ? value(middle) : 0.5 * (value(middle - 1) + value(middle));
  const double reach = kReferenceClip * noise.rms(median);
  double sum = 0.0;
  std::size_t good = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::fabs(value(i) - median) > reach) continue;
    sum += value(i);
    ++good;
  }
  return good > 0 ? sum / static_cast<double>(good) : median;
}

}  // namespace

double ReferenceNoise::rms(double level) const {
  // One electron more, so that columns of a few electrons are not clipped as if they were Gaussian.
  const double electrons = std::max(0.0, level - bias) * gain + 1.0;
  return std::sqrt(readout * readout + electrons / (gain * gain));
}

void column_levels(const ImageView<const float, unit::Adu>& rows, const ReferenceNoise& noise,
                   std::span<double> levels) {
  const Rectangle& area = rows.area();
  ASTROID_CHECK_EQ(levels.size(), static_cast<std::size_t>(area.nx));
  ASTROID_CHECK_LE(1, area.ny);
  const std::size_t columns = levels.size();
  std::ranges::fill(levels, 0.0);
  std::vector<float> lowest(columns, std::numeric_limits<float>::infinity());
  std::vector<float> highest(columns, -std::numeric_limits<float>::infinity());
  for (int y = area.y0; y < area.y1(); ++y) {
    const float* row = rows.row(y).data();
    for (std::size_t i = 0; i < columns; ++i) {
      levels[i] += static_cast<double>(row[i]);
      lowest[i] = row[i] < lowest[i] ? row[i] : lowest[i];
      highest[i] = row[i] > highest[i] ? row[i] : highest[i];
    }
  }
  const double suspicious = suspicion(static_cast<std::size_t>(area.ny));
  std::vector<float> column;
  for (std::size_t i = 0; i < columns; ++i) {
    levels[i] /= area.ny;
    const double farthest =
        std::max(static_cast<double>(highest[i]) - levels[i], levels[i] - static_cast<double>(lowest[i]));
    if (farthest <= suspicious * noise.rms(levels[i])) continue;  // false for NaN too
    column.clear();
    for (int y = area.y0; y < area.y1(); ++y) column.push_back(rows.row(y)[i]);
    levels[i] = mean_near_median(column, noise);
  }
}

double reference_level(std::vector<float>& values, const ReferenceNoise& noise) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  const double mean = sum / static_cast<double>(values.size());
  const double reach = suspicion(values.size()) * noise.rms(mean);
  const bool plain =
      std::ranges::all_of(values, [&](float value) { return std::fabs(static_cast<double>(value) - mean) <= reach; });
  return plain ? mean : mean_near_median(values, noise);
}

}  // namespace astroid
