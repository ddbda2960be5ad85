#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/core/camera_groups.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string table_of_groups(const PreparedRun& run) {
  const TelescopeSettings& telescope = run.scene().mission().telescope;
  std::string out =
      fmt::format("Cameras    {} in {} groups, {} of them simulated; {} targets are seen by all groups\n\n",
                  telescope.cameras, run.groups.size(), telescope.simulated_cameras, run.groups.front().targets.size());
  out += "  group  cameras   axis RA        Dec       roll   begins  axis at column        row  throughput  targets\n";
  out += "                        deg        deg        deg        s              px         px  of the run\n";
  for (std::size_t g = 0; g < run.groups.size(); ++g) {
    const Scene& scene = *run.groups[g].scene;
    const Mission& mission = scene.mission();
    const Boresight camera = camera_boresight(mission);
    out += fmt::format("  {:>5}  {:>7} {:>10.4f} {:>10.4f} {:>10.4f} {:>8.3f} {:>15.3f} {:>10.3f} {:>11.5f} {:>8}\n",
                       g + 1, telescope.groups.cameras[g], camera.axis.ra, camera.axis.dec, camera.roll.value(),
                       mission.simulation.stagger.value(), mission.ccd.axis_x, mission.ccd.axis_y,
                       mean_throughput(mission), scene.targets().size());
  }
  return out + "\n";
}

}  // namespace

std::string plan_text(const PreparedRun& run) {
  std::string first = to_text(run.plan(), run.scene());
  if (run.groups.size() == 1) return first;
  std::string out = table_of_groups(run) + "Group 1. " + first;
  const std::vector<std::string> known = lines_of(first);
  for (std::size_t g = 1; g < run.groups.size(); ++g) {
    out += fmt::format("\nGroup {}. The same, but for\n\n", g + 1);
    for (const std::string& line : lines_of(to_text(*run.groups[g].plan, *run.groups[g].scene)))
      if (std::ranges::find(known, line) == known.end() && !line.ends_with(" ms per exposure")) out += line + "\n";
  }
  return out;
}

std::string plan_json(const PreparedRun& run) {
  if (run.groups.size() == 1) return to_json(run.plan(), run.scene());
  nlohmann::ordered_json json;
  for (const PreparedGroup& group : run.groups)
    json["groups"].push_back(nlohmann::ordered_json::parse(to_json(*group.plan, *group.scene)));
  return json.dump(2) + "\n";
}

}  // namespace astroid
