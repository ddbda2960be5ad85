#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure_tools.hpp"

namespace astroid {

namespace {

/// The measured noise of a target that is drawn: by bin means where there are some, else within bins.
double drawn_noise(const TargetMetrics& target) {
  return std::isfinite(target.nsr_1h_scaled.value) ? target.nsr_1h_scaled.value : target.nsr_1h_within_scaled.value;
}

std::string noise_axes(const FigureContext& context, AxisRange mag, AxisRange ppm) {
  return fmt::format(
             "  set logscale y\n  set xrange [{:g}:{:g}]\n  set yrange [{:g}:{:g}]\n"
             "  set xlabel \"{}\"\n  set ylabel \"noise in {} with {} camera{}, ppm\"\n"
             "  set key outside right top vertical Left reverse\n",
             mag.low, mag.high, ppm.low, ppm.high, gnuplot_text(context.magnitude_label), context.bin_text,
             context.setup.cameras, context.setup.cameras == 1 ? "" : "s") +
         log_tics("y", ppm) + requirement_mark(context, mag.low);
}

AxisRange noise_range(std::vector<double> values, const FigureContext& context) {
  if (context.requirement) values.push_back(context.requirement->ppm);
  const AxisRange range = robust_range(values, 0.001, 0.0);
  constexpr double kBelow = 4.0;  // room for the lesser causes
  constexpr double kAbove = 1.6;
  return {std::max(1e-6, range.low / kBelow), std::max(1e-5, range.high * kAbove)};
}

}  // namespace

Figure figure_noise(std::span<const TargetMetrics> targets, std::span<const NoiseBin> bins,
                    const FigureContext& context) {
  Figure figure;
  figure.name = "noise_vs_magnitude";
  figure.title = "Noise against magnitude";
  const std::size_t step = thinning(targets.size());
  CsvText points("mag,measured_ppm,predicted_ppm");
  std::vector<double> mags, noises;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const TargetMetrics& target = targets[i];
    if (!is_clean(target) || !std::isfinite(target.nsr_1h_ppm)) continue;
    mags.push_back(target.mag);
    noises.push_back(target.nsr_1h_ppm);
    noises.push_back(drawn_noise(target));
    if (i % step != 0) continue;
    points.row(target.mag, drawn_noise(target), target.nsr_1h_ppm);
    ++drawn;
  }
  std::vector<NoiseLine> lines;
  CsvText medians("mag,measured_ppm");
  for (const NoiseBin& bin : bins) {
    lines.push_back({bin.mag_median, bin.predicted_ppm, bin.causes});
    medians.row(bin.mag_median, std::isfinite(bin.measured_ppm) ? bin.measured_ppm : bin.measured_within_ppm);
  }
  figure.data = {{"noise_points.csv", points.text()},
                 {"noise_lines.csv", noise_lines_csv(lines)},
                 {"noise_medians.csv", medians.text()}};
  figure.caption = fmt::format(
      "Noise of the mean over {} with {} camera{}, relative to the target's flux. Points: measured, each unsaturated "
      "target; "
      "circles: their medians. Lines: predicted, and its causes (those that somewhere reach a tenth of it), medians "
      "per half magnitude.{}",
      context.bin_text, context.setup.cameras, context.setup.cameras == 1 ? "" : "s", thinning_text(step));
  const PointStyle style = point_style(drawn);
  figure.commands = noise_axes(context, full_range(mags, 0.03), noise_range(noises, context));
  figure.commands += fmt::format(
      "  plot \"noise_points.csv\" skip 1 using 1:2 with points pointtype 7 pointsize {:g} linecolor rgb \"{}\" title "
      "\"measured\"",
      style.size, with_transparency(palette::kMeasured, style.transparency));
  // The key names the two that matter first; they are drawn last, on top.
  const std::string circle =
      fmt::format("points pointtype 6 pointsize 0.8 linewidth 1.6 linecolor rgb \"{}\"", palette::kMeasured);
  const std::string line = fmt::format("lines linewidth 2.4 linecolor rgb \"{}\"", palette::kPredicted);
  figure.commands +=
      fmt::format(", keyentry with {} title \"measured, median\", keyentry with {} title \"predicted\"", circle, line);
  figure.commands += cause_curves("noise_lines.csv", lines);
  figure.commands += fmt::format(
      ", \\\n    \"noise_lines.csv\" skip 1 using 1:2 with {} notitle"
      ", \\\n    \"noise_medians.csv\" skip 1 using 1:2 with points pointtype 7 pointsize 0.7 linecolor rgb "
      "\"#ffffff\" notitle"
      ", \\\n    \"noise_medians.csv\" skip 1 using 1:2 with {} notitle\n",
      line, circle);
  return figure;
}

Figure figure_ratio(std::span<const TargetMetrics> targets, std::span<const NoiseBin> bins,
                    const FigureContext& context) {
  Figure figure;
  figure.name = "measured_over_predicted";
  figure.title = "Measured over predicted noise";
  figure.height = 460;
  const bool within = noise_summary(targets).within;
  const std::size_t step = thinning(targets.size());
  NoiseRatio ratio;
  CsvText points("mag,ratio");
  std::vector<double> mags, ratios;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const TargetMetrics& target = targets[i];
    if (!is_clean(target)) continue;
    const double value = ratio(target, within);
    mags.push_back(target.mag);
    ratios.push_back(value);
    if (i % step != 0) continue;
    points.row(target.mag, value);
    ++drawn;
  }
  CsvText medians("mag,ratio,low,high");
  double reach = 0.08;
  for (const NoiseBin& bin : bins) {
    const MedianEstimate& m = within ? bin.ratio_within : bin.ratio;
    medians.row(bin.mag_median, m.value, m.low, m.high);
    if (std::isfinite(m.value)) reach = std::max(reach, std::min(1.0, std::abs(m.value - 1.0)));
  }
  const AxisRange most = robust_range(ratios, 0.02, 0.0);
  if (std::isfinite(most.high - most.low))
    reach = std::max(reach, std::min(1.0, std::max(most.high - 1.0, 1.0 - most.low)));
  reach *= 1.1;
  figure.data = {{"ratio_points.csv", points.text()}, {"ratio_medians.csv", medians.text()}};
  figure.caption = fmt::format(
      "Measured over predicted noise in {}, {}, with the {} simulated camera{}. Circles: medians per half magnitude "
      "with their 95 % "
      "intervals; band: ±3 %.{}",
      context.bin_text, within ? "from the scatter within bins" : "from the scatter of bin means",
      context.setup.simulated_cameras, context.setup.simulated_cameras == 1 ? "" : "s", thinning_text(step));
  const AxisRange mag = full_range(mags, 0.03);
  const PointStyle style = point_style(drawn);
  figure.commands = fmt::format(
      "  set xrange [{:g}:{:g}]\n  set yrange [{:g}:{:g}]\n  set xlabel \"{}\"\n  set ylabel \"measured / predicted\"\n"
      "  set key top left horizontal Left reverse maxrows 1\n  set tmargin 3\n  set key outside top center horizontal\n"
      "  set object 1 rectangle from graph 0, first 0.97 to graph 1, first 1.03 behind fillcolor rgb \"#e8f0f4\" "
      "fillstyle solid noborder\n"
      "  set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead linewidth 1.2 linecolor rgb \"{}\"\n"
      "  plot \"ratio_points.csv\" skip 1 using 1:2 with points pointtype 7 pointsize {:g} linecolor rgb \"{}\" title "
      "\"each target\""
      ", \\\n    \"ratio_medians.csv\" skip 1 using 1:2:3:4 with yerrorbars pointtype 7 pointsize 0.7 linewidth 1.6 "
      "linecolor rgb \"{}\" title \"median, 95 % interval\"\n",
      mag.low, mag.high, 1.0 - reach, 1.0 + reach, gnuplot_text(context.magnitude_label), palette::kMuted, style.size,
      with_transparency(palette::kMeasured, style.transparency), palette::kPredicted);
  return figure;
}

Figure figure_budget(std::span<const BudgetRow> rows, const FigureContext& context) {
  Figure figure;
  figure.name = "noise_budget";
  figure.title = "The noise budget, predicted";
  std::vector<NoiseLine> lines;
  std::vector<double> mags, noises;
  for (const BudgetRow& row : rows) {
    if (row.saturated) continue;
    lines.push_back({row.mag, row.nsr_1h_ppm, row.causes});
    mags.push_back(row.mag);
    noises.push_back(row.nsr_1h_ppm);
  }
  figure.data = {{"noise_budget_lines.csv", noise_lines_csv(lines)}};
  figure.caption = fmt::format(
      "Predicted noise of an isolated star at the centre of a pixel in {} with {} camera{}, and its causes. Magnitudes "
      "at which "
      "the brightest pixel saturates are left out.",
      context.bin_text, context.setup.cameras, context.setup.cameras == 1 ? "" : "s");
  figure.commands = noise_axes(context, full_range(mags, 0.03), noise_range(noises, context));
  figure.commands += fmt::format(
      "  plot \"noise_budget_lines.csv\" skip 1 using 1:2 with lines linewidth 2.4 linecolor rgb \"{}\" title \"all "
      "causes\"{}\n",
      palette::kPredicted, cause_curves("noise_budget_lines.csv", lines));
  return figure;
}

}  // namespace astroid
