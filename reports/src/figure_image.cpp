#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure_tools.hpp"

namespace astroid {

namespace {

constexpr int kMostPixels = 500;  // along a side of the picture; larger frames are averaged in blocks

/// The image averaged in blocks so that it fits; values that are not finite are left out of the mean.
std::vector<std::vector<double>> reduced(ImageView<const float, unit::Adu> image, int block) {
  const int nx = image.nx() / block;
  const int ny = image.ny() / block;
  std::vector<std::vector<double>> out(static_cast<std::size_t>(ny), std::vector<double>(static_cast<std::size_t>(nx)));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      double sum = 0.0;
      int count = 0;
      for (int y = j * block; y < (j + 1) * block; ++y) {
        const auto row = image.row(image.area().y0 + y);
        for (int x = i * block; x < (i + 1) * block; ++x) {
          const double value = static_cast<double>(row[static_cast<std::size_t>(x)]);
          if (!std::isfinite(value)) continue;
          sum += value;
          ++count;
        }
      }
      out[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = count > 0 ? sum / count : std::nan("");
    }
  }
  return out;
}

/// Detector coordinates of column `column` of the data, whose pixels are blocks: an expression only where it is needed,
/// for gnuplot takes longer over one than over the pixel itself.
std::string coordinate(int column, int origin, int block) {
  if (origin == 0 && block == 1) return fmt::format("{}", column);
  return fmt::format("({}+${}*{})", origin + 0.5 * (block - 1), column, block);
}

double quantile(const std::vector<double>& sorted, double p) {
  return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

Figure figure_image(ImageView<const float, unit::Adu> image, const std::string& caption) {
  Figure figure;
  figure.name = "image";
  figure.title = "One exposure";
  const int block = (std::max(image.nx(), image.ny()) - 1) / kMostPixels + 1;
  const auto pixels = reduced(image, block);
  std::vector<double> sorted;
  std::string csv;
  for (const auto& row : pixels) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (std::isfinite(row[i])) sorted.push_back(row[i]);
      csv += fmt::format("{:.6g}{}", row[i], i + 1 < row.size() ? ',' : '\n');
    }
  }
  std::sort(sorted.begin(), sorted.end());
  // Linear about the sky, logarithmic above it: asinh((v - sky) / soft), soft being the scatter of the darker half.
  const double sky = sorted.empty() ? 0.0 : quantile(sorted, 0.5);
  const double soft = sorted.empty() ? 1.0 : std::max(1e-6, 3.0 * (sky - quantile(sorted, 0.16)));
  const double top = sorted.empty() ? 1.0 : std::max(sky + soft, quantile(sorted, 0.9995));
  const double low = -1.0;
  const double high = std::asinh((top - sky) / soft);
  std::string tics;
  const double decade = std::pow(10.0, std::floor(std::log10(top - sky)));
  for (const double above : {0.0, 0.001, 0.01, 0.1, 0.3, 1.0, 3.0}) {
    const double value = above * decade;
    const double place = std::asinh(value / soft);
    if (place > high || (above > 0.0 && place < 0.12 * high)) continue;
    tics += fmt::format("{}\"{}{:g}\" {:g}", tics.empty() ? "" : ", ", above > 0.0 ? "+" : "sky ",
                        above > 0.0 ? value : std::round(sky), place);
  }
  const double aspect = image.nx() > 0 ? static_cast<double>(image.ny()) / image.nx() : 1.0;
  figure.width = 760;
  constexpr double kPlotWidth = 574.0;  // px between the margins below
  constexpr double kAboveAndBelow = 76.0;
  figure.height = static_cast<int>(std::clamp(kAboveAndBelow + kPlotWidth * aspect, 220.0, 1000.0));
  const double bottom = 58.0 / figure.height;
  figure.data = {{"image.csv", csv}};
  figure.caption = caption;
  if (block > 1) figure.caption += fmt::format(" Averaged in blocks of {0}×{0} pixels.", block);
  figure.commands = fmt::format(
      "  set size ratio -1\n  unset grid\n  unset key\n  set style fill solid 1.0\n  set border 15 linewidth 0.6\n"
      "  set palette defined (0 \"#0b1020\", 0.18 \"#16264a\", 0.42 \"#2f6690\", 0.68 \"#81b1cc\", 0.88 \"#f2e8cf\", 1 "
      "\"#ffffff\")\n"
      "  set cbrange [{:g}:{:g}]\n  set cbtics ({})\n  set colorbox user origin 0.885,0.2 size 0.018,0.6\n"
      "  set xrange [{:g}:{:g}]\n  set yrange [{:g}:{:g}]\n  set xlabel \"column, px\"\n  set ylabel \"row, px\"\n"
      "  set lmargin at screen 0.11\n  set rmargin at screen 0.865\n"
      "  set bmargin at screen {:g}\n  set tmargin at screen {:g}\n"
      "  set label \"ADU\" at screen 0.888,0.83 left\n"
      "  plot \"image.csv\" matrix using {}:{}:(asinh(($3-({:.8g}))/{:.8g})) with image\n",
      low, high, tics, image.area().x0 - 0.5,
      image.area().x0 + static_cast<int>(pixels.empty() ? 0 : pixels[0].size()) * block - 0.5, image.area().y0 - 0.5,
      image.area().y0 + static_cast<int>(pixels.size()) * block - 0.5, bottom,
      bottom + (figure.height - kAboveAndBelow) / figure.height, coordinate(1, image.area().x0, block),
      coordinate(2, image.area().y0, block), sky, soft);
  return figure;
}

Figure figure_light_curves(std::span<const ExampleLightCurve> curves, const FigureContext& context) {
  constexpr std::size_t kMostCurves = 6;
  constexpr std::size_t kPointsPerCurve = 3000;
  constexpr double kPpt = 1000.0;
  Figure figure;
  figure.name = "light_curves";
  figure.title = "Examples of light curves";
  const std::size_t n = std::min(kMostCurves, curves.size());
  const std::size_t columns = n > 1 ? 2 : 1;
  const std::size_t rows = (n + columns - 1) / columns;
  figure.height = static_cast<int>(60 + 210 * rows);
  figure.caption = fmt::format(
      "Relative flux of single exposures (points) and its means over {} (line), as measured. {} camera{} simulated.",
      context.bin_text, context.setup.simulated_cameras, context.setup.simulated_cameras == 1 ? "" : "s");
  std::string& c = figure.commands;
  c = fmt::format("  set multiplot layout {},{} margins 0.09,0.985,{:g},{:g} spacing 0.075,{:g}\n  unset key\n", rows,
                  columns, 50.0 / figure.height, 1.0 - 26.0 / figure.height, 62.0 / figure.height);
  for (std::size_t k = 0; k < n; ++k) {
    const ExampleLightCurve& curve = curves[k];
    const std::size_t step = curve.hours.size() / kPointsPerCurve + 1;
    CsvText points("hours,deviation_ppt");
    CsvText means("hours,deviation_ppt");
    std::vector<double> values;
    double sum = 0.0;
    double when = 0.0;
    std::size_t count = 0;
    const auto per_bin = static_cast<std::size_t>(std::max(1.0, std::round(context.setup.exposures_per_bin)));
    for (std::size_t i = 0; i < curve.hours.size(); ++i) {
      const double value = kPpt * static_cast<double>(curve.deviation[i]);
      values.push_back(value);
      if (i % step == 0) points.row(curve.hours[i], value);
      if (std::isfinite(value)) {
        sum += value;
        when += curve.hours[i];
        ++count;
      }
      if ((i + 1) % per_bin == 0) {
        if (2 * count >= per_bin) means.row(when / static_cast<double>(count), sum / static_cast<double>(count));
        sum = when = 0.0;
        count = 0;
      }
    }
    const std::string stem = fmt::format("light_curve_{}", k + 1);
    figure.data.emplace_back(stem + ".csv", points.text());
    figure.data.emplace_back(stem + "_means.csv", means.text());
    const AxisRange y = robust_range(values, 0.001, 0.25);
    const AxisRange x = full_range(curve.hours, 0.01);
    c += fmt::format(
        "  set title \"{}   mag {:.2f}\" offset 0,-0.7 textcolor rgb \"{}\"\n  set xrange [{:g}:{:g}]\n  "
        "set yrange [{:g}:{:g}]\n"
        "  set ylabel \"{}\" offset 0.6,0\n  set ytics {:g}\n  set xlabel \"{}\"\n"
        "  plot \"{}.csv\" skip 1 using 1:2 with points pointtype 7 pointsize {} linecolor rgb \"{}\""
        ", \\\n    \"{}_means.csv\" skip 1 using 1:2 with linespoints pointtype 7 pointsize 0.25 linewidth 1.4 "
        "linecolor rgb \"{}\"\n",
        gnuplot_text(curve.id), curve.mag, palette::kInk, x.low, x.high, y.low, y.high,
        k % columns == 0 ? "flux − 1, ‰" : "", tic_step(y), k + columns >= n ? "time, h" : "", stem,
        values.size() > 1000 ? 0.15 : 0.25, with_transparency(palette::kMeasured, values.size() > 1000 ? 150 : 110),
        stem, palette::kPredicted);
  }
  c += "  unset multiplot\n";
  return figure;
}

}  // namespace astroid
