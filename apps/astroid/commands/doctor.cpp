#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "astroid/core/error.hpp"
#include "astroid/core/vector_target.hpp"
#include "astroid/pipeline/calibrate.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

namespace {

void calibrate_machine() {
  constexpr double kSecondsAScene = 1.0;
  const std::filesystem::path file = costs_file();
  if (file.empty()) throw EnvironmentError("costs.json", "neither HOME nor XDG_CACHE_HOME says where to keep it");
  fmt::print("\nMeasuring this machine; leave it alone for some seconds\n");
  const CostFactors costs =
      measure_costs(kSecondsAScene, [](const std::string& scene) { fmt::print("  {}\n", scene); });
  fmt::print("\n  {:<24} time over what plans assume\n", "part");
  for (const auto& [part, factor] : costs.parts) fmt::print("  {:<24} {:.2f}\n", part, factor);
  write_costs(costs, file);
  fmt::print("\nPlans on this machine use these from now on: {}\n", file.string());
}

}  // namespace

int doctor(bool calibrate) {
  for (const ComponentVersion& component : component_versions())
    fmt::print("{:<14} {}\n", component.name, component.version);
  fmt::print("{:<14} {}\n", "processors", std::thread::hardware_concurrency());
  fmt::print("{:<14} {} of {} (ASTROID_VECTORS chooses; results are the same)\n", "vectors", vector_target(),
             fmt::join(vector_targets(), ", "));
  fmt::print("\nMission presets and catalogues are looked for in\n");
  bool found = false;
  for (const auto& folder : data_folders()) {
    fmt::print("  {}\n", folder.string());
    found = true;
  }
  bool healthy = found;
  if (!found) fmt::print("  nowhere: set ASTROID_DATA to the folder share/astroid\n");
  for (const std::string& mission : mission_names()) fmt::print("  preset {}\n", mission);
  for (const ComponentVersion& component : component_versions())
    if (component.name == "gnuplot" && component.version == "missing") {
      fmt::print("\ngnuplot is missing: reports will have no figures (Debian: apt install gnuplot-nox)\n");
      healthy = false;
    }
  if (calibrate) {
    calibrate_machine();
  } else if (read_costs(costs_file()).parts.empty()) {
    fmt::print("\nTimes in plans are those of another machine: astroid doctor --calibrate measures this one.\n");
  }
  fmt::print("\n{}\n", healthy ? "All is well." : "Something is missing, see above.");
  return healthy ? 0 : 3;
}

}  // namespace astroid::commands
