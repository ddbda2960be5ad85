#include "astroid/pipeline/run_record.hpp"

#include <fitsio.h>
#include <fmt/format.h>
#include <gsl/gsl_version.h>
#include <libxml/xmlversion.h>
#include <sys/resource.h>
#include <wcslib/wcslib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/camera_groups.hpp"
#include "host.hpp"

namespace astroid {

namespace {

/// First line of what a program prints, or "missing".
std::string first_line_of(const char* command) {
  FILE* pipe = popen(command, "r");  // NOLINT(cert-env33-c): fixed commands of ours
  if (pipe == nullptr) return "missing";
  std::array<char, 256> line{};
  const bool read = std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr;
  pclose(pipe);
  std::string text = read ? line.data() : "";
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.empty() ? "missing" : text;
}

nlohmann::ordered_json product_list(std::span<const Product> products) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Product& product : products)
    list.push_back({{"path", product.path}, {"bytes", product.bytes}, {"sha256", product.sha256}});
  return list;
}

nlohmann::ordered_json groups_of(const PreparedRun& run) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t g = 0; g < run.groups.size(); ++g) {
    const Scene& scene = *run.groups[g].scene;
    const Mission& mission = scene.mission();
    const Boresight camera = camera_boresight(mission);
    nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
    for (int c = 0; c < mission.telescope.simulated_cameras; ++c)
      if (group_of_camera(mission.telescope, c) == static_cast<int>(g)) numbers.push_back(c + 1);
    list.push_back({{"observing", mission.telescope.groups.cameras[g]},
                    {"simulated", numbers},
                    {"axis_ra_deg", camera.axis.ra},
                    {"axis_dec_deg", camera.axis.dec},
                    {"roll_deg", camera.roll.value()},
                    {"stagger_s", mission.simulation.stagger.value()},
                    {"stars", scene.stars().size()},
                    {"targets", scene.targets().size()}});
  }
  return list;
}

}  // namespace

std::vector<ComponentVersion> component_versions() {
  float cfitsio = 0.0F;
  ffvers(&cfitsio);
  return {{"astroid", ASTROID_VERSION},
          {"compiler", __VERSION__},
          {"CFITSIO", fmt::format("{:.2f}", cfitsio)},
          {"WCSLIB", wcslib_version(nullptr)},
          {"GSL", gsl_version},
          {"libxml2", LIBXML_DOTTED_VERSION},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"gnuplot", first_line_of("gnuplot --version 2>/dev/null")}};
}

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kKibi = 1024.0;
  return kKibi * static_cast<double>(usage.ru_maxrss);
}

void write_run_record(const ProductFolder& folder, const RunRecord& record) {
  nlohmann::ordered_json json;
  json["program"] = "astroid";
  json["version"] = ASTROID_VERSION;
  json["written"] = utc_now();
  json["host"] = {
      {"name", host_name()}, {"processor", processor_name()}, {"processors", std::thread::hardware_concurrency()}};
  for (const ComponentVersion& component : component_versions()) json["components"][component.name] = component.version;
  json["command_line"] = record.command_line;
  json["threads"] = record.threads;
  if (record.run != nullptr) {
    const Scene& scene = record.run->scene();
    json["seed"] = record.run->scene().mission().simulation.seed;
    json["random_numbers"] = "Philox4x32-10, addressed (docs/random-numbers.md)";
    json["exposures"] = record.run->scene().mission().simulation.exposures;
    json["cameras"] = {{"observing", record.run->scene().mission().telescope.cameras},
                       {"simulated", record.run->scene().mission().telescope.simulated_cameras}};
    json["stars"] = scene.stars().size();
    json["targets"] = record.run->groups.front().targets.size();
    json["pixels"] = scene.layout()->size();
    if (record.run->groups.size() > 1) json["cameras"]["groups"] = groups_of(*record.run);
  }
  if (record.stream != nullptr) {
    const StreamTimings& t = record.stream->timings;
    json["timings_seconds"] = {
        {"prepare", t.prepare},     {"simulate_cpu", t.simulate},        {"measure_cpu", t.measure},
        {"images_cpu", t.images},   {"statistics", t.statistics},        {"light_curves", t.light_curves},
        {"exposures_wall", t.wall}, {"analyse", record.analyse_seconds}, {"all", record.wall_seconds}};
    if (record.run != nullptr) {
      const double exposures = static_cast<double>(record.run->scene().mission().simulation.exposures) *
                               record.run->scene().mission().telescope.simulated_cameras;
      json["seconds_per_exposure"] = {{"predicted", record.run->plan().seconds_per_exposure},
                                      {"measured", t.simulate / exposures}};
    }
    for (const auto& [name, seconds] : record.stream->effect_seconds) json["effects_cpu_seconds"][name] = seconds;
    if (record.run != nullptr)
      for (const PlannedEffect& effect : record.run->plan().effects)
        if (effect.need.needed)
          json["effects_predicted_seconds"][std::string(effect.effect->spec().name)] =
              effect.seconds * static_cast<double>(record.run->scene().mission().simulation.exposures) *
              record.run->scene().mission().telescope.simulated_cameras;
    json["images_written"] = record.stream->images_written;
    json["electrons_lost_by_blooming"] = record.stream->lost_electrons;
    json["pixels_clipped_by_adc"] = record.stream->clipped_pixels;
  }
  json["peak_memory_bytes"] = static_cast<std::int64_t>(peak_memory_bytes());
  json["warnings"] = record.warnings;
  json["products"] = product_list(folder.products(record.checksums));
  write_text_file(folder.file("run.json"), json.dump(2) + "\n");
}

void refresh_run_record(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  if (!std::filesystem::exists(file)) return;
  auto json = nlohmann::ordered_json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object()) return;  // somebody else's
  json["products"] = product_list(products_in(folder));
  write_text_file(file, json.dump(2) + "\n");
}

}  // namespace astroid
