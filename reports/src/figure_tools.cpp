#include "figure_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace astroid {

namespace {

// More points than this hide each other and make an SVG that browsers choke on.
constexpr std::size_t kMostPoints = 6000;
constexpr std::size_t kCauses = 7;

struct CauseStyle {
  const char* name;
  const char* colour;
};
constexpr std::array<CauseStyle, kCauses> kCauseStyles{{{"photon noise", palette::kPhoton},
                                                        {"contaminants", palette::kContaminated},
                                                        {"sky, dark, background", palette::kBackground},
                                                        {"readout", palette::kReadout},
                                                        {"quantisation", palette::kQuantisation},
                                                        {"jitter and drift", palette::kJitter},
                                                        {"jitter on unequal pixels", palette::kMuted}}};

std::array<double, kCauses> cause_values(const NoiseByCause& c) {
  return {c.photon,     c.contaminants, c.of_levels(), c.readout, c.quantisation, std::hypot(c.jitter, c.drift),
          c.prnu_jitter};
}

std::vector<double> sorted_finite(std::span<const double> values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

AxisRange widened(double low, double high, double margin) {
  double width = high - low;
  if (!(width > 0.0)) width = std::max(1e-6, std::abs(high));
  return {low - margin * width, high + margin * width};
}

}  // namespace

AxisRange full_range(std::span<const double> values, double margin) {
  return robust_range(values, 0.0, margin);
}

AxisRange robust_range(std::span<const double> values, double tail, double margin) {
  const std::vector<double> sorted = sorted_finite(values);
  if (sorted.empty()) return {};
  const double last = static_cast<double>(sorted.size() - 1);
  return widened(sorted[static_cast<std::size_t>(std::floor(tail * last))],
                 sorted[static_cast<std::size_t>(std::ceil((1.0 - tail) * last))], margin);
}

std::string log_tics(const char* axis, AxisRange range) {
  std::string tics = fmt::format("  set {}tics (", axis);
  bool first = true;
  const bool few = range.high / range.low < 1e4;
  for (int decade = static_cast<int>(std::floor(std::log10(range.low))); decade <= std::log10(range.high); ++decade) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, decade);
      if (value < range.low * (1.0 - 1e-9) || value > range.high * (1.0 + 1e-9) || (digit != 1 && !few)) continue;
      const bool plain = range.low >= 1e-3 && range.high < 1e6;
      const std::string label =
          plain ? fmt::format("{:g}", value)
                : (digit == 1 ? fmt::format("10^{{{}}}", decade) : fmt::format("{}×10^{{{}}}", digit, decade));
      tics += fmt::format("{}\"{}\" {:g}", first ? "" : ", ", label, value);
      first = false;
    }
  }
  return first ? std::string() : tics + ")\n";
}

double tic_step(AxisRange range) {
  constexpr double kFewest = 4.0;
  const double widest = (range.high - range.low) / kFewest;
  if (!(widest > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(widest)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * decade <= widest) return digit * decade;
  }
  return decade;
}

StarClass star_class(const TargetMetrics& target, const RunSetup& setup) {
  if ((target.flags & measurement_flag::kSaturated) != 0) return StarClass::kSaturated;
  if (!is_clean(target)) return StarClass::kFlagged;
  return target.spr_tot < setup.uncontaminated_spr ? StarClass::kUncontaminated : StarClass::kContaminated;
}

std::string noise_lines_csv(std::span<const NoiseLine> lines) {
  CsvText csv(
      "mag,total_ppm,photon_ppm,contaminants_ppm,background_ppm,readout_ppm,quantisation_ppm,jitter_ppm,prnu_jitter_"
      "ppm");
  for (const NoiseLine& line : lines) {
    const auto v = cause_values(line.causes);
    csv.row(line.mag, line.total, v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
  }
  return csv.text();
}

std::string cause_curves(const std::string& file, std::span<const NoiseLine> lines) {
  constexpr double kWorthALine = 0.1;  // of the total, somewhere
  constexpr int kFirstCauseColumn = 3;
  std::string curves;
  for (std::size_t cause = 0; cause < kCauses; ++cause) {
    const bool drawn = std::any_of(lines.begin(), lines.end(), [cause](const NoiseLine& line) {
      return cause_values(line.causes)[cause] > kWorthALine * line.total;
    });
    if (!drawn) continue;
    curves += fmt::format(
        ", \\\n    \"{}\" skip 1 using 1:{} with lines linewidth 1.4 linecolor rgb \"{}\" title \"{}\"", file,
        kFirstCauseColumn + static_cast<int>(cause), kCauseStyles[cause].colour, kCauseStyles[cause].name);
  }
  return curves;
}

std::string requirement_mark(const FigureContext& context, double mag_from) {
  if (!context.requirement || context.requirement->magnitude <= mag_from) return {};
  const Requirement& r = *context.requirement;
  return fmt::format(
      "  set arrow from {0:g},{2:g} to {1:g},{2:g} nohead front linewidth 1.4 dashtype (8,5) linecolor rgb \"{3}\"\n"
      "  set arrow from {1:g},{2:g} rto 0, graph -0.025 nohead front linewidth 1.4 linecolor rgb \"{3}\"\n"
      "  set label \"required: {2:.0f} ppm to mag {1:g}\" at {0:g},{2:g} left offset 0.8,0.6 front "
      "textcolor rgb \"{3}\"\n",
      mag_from, r.magnitude, r.ppm, palette::kRequirement);
}

std::size_t thinning(std::size_t stars) {
  return stars / kMostPoints + 1;
}

std::string thinning_text(std::size_t step) {
  return step > 1 ? fmt::format(" One star in {} is drawn as a point; lines and medians count all.", step) : "";
}

PointStyle point_style(std::size_t points) {
  if (points > 2000) return {0.25, 150};
  if (points > 500) return {0.35, 120};
  return {0.45, 90};
}

std::string with_transparency(const std::string& colour, int transparency) {
  return fmt::format("#{:02x}{}", transparency, colour.substr(1));
}

}  // namespace astroid
