// Small things that several figures need.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "figures.hpp"

namespace astroid {

/// A range on an axis.
struct AxisRange {
  double low = 0.0;
  double high = 1.0;
};

/// The whole range of finite values, widened by `margin` of its width; [0, 1] without values.
AxisRange full_range(std::span<const double> values, double margin);
/// The range that holds all but the fraction `tail` at each end, widened by `margin` of its width.
AxisRange robust_range(std::span<const double> values, double tail, double margin);

/// `set ytics (…)` with 1, 2, 5 in every decade of the range, for a logarithmic axis.
std::string log_tics(const char* axis, AxisRange range);

/// A step of 1, 2 or 5 times a power of ten that puts four to eight tics on a linear axis.
double tic_step(AxisRange range);

/// How a star is drawn.
enum class StarClass { kUncontaminated, kContaminated, kSaturated, kFlagged };
StarClass star_class(const TargetMetrics& target, const RunSetup& setup);

/// The noise of a set of magnitudes by cause, as lines of a figure.
struct NoiseLine {
  double mag;
  double total;
  NoiseByCause causes;
};
/// CSV with the columns of cause_curves(): mag, total, photon, contaminants, background, readout, quantisation, jitter,
/// prnu_jitter. Background is sky, dark current and the estimate of the background together.
std::string noise_lines_csv(std::span<const NoiseLine> lines);
/// `, "file" using … with lines …` for the total and each cause that somewhere reaches a tenth of it.
std::string cause_curves(const std::string& file, std::span<const NoiseLine> lines);
/// Line and label of the requirement.
std::string requirement_mark(const FigureContext& context, double mag_from);

}  // namespace astroid
