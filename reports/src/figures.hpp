// The figures of the report.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/analysis/noise_vs_magnitude.hpp"
#include "astroid/analysis/recovery.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/image.hpp"
#include "astroid/reports/figure.hpp"
#include "astroid/reports/report.hpp"

namespace astroid {

/// What every figure must know of the run.
struct FigureContext {
  std::string magnitude_label;  ///< of the axis, "magnitude (P)"
  std::string bin_text;         ///< "1 h"
  RunSetup setup;
  std::optional<Requirement> requirement;
};

Figure figure_noise(std::span<const TargetMetrics> targets, std::span<const NoiseBin> bins,
                    const FigureContext& context);
Figure figure_ratio(std::span<const TargetMetrics> targets, std::span<const NoiseBin> bins,
                    const FigureContext& context);
Figure figure_recovery(std::span<const TargetMetrics> targets, std::span<const RecoveryBin> bins,
                       const FigureContext& context);
Figure figure_contamination(std::span<const TargetMetrics> targets, const FigureContext& context);
Figure figure_budget(std::span<const BudgetRow> rows, const FigureContext& context);
Figure figure_image(ImageView<const float, unit::Adu> image, const std::string& caption);
Figure figure_light_curves(std::span<const ExampleLightCurve> curves, const FigureContext& context);

/// Text of a CSV file in memory.
class CsvText {
 public:
  explicit CsvText(const std::string& header) : text_(header + "\n") {}
  template <class... Numbers>
  void row(Numbers... numbers) {
    std::size_t left = sizeof...(numbers);
    ((text_ += shortest_text(static_cast<double>(numbers)), text_ += --left > 0 ? ',' : '\n'), ...);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Every k-th star where there are too many for a scatter diagram. @returns the step k.
std::size_t thinning(std::size_t stars);
/// " Every 7th star is drawn." or nothing.
std::string thinning_text(std::size_t step);
/// Size of a point and its opacity as gnuplot's colour prefix ("#AARRGGBB" counts transparency).
struct PointStyle {
  double size;
  int transparency;  ///< 0 opaque, 255 invisible
};
PointStyle point_style(std::size_t points);
/// "#aarrggbb" from "#rrggbb".
std::string with_transparency(const std::string& colour, int transparency);

}  // namespace astroid
