// From what a run measured to its tables, figures, page and verdict.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/core/configuration.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

/// What the analysis is given.
struct MeasuredRun {
  const ResolvedConfiguration& configuration;
  const PreparedRun& prepared;
  const GroundSegment& ground;
  const StreamResult& stream;
  std::filesystem::path light_curves;  ///< their file; the report shows some, if it is there
  int threads = 0;                     ///< < 1: as many as the process may run; products do not depend on it
};

struct ReportedRun {
  std::filesystem::path index;
  std::vector<std::string> verdict;
  std::vector<std::string> warnings;
};

/// Rows of targets.csv.
std::vector<TargetMetrics> target_metrics(const MeasuredRun& run, const RunSetup& setup);

/// Analyses a run and writes analysis/, report/ and photometry/sources.csv into `folder`. @throws EnvironmentError
ReportedRun report_run(const std::filesystem::path& folder, const MeasuredRun& run);

}  // namespace astroid
