#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "astroid/core/vector_target.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

int doctor() {
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
  fmt::print("\n{}\n", healthy ? "All is well." : "Something is missing, see above.");
  return healthy ? 0 : 3;
}

}  // namespace astroid::commands
