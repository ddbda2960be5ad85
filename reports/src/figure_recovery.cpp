#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure_tools.hpp"

namespace astroid {

namespace {

constexpr double kMillimagnitudes = 1000.0;

struct RecoveryPoints {
  std::string csv;
  std::size_t drawn = 0;
  bool any_contaminated = false, any_saturated = false, any_flagged = false;
  std::vector<double> mags, measured, deltas, residuals;
};

RecoveryPoints recovery_points(std::span<const TargetMetrics> targets, const FigureContext& context) {
  RecoveryPoints out;
  const std::size_t step = thinning(targets.size());
  CsvText csv("mag,mag_measured,delta_mag,residual_mmag,class");
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const TargetMetrics& target = targets[i];
    if (!std::isfinite(target.mag_measured)) continue;
    const StarClass kind = star_class(target, context.setup);
    out.any_contaminated |= kind == StarClass::kContaminated;
    out.any_saturated |= kind == StarClass::kSaturated;
    out.any_flagged |= kind == StarClass::kFlagged;
    out.mags.push_back(target.mag);
    out.measured.push_back(target.mag_measured);
    out.deltas.push_back(target.delta_mag);
    const double residual = kMillimagnitudes * target.causes.residual;
    if (kind == StarClass::kUncontaminated) out.residuals.push_back(residual);
    if (i % step != 0) continue;
    csv.row(target.mag, target.mag_measured, target.delta_mag, residual, static_cast<int>(kind));
    ++out.drawn;
  }
  out.csv = csv.text();
  return out;
}

/// One `plot` clause per class of stars; `column` is the ordinate.
std::string class_points(const RecoveryPoints& points, int column, bool titled) {
  const PointStyle style = point_style(points.drawn);
  const auto clause = [&](StarClass kind, const char* colour, const char* name, double size, int transparency) {
    return fmt::format(
        ", \\\n    \"recovery_points.csv\" skip 1 using 1:($5=={}?${}:NaN) with points pointtype 7 pointsize {:g} "
        "linecolor rgb \"{}\" {}",
        static_cast<int>(kind), column, size, with_transparency(colour, transparency),
        titled ? fmt::format("title \"{}\"", name) : std::string("notitle"));
  };
  const int bolder = style.transparency * 2 / 3;
  std::string text;
  if (points.any_contaminated) {
    text += clause(StarClass::kContaminated, palette::kContaminated, "contaminated", style.size, bolder);
  }
  text += clause(StarClass::kUncontaminated, palette::kMeasured, "uncontaminated", style.size, style.transparency);
  if (points.any_saturated) {
    text += clause(StarClass::kSaturated, palette::kSaturated, "saturated", style.size + 0.1, bolder / 2);
  }
  if (points.any_flagged) {
    text += clause(StarClass::kFlagged, palette::kMuted, "otherwise flagged", style.size + 0.1, bolder / 2);
  }
  return text;
}

std::string panel(double bottom, double top, const char* ylabel, bool last, const std::string& xlabel) {
  return fmt::format(
      "  set bmargin at screen {:g}\n  set tmargin at screen {:g}\n  set lmargin at screen 0.1\n  set rmargin at "
      "screen 0.975\n"
      "  set ylabel \"{}\" offset 0,0\n  set xlabel \"{}\"\n  set format x \"{}\"\n",
      bottom, top, ylabel, last ? xlabel : "", last ? "%g" : "");
}

}  // namespace

Figure figure_recovery(std::span<const TargetMetrics> targets, std::span<const RecoveryBin> bins,
                       const FigureContext& context) {
  Figure figure;
  figure.name = "magnitude_recovery";
  figure.title = "Magnitude recovery";
  figure.height = 960;
  const RecoveryPoints points = recovery_points(targets, context);
  CsvText lines("mag,delta_mag,contamination_mag,aperture_loss_mag,bias_mmag,bias_err_mmag,expected_scatter_mmag");
  std::vector<double> residuals = points.residuals;
  for (const RecoveryBin& bin : bins) {
    lines.row(0.5 * (bin.mag_low + bin.mag_high), bin.delta_median, bin.contamination_median, bin.aperture_loss_median,
              kMillimagnitudes * bin.residual.value, kMillimagnitudes * bin.residual.error,
              kMillimagnitudes * bin.expected_scatter);
  }
  figure.data = {{"recovery_points.csv", points.csv}, {"recovery_bins.csv", lines.text()}};
  figure.caption =
      "Top: measured against true magnitude, with the line of equality in green. Middle: their difference, and the "
      "medians of what "
      "neighbours in the aperture (brighter) and light outside it (fainter) make of it; saturated stars lie above "
      "because charge is "
      "lost. Bottom: what neither explains, for uncontaminated stars: means per half magnitude with standard errors, "
      "and the scatter "
      "that noise and unequal pixels lead to expect (band)." +
      thinning_text(thinning(targets.size()));

  const AxisRange mag = full_range(points.mags, 0.03);
  const AxisRange measured = full_range(points.measured, 0.04);
  constexpr double kMostShown = 2.0;  // mag: a few hopeless stars must not flatten the rest
  AxisRange delta = robust_range(points.deltas, 0.004, 0.12);
  delta = {std::max(-kMostShown, std::min(delta.low, -0.05)), std::min(kMostShown, std::max(delta.high, 0.05))};
  const AxisRange spread = robust_range(residuals, 0.02, 0.25);
  const double reach = std::max({1.0, std::abs(spread.low), std::abs(spread.high)});
  const std::string xlabel = gnuplot_text("true " + context.magnitude_label);

  std::string& c = figure.commands;
  c = fmt::format("  set multiplot\n  set xrange [{:g}:{:g}]\n", mag.low, mag.high);
  c += panel(0.56, 0.98, "measured magnitude", false, xlabel);
  c += fmt::format(
      "  set yrange [{:g}:{:g}]\n  set key at graph 0.015, graph 0.97 left top vertical Left reverse\n"
      "  plot x with lines linewidth 1.8 linecolor rgb \"{}\" title \"equality\"{}\n",
      measured.low, measured.high, palette::kEqual, class_points(points, 2, true));
  c += panel(0.315, 0.535, "measured − true, mag", false, xlabel);
  c += fmt::format(
      "  set yrange [{:g}:{:g}]\n  set key at graph 0.985, graph 0.96 right top vertical Left reverse width -6\n"
      "  plot 0 with lines linewidth 1.2 linecolor rgb \"{}\" notitle{}"
      ", \\\n    \"recovery_bins.csv\" skip 1 using 1:4 with lines linewidth 2 linecolor rgb \"{}\" title \"light "
      "outside the aperture\""
      ", \\\n    \"recovery_bins.csv\" skip 1 using 1:3 with lines linewidth 2 linecolor rgb \"{}\" title \"neighbours "
      "in it\"\n",
      delta.low, delta.high, palette::kEqual, class_points(points, 3, false), palette::kReadout, palette::kPredicted);
  c += panel(0.07, 0.29, "unexplained, mmag", true, xlabel);
  c += fmt::format(
      "  set yrange [{:g}:{:g}]\n  set key at graph 0.015, graph 0.96 left top horizontal Left reverse\n"
      "  plot \"recovery_bins.csv\" skip 1 using 1:(-$7):7 with filledcurves fillcolor rgb \"{}\" fillstyle solid 0.5 "
      "noborder title \"expected scatter\""
      ", \\\n    0 with lines linewidth 1.2 linecolor rgb \"{}\" notitle"
      ", \\\n    \"recovery_points.csv\" skip 1 using 1:($5==0?$4:NaN) with points pointtype 7 pointsize {:g} "
      "linecolor rgb \"{}\" notitle"
      ", \\\n    \"recovery_bins.csv\" skip 1 using 1:5:6 with yerrorbars pointtype 7 pointsize 0.6 linewidth 1.6 "
      "linecolor rgb \"{}\" title \"mean, uncontaminated\"\n"
      "  unset multiplot\n",
      -reach, reach, "#dbe7ee", palette::kEqual, point_style(points.drawn).size,
      with_transparency(palette::kMeasured, point_style(points.drawn).transparency), palette::kPredicted);
  return figure;
}

Figure figure_contamination(std::span<const TargetMetrics> targets, const FigureContext& context) {
  Figure figure;
  figure.name = "contamination";
  figure.title = "Contamination";
  figure.height = 460;
  const std::size_t step = thinning(targets.size());
  CsvText points("mag,spr_tot");
  std::vector<double> mags, shares;
  std::size_t drawn = 0;
  std::size_t none = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const TargetMetrics& target = targets[i];
    if ((target.flags & (measurement_flag::kOutside | measurement_flag::kNoFlux)) != 0) continue;
    mags.push_back(target.mag);
    if (!(target.spr_tot > 0.0)) {
      ++none;
      continue;
    }
    shares.push_back(target.spr_tot);
    if (i % step != 0) continue;
    points.row(target.mag, target.spr_tot);
    ++drawn;
  }
  figure.data = {{"contamination_points.csv", points.text()}};
  const double limit = context.setup.uncontaminated_spr;
  const auto above =
      static_cast<std::size_t>(std::count_if(shares.begin(), shares.end(), [limit](double s) { return s >= limit; }));
  figure.caption = fmt::format(
      "Neighbours' share of all star light in each target's aperture (SPR, sky excluded). {} of {} targets lie above "
      "the limit of {:g} "
      "(dashed) and do not judge magnitude recovery.{}{}",
      above, mags.size(), limit, none > 0 ? fmt::format(" {} without any neighbour are not drawn.", none) : "",
      thinning_text(step));
  shares.push_back(limit);
  AxisRange share = robust_range(shares, 0.005, 0.0);
  share = {std::max(1e-9, share.low / 2.0), std::min(1.0, share.high * 2.0)};
  const AxisRange mag = full_range(mags, 0.03);
  const PointStyle style = point_style(drawn);
  figure.commands = fmt::format(
      "  set logscale y\n  set xrange [{0:g}:{1:g}]\n  set yrange [{2:g}:{3:g}]\n  set xlabel \"{4}\"\n"
      "  set ylabel \"neighbours' share of the light (SPR)\"\n  unset key\n{5}"
      "  set arrow from {0:g},{6:g} to {1:g},{6:g} nohead front linewidth 1.2 dashtype (8,5) linecolor rgb \"{7}\"\n"
      "  set label \"limit {6:g}\" at graph 0.01, first {6:g} left offset 0,0.6 front textcolor rgb "
      "\"{7}\"\n"
      "  plot \"contamination_points.csv\" skip 1 using 1:($2<{6:g}?$2:NaN) with points pointtype 7 pointsize {8:g} "
      "linecolor rgb \"{9}\""
      ", \\\n    \"contamination_points.csv\" skip 1 using 1:($2>={6:g}?$2:NaN) with points pointtype 7 pointsize "
      "{8:g} linecolor rgb \"{10}\"\n",
      mag.low, mag.high, share.low, share.high, gnuplot_text(context.magnitude_label), log_tics("y", share), limit,
      palette::kInk, style.size, with_transparency(palette::kMeasured, style.transparency),
      with_transparency(palette::kContaminated, style.transparency * 2 / 3));
  return figure;
}

}  // namespace astroid
