#include "astroid/reports/focal_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"
#include "astroid/reports/tables.hpp"
#include "figure_tools.hpp"
#include "figures.hpp"
#include "page.hpp"

namespace astroid {

namespace {

constexpr int kMapSide = 41;  // places along each side of the maps

/// A quantity that is mapped.
struct Mapped {
  const char* name;
  std::string title;
  const char* unit;
  FocalPlaneValue SubFieldMetrics::*of;
};

std::vector<Mapped> quantities(const FocalPlaneInput& input) {
  const std::string star = fmt::format("a star of {} = {:.2f}", input.passband.empty() ? "magnitude" : input.passband,
                                       input.reference_magnitude);
  const std::string noise = fmt::format("noise of {} in {}, {} camera{}", star, bin_text(input.bin_hours),
                                        input.cameras, input.cameras == 1 ? "" : "s");
  return {{"nsr_predicted", "Predicted " + noise, "ppm", &SubFieldMetrics::nsr_predicted},
          {"nsr_measured", "Measured " + noise, "ppm", &SubFieldMetrics::nsr_measured},
          {"spr", "Median stellar pollution ratio", "", &SubFieldMetrics::spr},
          {"recovery", "Magnitude measured - true, unexplained part", "mag", &SubFieldMetrics::recovery}};
}

FocalPlaneSurface surface_of(const FocalPlaneInput& input, const Mapped& quantity) {
  std::vector<FocalPlanePoint> points;
  for (const SubFieldMetrics& s : input.sub_fields) points.push_back({s.x, s.y, s.*quantity.of});
  return {points, input.detector};
}

/// Coordinates along one side, edges included.
std::vector<double> places(int first, int count) {
  std::vector<double> at;
  at.reserve(kMapSide);
  for (int i = 0; i < kMapSide; ++i) at.push_back(first + (count - 1.0) * i / (kMapSide - 1.0));
  return at;
}

Figure figure_focal_plane(const FocalPlaneInput& input, const Mapped& quantity) {
  const FocalPlaneSurface surface = surface_of(input, quantity);
  CsvText map("x,y,value,error");
  const std::vector<double> xs = places(input.detector.x0, input.detector.nx);
  const std::vector<double> ys = places(input.detector.y0, input.detector.ny);
  std::vector<double> values;
  for (const double y : ys)
    for (const double x : xs) {
      const FocalPlaneValue at = surface(x, y);
      values.push_back(at.value);
      map.row(x, y, at.value, at.error);
    }
  CsvText points("x,y,value,error");
  for (const SubFieldMetrics& s : input.sub_fields) {
    points.row(s.x, s.y, (s.*quantity.of).value, (s.*quantity.of).error);
    values.push_back((s.*quantity.of).value);
  }
  const AxisRange range = full_range(values, 0.02);
  Figure figure;
  figure.name = std::string("focal_plane_") + quantity.name;
  figure.title = quantity.title;
  constexpr const char* kSurfaces[] = {"their weighted mean", "a plane", "a quadratic surface"};
  figure.caption = fmt::format(
      "Circles are the simulated sub-fields, with their values; the colours between them are {} through them. Errors "
      "of "
      "both are in analysis/focal_plane.csv and focal_plane_map.csv.",
      kSurfaces[std::clamp(surface.degree(), 0, 2)]);
  figure.width = 760;
  figure.height = 680;
  const std::string stem = figure.name;
  figure.data = {{stem + "_map.csv", map.text()}, {stem + "_points.csv", points.text()}};
  figure.commands = fmt::format(
      "  set size ratio -1\n  unset grid\n  unset key\n  set border 15 linewidth 0.6\n  set style fill solid 1.0\n"
      "  set palette defined (0 \"#16264a\", 0.3 \"#2f6690\", 0.6 \"#81b1cc\", 0.85 \"#f2e8cf\", 1 \"#e09f3e\")\n"
      "  set cbrange [{:.8g}:{:.8g}]\n  set cblabel \"{}\"\n  set xrange [{}:{}]\n  set yrange [{}:{}]\n"
      "  set xlabel \"column, px\"\n  set ylabel \"row, px\"\n  set title \"{}\"\n"
      "  plot \"{}_map.csv\" skip 1 using 1:2:3 with image, \\\n"
      "    \"{}_points.csv\" skip 1 using 1:2:3 with points pointtype 7 pointsize 2.2 linecolor palette, \\\n"
      "    \"\" skip 1 using 1:2 with points pointtype 6 pointsize 2.2 linewidth 1.2 linecolor rgb \"{}\", \\\n"
      "    \"\" skip 1 using 1:2:(sprintf(\"%.3g\", $3)) with labels offset 0,1.2 font \",10\" textcolor rgb \"{}\"\n",
      range.low, range.high, *quantity.unit != '\0' ? quantity.unit : "ratio", input.detector.x0 - 0.5,
      input.detector.x1() - 0.5, input.detector.y0 - 0.5, input.detector.y1() - 0.5, gnuplot_text(quantity.title), stem,
      stem, palette::kInk, palette::kInk);
  return figure;
}

void write_map(const std::filesystem::path& path, const FocalPlaneInput& input) {
  const std::vector<Mapped> all = quantities(input);
  std::vector<FocalPlaneSurface> surfaces;
  surfaces.reserve(all.size());
  for (const Mapped& quantity : all) surfaces.push_back(surface_of(input, quantity));
  std::vector<FocalPlaneMapRow> rows;
  for (const double y : places(input.detector.y0, input.detector.ny))
    for (const double x : places(input.detector.x0, input.detector.nx))
      rows.push_back({x, y, surfaces[0](x, y), surfaces[1](x, y), surfaces[2](x, y), surfaces[3](x, y)});
  write_table(path, focal_plane_map_columns(), std::span<const FocalPlaneMapRow>(rows));
}

}  // namespace

std::vector<std::string> write_focal_plane(const std::filesystem::path& folder, const FocalPlaneInput& input) {
  const std::filesystem::path analysis = folder / "analysis";
  std::error_code error;
  std::filesystem::create_directories(analysis, error);
  if (error) throw EnvironmentError(analysis.string(), error.message());
  write_table(analysis / "focal_plane.csv", focal_plane_columns(), input.sub_fields);
  write_map(analysis / "focal_plane_map.csv", input);
  std::vector<Figure> figures;
  for (const Mapped& quantity : quantities(input))
    if (surface_of(input, quantity).degree() >= 0) figures.push_back(figure_focal_plane(input, quantity));
  return draw_figures(folder / "report" / "figures", figures, input.threads);
}

}  // namespace astroid
