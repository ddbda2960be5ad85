// Everything a run found out, as tables, figures and one page.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/analysis/contamination.hpp"
#include "astroid/analysis/noise_vs_magnitude.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// A light curve worth showing.
struct ExampleLightCurve {
  std::string id;
  double mag = 0.0;
  std::vector<double> hours;     ///< since the start of the run, mid-exposure
  std::vector<float> deviation;  ///< flux / reference - 1, same length
};

/// One parameter in the configuration's summary.
struct ReportParameter {
  std::string path, value, unit, origin;
};

/// What the report is made of. Parts that are empty are left out of the page.
struct ReportInput {
  std::string title;                 ///< "plato.xml: 412 stars of LOPS2"
  std::vector<std::string> verdict;  ///< as printed at the end of the run
  RunSetup setup;
  double bin_hours = 1.0;
  std::string passband;  ///< of the magnitudes
  std::optional<Requirement> requirement;
  std::span<const TargetMetrics> targets;
  std::span<const ContaminationRow> contamination;
  std::span<const BudgetRow> budget;
  std::string plan;  ///< plan.txt
  std::vector<ReportParameter> configuration;
  std::vector<std::pair<std::string, std::string>> provenance;  ///< versions, seed, host, time, …
  std::vector<std::string> warnings;
  std::optional<ImageView<const float, unit::Adu>> image;  ///< one exposure
  std::string image_caption;
  std::vector<ExampleLightCurve> light_curves;  ///< the first six are shown
  int threads = 0;                              ///< figures drawn at a time; < 1: as many as the process may run
};

struct WrittenReport {
  std::filesystem::path index;        ///< report/index.html
  std::vector<std::string> products;  ///< every file written, relative to the folder
  std::vector<std::string> problems;  ///< what could not be drawn; also on the page
};

/// Writes analysis/*.csv and report/ (index.html, columns.md, figures/) into the folder of a run. An older report is
/// replaced when the new one is complete.
///
/// @throws EnvironmentError(path, cause). A figure that cannot be drawn is a problem in the result, not an exception.
WrittenReport write_report(const std::filesystem::path& folder, const ReportInput& input);

}  // namespace astroid
