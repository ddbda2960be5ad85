#include "astroid/reports/tradeoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "astroid/reports/tables.hpp"
#include "figure_tools.hpp"
#include "figures.hpp"

namespace astroid {

namespace {

constexpr double kFloor = 1e-5;  // ppm: what errs by less is drawn there

double drawn(double error) {
  return std::max(error, kFloor);
}

/// A family of settings, as a line through its points.
struct Family {
  const char* starts;  ///< the setting, or ends with it
  const char* name;
  const char* colour;
  int point;
};
constexpr Family kFamilies[] = {{"snap", "snapped to sub-pixels", palette::kMuted, 6},
                                {"midpoint", "sampled at midpoints", palette::kSaturated, 4},
                                {"Gauss", "Gauss-Legendre nodes", palette::kReadout, 12},
                                {"linear", "phases, linear", palette::kContaminated, 8},
                                {"cubic", "phases, cubic", palette::kPhoton, 10},
                                {"prf ", "prf, by accuracy", palette::kEqual, 7}};

bool belongs(const TradeoffRow& row, const Family& family) {
  return row.sweep == Sweep::kRenderer && !row.chosen &&
         (row.setting.starts_with(family.starts) || row.setting.ends_with(family.starts));
}

std::string renderer_points(std::span<const TradeoffRow> rows, const std::function<bool(const TradeoffRow&)>& wanted) {
  CsvText csv("us_per_star,error_ppm,value");
  constexpr double kMilliseconds = 1e3;  // of 1000 stars are microseconds of one
  for (const TradeoffRow& row : rows)
    if (wanted(row)) csv.row(kMilliseconds * row.seconds, drawn(row.error_rms), row.value);
  return csv.text();
}

std::string level(double ppm, const char* text) {
  return fmt::format(
      "  set arrow from graph 0, first {0:.6g} to graph 1, first {0:.6g} nohead dashtype 2 linecolor rgb \"{1}\"\n"
      "  set label \"{2}\" at graph 0.985, first {0:.6g} right offset 0,0.6 textcolor rgb \"{1}\" font \",10\"\n",
      ppm, palette::kInk, text);
}

Figure figure_renderers(const TradeoffInput& input) {
  Figure figure;
  figure.name = "tradeoff_renderers";
  figure.title = "What the accuracy of a star's image costs";
  figure.height = 640;
  figure.caption = fmt::format(
      "Error of the light in 3 x 3 px, rms over 200 places in the pixel, against CPU time of a star on one core. "
      "Numbers are "
      "sub-pixels, nodes or phases per axis. Left and low is better. Errors below {:g} ppm are drawn there.",
      kFloor);
  std::vector<double> times;
  std::vector<double> errors{input.photon_noise, input.photon_noise_bin, kFloor};
  for (const TradeoffRow& row : input.rows)
    if (row.sweep == Sweep::kRenderer) {
      times.push_back(std::log10(1e3 * row.seconds));
      errors.push_back(drawn(row.error_rms));
    }
  const AxisRange x = full_range(times, 0.12);
  figure.commands = fmt::format(
      "  set logscale xy\n  set format y \"10^{{%L}}\"\n  set xrange [{:.6g}:{:.6g}]\n  set yrange [{:.6g}:{:.6g}]\n"
      "  set xlabel \"CPU time of a star, {{/Symbol m}}s\"\n  set ylabel \"error, ppm rms\"\n  set key bottom right\n",
      std::pow(10.0, x.low), std::pow(10.0, x.high), 0.3 * kFloor, 3.0 * *std::ranges::max_element(errors));
  figure.commands += level(input.photon_noise, "photon noise of the brightest target, one exposure");
  figure.commands += level(input.photon_noise_bin, "the same of a bin of all cameras");
  std::string curves;
  for (const Family& family : kFamilies) {
    const auto wanted = [&](const TradeoffRow& row) { return belongs(row, family); };
    if (std::ranges::none_of(input.rows, wanted)) continue;
    std::string file = std::string("tradeoff_") + family.starts;
    std::erase_if(file, [](char c) { return c == ' '; });
    file += ".csv";
    figure.data.emplace_back(file, renderer_points(input.rows, wanted));
    curves += fmt::format(
        "{0} \"{1}\" skip 1 using 1:2 with linespoints pointtype {2} pointsize 1.1 linecolor rgb \"{3}\" title "
        "\"{4}\", \\\n"
        "    \"{1}\" skip 1 using 1:2:(sprintf(\"%g\", $3)) with labels offset 1.2,0.5 font \",9\" textcolor rgb "
        "\"{3}\" notitle",
        curves.empty() ? "  plot" : ", \\\n   ", file, family.point, family.colour, family.name);
  }
  figure.data.emplace_back("tradeoff_planned.csv", renderer_points(input.rows, [](const TradeoffRow& row) {
                             return row.sweep == Sweep::kRenderer && row.chosen;
                           }));
  curves += fmt::format(
      "{} \"tradeoff_planned.csv\" skip 1 using 1:2 with points pointtype 7 pointsize 2.4 linecolor rgb \"{}\" title "
      "\"as "
      "planned\"\n",
      curves.empty() ? "  plot" : ", \\\n   ", palette::kPredicted);
  figure.commands += curves;
  return figure;
}

Figure figure_accuracy(const TradeoffInput& input) {
  Figure figure;
  figure.name = "tradeoff_accuracy";
  figure.title = "What is asked, what is kept, and what it costs";
  figure.height = 760;
  figure.caption =
      "Above: the error of every target's flux with its neighbours, in parts of what is promised to it, the larger of "
      "the accuracy "
      "asked for and 1 % of its noise: below the line is kept. Below: CPU time of an exposure's noiseless image per "
      "1000 stars, and before the first.";
  CsvText csv("asked_ppm,of_promise,error_max_ppm,ms_per_1000_stars,s_once");
  std::vector<double> parts{1.0};
  for (const TradeoffRow& row : input.rows)
    if (row.sweep == Sweep::kAccuracy) {
      csv.row(row.value, std::max(row.of_promise, 1e-6), drawn(row.error_max), 1e3 * row.seconds, row.seconds_once);
      parts.push_back(std::max(row.of_promise, 1e-6));
    }
  figure.data = {{"tradeoff_accuracy.csv", csv.text()}};
  figure.commands = fmt::format(
      "  set multiplot\n  set logscale xy\n  set xrange [0.005:20000]\n  set lmargin at screen 0.11\n  set rmargin at "
      "screen 0.97\n"
      "  set bmargin at screen 0.55\n  set tmargin at screen 0.97\n  set format x \"\"\n  set yrange [{:.6g}:{:.6g}]\n"
      "  set format y \"10^{{%L}}\"\n  set ylabel \"largest error / promise\"\n  set key bottom right\n"
      "  plot 1 with lines dashtype 2 linecolor rgb \"{}\" title \"promise\", \\\n"
      "    \"tradeoff_accuracy.csv\" skip 1 using 1:2 with linespoints pointtype 7 linecolor rgb \"{}\" title "
      "\"measured\"\n"
      "  set bmargin at screen 0.1\n  set tmargin at screen 0.51\n  set format x \"%g\"\n  set xlabel "
      "\"Simulation/Accuracy, ppm\"\n"
      "  set yrange [*:*]\n  set ylabel \"CPU time\"\n  set key center right\n"
      "  plot \"tradeoff_accuracy.csv\" skip 1 using 1:4 with linespoints pointtype 7 linecolor rgb \"{}\" title \"an "
      "exposure, ms per 1000 stars\", \\\n"
      "    \"\" skip 1 using 1:5 with linespoints pointtype 5 linecolor rgb \"{}\" title \"before the first, s\"\n  "
      "unset multiplot\n",
      0.3 * *std::ranges::min_element(parts), 3.0 * *std::ranges::max_element(parts), palette::kInk, palette::kMeasured,
      palette::kMeasured, palette::kPredicted);
  return figure;
}

Figure figure_effects(const TradeoffInput& input) {
  Figure figure;
  figure.name = "tradeoff_effects";
  figure.title = "What each effect is worth";
  figure.caption =
      "What leaving one effect out would do to fluxes in 3 x 3 px, of the same random draws and of stars without "
      "saturated pixels, and "
      "what it would save.";
  std::vector<const TradeoffRow*> rows;
  for (const TradeoffRow& row : input.rows)
    if (row.sweep == Sweep::kEffect) rows.push_back(&row);
  if (rows.empty()) return figure;
  std::ranges::sort(rows, {}, [](const TradeoffRow* row) { return row->error_rms; });
  constexpr double kLeast = 1e-3;  // ppm
  CsvText csv("error_ppm,ms_per_1000_stars,place");
  std::string tics;
  double most = 1.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    constexpr std::size_t kWithout = 8;  // "without "
    const double error = std::max(rows[i]->error_rms, kLeast);
    csv.row(error, std::max(0.0, 1e3 * rows[i]->seconds), i);
    most = std::max(most, error);
    tics += fmt::format("{}\"{}\" {}", i > 0 ? ", " : "", gnuplot_text(rows[i]->setting.substr(kWithout)), i);
  }
  figure.height = 180 + 26 * static_cast<int>(rows.size());
  figure.data = {{"tradeoff_effects.csv", csv.text()}};
  const auto bars = [&](int column, double from, const char* colour) {
    return fmt::format(
        "  plot \"tradeoff_effects.csv\" skip 1 using ({0}):3:({0}):{1}:($3-0.32):($3+0.32) with boxxyerror fillstyle "
        "solid 0.85 "
        "noborder linecolor rgb \"{2}\"\n",
        from, column, colour);
  };
  figure.commands = fmt::format(
      "  set multiplot\n  unset key\n  set yrange [-0.7:{0:.6g}]\n  set bmargin at screen 0.16\n  set tmargin at "
      "screen 0.97\n"
      "  set lmargin at screen 0.2\n  set rmargin at screen 0.6\n  set ytics ({1})\n  set logscale x\n  set format x "
      "\"10^{{%L}}\"\n"
      "  set xrange [{2:g}:{3:.6g}]\n  set xlabel \"change of fluxes, ppm rms\"\n{4}"
      "  set lmargin at screen 0.64\n  set rmargin at screen 0.97\n  set format y \"\"\n  unset logscale x\n  set "
      "format x \"%g\"\n"
      "  set ytics (\"\" 0)\n  set xrange [0:*]\n  set xlabel \"CPU saved, ms per 1000 stars\"\n{5}  unset multiplot\n",
      static_cast<double>(rows.size()) - 0.3, tics, kLeast, 3.0 * most, bars(1, kLeast, palette::kMeasured),
      bars(2, 0.0, palette::kPredicted));
  return figure;
}

}  // namespace

std::vector<std::string> write_tradeoff(const std::filesystem::path& folder, const TradeoffInput& input) {
  for (const char* part : {"analysis", "report"}) {
    std::error_code error;
    std::filesystem::create_directories(folder / part, error);
    if (error) throw EnvironmentError((folder / part).string(), error.message());
  }
  write_table(folder / "analysis" / "tradeoff.csv", tradeoff_columns(), input.rows);
  std::string text;
  for (const std::string& line : input.advice) text += line + "\n";
  write_text_file(folder / "report" / "tradeoff.txt", text);
  std::vector<Figure> figures{figure_renderers(input), figure_accuracy(input), figure_effects(input)};
  std::erase_if(figures, [](const Figure& figure) { return figure.commands.empty(); });
  return draw_figures(folder / "report" / "figures", figures, input.threads);
}

}  // namespace astroid
