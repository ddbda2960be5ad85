// The drivers behind the commands: a configuration in, a folder of products out.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/core/configuration.hpp"
#include "astroid/core/product_folder.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Where and how a run works.
struct RunOptions {
  std::filesystem::path folder;  ///< of the products
  ExistingProducts existing = ExistingProducts::kRefuse;
  int threads = 1;
  std::vector<std::string> command_line;  ///< for run.json
  Progress progress;
};

/// A scene and its plan.
struct PreparedRun {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};
/// Reads the catalogue, builds the scene and plans it. @throws InputError, EnvironmentError
PreparedRun prepare_run(const Mission& mission);

/// What `assess` says at the end.
struct AssessResult {
  std::filesystem::path folder;
  std::filesystem::path report;      ///< report/index.html
  std::vector<std::string> verdict;  ///< two lines
  StreamTimings timings;
};

/// The main job: simulate, calibrate, measure, analyse, report; images stream through memory.
AssessResult assess(const ResolvedConfiguration& configuration, const RunOptions& options);

/// Images and truth only.
StreamResult simulate(const ResolvedConfiguration& configuration, const RunOptions& options);

}  // namespace astroid
