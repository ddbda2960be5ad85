#include "cotrend_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/fits_writer.hpp"
#include "astroid/core/statistics/quantiles.hpp"

namespace astroid {

namespace {

constexpr std::size_t kMostReferences = 1000;  // the time to find trends grows as their number times bins squared

CommonTrends find_trends(std::span<const float> bin_means, std::span<const SeriesSummary> series,
                         std::span<const TargetMetrics> targets, std::size_t most) {
  const std::size_t bins = bin_means.size() / targets.size();
  std::vector<std::size_t> clean;
  for (std::size_t t = 0; t < targets.size(); ++t)
    if (is_clean(targets[t])) clean.push_back(t);
  std::ranges::stable_sort(clean, {}, [&](std::size_t t) { return targets[t].mag; });
  clean.resize(std::min(clean.size(), kMostReferences));
  std::vector<float> references;
  std::vector<double> noise;
  for (const std::size_t t : clean) {
    const std::span<const float> one = bin_means.subspan(t * bins, bins);
    references.insert(references.end(), one.begin(), one.end());
    noise.push_back(series[t].bin_within.value * (1.0 + series[t].mean));
  }
  return {references, noise, bins, most};
}

}  // namespace

Cotrending::Cotrending(std::span<const float> bin_means, std::span<const SeriesSummary> series,
                       std::span<const TargetMetrics> targets, std::size_t most)
    : trends_(find_trends(bin_means, series, targets, most)) {
  for (std::size_t t = 0; t < targets.size(); ++t) {
    fits_.push_back(trends_.fit(bin_means.subspan(t * trends_.bins(), trends_.bins())));
    mean_.push_back(series[t].mean);
  }
}

NoiseEstimate Cotrending::left(std::size_t target) const {
  const double rms = fits_[target].rms_after;
  const auto freedom = static_cast<std::int64_t>(trends_.bins()) - 1 - static_cast<std::int64_t>(trends_.trends());
  if (!std::isfinite(rms) || freedom < 1) return {};
  return noise_estimate(rms, freedom).scaled(1.0 / (1.0 + mean_[target]));
}

void Cotrending::write(const std::filesystem::path& file, std::span<const TargetMetrics> targets,
                       double bin_seconds) const {
  FitsWriter writer(file);
  std::vector<FitsColumn> columns{{"TIME", FitsNumber::kFloat64, "s"}};
  for (std::size_t k = 0; k < trends_.trends(); ++k)
    columns.push_back({fmt::format("TREND{}", k + 1), FitsNumber::kFloat64});
  writer.begin_table(columns, "TRENDS", static_cast<std::int64_t>(trends_.bins()));
  std::vector<double> time;
  for (std::size_t bin = 0; bin < trends_.bins(); ++bin) time.push_back((static_cast<double>(bin) + 0.5) * bin_seconds);
  writer.write_column(0, 0, time);
  for (std::size_t k = 0; k < trends_.trends(); ++k) {
    const std::span<const double> trend = trends_.trend(k);
    writer.write_column(k + 1, 0, std::vector<double>(trend.begin(), trend.end()));
  }

  std::size_t longest = 1;
  std::vector<std::string> ids;
  for (const TargetMetrics& target : targets) {
    ids.push_back(target.id);
    longest = std::max(longest, target.id.size());
  }
  columns = {{"ID", FitsNumber::kFloat64, "", static_cast<int>(longest)},
             {"RMS_BEFORE", FitsNumber::kFloat64},
             {"RMS_AFTER", FitsNumber::kFloat64}};
  for (std::size_t k = 0; k < trends_.trends(); ++k)
    columns.push_back({fmt::format("AMPLITUDE{}", k + 1), FitsNumber::kFloat64});
  writer.begin_table(columns, "TARGETS", static_cast<std::int64_t>(targets.size()));
  const auto column = [&](auto value) {
    std::vector<double> values;
    values.reserve(fits_.size());
    for (const TrendFit& fit : fits_) values.push_back(value(fit));
    return values;
  };
  writer.write_column(0, 0, ids);
  writer.write_column(1, 0, column([](const TrendFit& fit) { return fit.rms_before; }));
  writer.write_column(2, 0, column([](const TrendFit& fit) { return fit.rms_after; }));
  for (std::size_t k = 0; k < trends_.trends(); ++k)
    writer.write_column(k + 3, 0, column([k](const TrendFit& fit) { return fit.amplitude[k]; }));

  const std::span<const double> values = trends_.eigenvalues();
  writer.begin_table({{"EIGENVALUE", FitsNumber::kFloat64}}, "EIGENVALUES", static_cast<std::int64_t>(values.size()));
  writer.card({"EDGE", trends_.edge(), "eigenvalues of noise alone stay below"});
  writer.card({"NREF", static_cast<std::int64_t>(trends_.references()), "targets that trends were found in"});
  if (!values.empty()) writer.write_column(0, 0, std::vector<double>(values.begin(), values.end()));
  writer.commit();
}

std::string cotrending_note(const Cotrending& cotrending, std::span<const TargetMetrics> targets) {
  const CommonTrends& trends = cotrending.trends();
  if (trends.trends() == 0)
    return fmt::format("cotrending found nothing that the bin means of {} targets have in common beyond their noise",
                       trends.references());
  std::vector<double> before;
  std::vector<double> after;
  for (const TargetMetrics& target : targets)
    if (is_clean(target) && std::isfinite(target.nsr_1h_cotrended.value)) {
      before.push_back(target.nsr_1h_measured.value);
      after.push_back(target.nsr_1h_cotrended.value);
    }
  return fmt::format(
      "bin means of {} targets have {} trend{} in common; without, the noise of the {} unsaturated targets would fall "
      "from {:.4g} to {:.4g} ppm (medians, simulated cameras)",
      trends.references(), trends.trends(), trends.trends() == 1 ? "" : "s", before.size(), quantile(before, 0.5).value,
      quantile(after, 0.5).value);
}

}  // namespace astroid
