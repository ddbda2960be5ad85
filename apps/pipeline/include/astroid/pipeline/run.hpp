// The drivers behind the commands: a configuration in, a folder of products out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
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

/// What the cameras of one group see, and what is planned for them.
struct PreparedGroup {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  std::vector<std::size_t> targets;  ///< stars of the scene that are targets of the run
  double share = 1.0;                ///< of the group in all cameras
};

/// A scene and its plan, of every group of cameras. A star is a target of the run where it is one of every group: only
/// then the mean of the cameras is of all of them.
struct PreparedRun {
  std::vector<PreparedGroup> groups;  ///< the same targets in the same order; one group where all cameras are alike
  std::vector<std::string> notes;     ///< of the scenes, and what the groups do not have in common
  [[nodiscard]] const Scene& scene() const { return *groups.front().scene; }
  [[nodiscard]] const Plan& plan() const { return *groups.front().plan; }
};
/// Reads the catalogue, builds the scenes and plans them. @throws InputError, EnvironmentError
PreparedRun prepare_run(const Mission& mission);
/// The same with stars in the zero point's passband, or in pixels and electrons.
PreparedRun prepare_run(const Mission& mission, const StarCatalogue& catalogue);

/// The plan of a run as plan.txt and plan.json have it: of several groups of cameras what each of them sees, the plan
/// of the first, and what is otherwise in the others.
std::string plan_text(const PreparedRun& run);
std::string plan_json(const PreparedRun& run);

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
