#include "astroid/pipeline/calibrate.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "folders.hpp"
#include "host.hpp"
#include "standard_scenes.hpp"

namespace astroid {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median time of each effect of the plan over exposures made in `seconds`, at least a few.
std::vector<double> effect_times(const Simulator& simulator, double seconds) {
  constexpr std::size_t kFewest = 5;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const std::int64_t exposures = simulator.scene().mission().simulation.exposures;
  const std::size_t effects = simulator.plan().effects.size();
  ExposureState state = simulator.make_state();
  std::vector<std::vector<double>> times(effects);
  simulator.simulate(0, state);  // what is kept is made now
  for (std::int64_t k = 1; times.front().size() < kFewest || Clock::now() < end; k = k + 1 < exposures ? k + 1 : 1) {
    std::ranges::fill(state.effect_seconds, 0.0);
    simulator.simulate(k, state);
    for (std::size_t i = 0; i < effects; ++i) times[i].push_back(state.effect_seconds[i]);
  }
  std::vector<double> medians;
  medians.reserve(effects);
  for (std::vector<double>& t : times) medians.push_back(median(std::move(t)));
  return medians;
}

}  // namespace

CostFactors measure_costs(double seconds, const std::function<void(const std::string&)>& progress) {
  CostFactors costs;
  for (const StandardScene& standard : standard_scenes()) {
    if (progress) progress(standard.name);
    const auto scene = std::make_shared<const Scene>(standard.mission, standard.catalogue);
    const auto plan = std::make_shared<const Plan>(make_plan(*scene));
    const std::vector<double> times = effect_times(Simulator(scene, plan, 0), seconds);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const PlannedEffect& effect = plan->effects[i];
      // A part is measured in the first scene that has it.
      if (effect.seconds > 0.0 && times[i] > 0.0)
        costs.parts.try_emplace(cost_part(effect, *plan), times[i] / effect.seconds);
    }
  }
  return costs;
}

std::filesystem::path costs_file() {
  if (const char* file = std::getenv("ASTROID_COSTS"); file != nullptr && *file != '\0') return file;
  std::filesystem::path cache;
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder != nullptr && *folder != '\0') {
    cache = folder;
  } else if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    cache = std::filesystem::path(home) / ".cache";
  }
  return cache.empty() ? cache : cache / "astroid" / "costs.json";
}

void write_costs(const CostFactors& costs, const std::filesystem::path& file) {
  nlohmann::ordered_json json;
  json["about"] = "time of each part of an exposure on this machine over what plans assume; made by astroid doctor";
  json["version"] = ASTROID_VERSION;
  json["processor"] = processor_name();
  json["written"] = utc_now();
  for (const auto& [part, factor] : costs.parts) json["factors"][part] = factor;
  create_folder(file.parent_path());
  write_text_file(file, json.dump(2) + "\n");
}

CostFactors read_costs(const std::filesystem::path& file) {
  CostFactors costs;
  std::error_code ignored;
  if (file.empty() || !std::filesystem::is_regular_file(file, ignored)) return costs;
  try {
    const auto json = nlohmann::json::parse(read_text_file(file), nullptr, false);
    if (!json.is_object() || json.value("version", "") != ASTROID_VERSION ||
        json.value("processor", "") != processor_name() || !json.contains("factors") || !json["factors"].is_object())
      return costs;
    constexpr double kMost = 1e4;  // anything beyond is no measurement
    for (const auto& [part, factor] : json["factors"].items())
      if (factor.is_number() && factor.get<double>() > 1.0 / kMost && factor.get<double>() < kMost)
        costs.parts.emplace(part, factor.get<double>());
  } catch (const std::exception&) {
    costs.parts.clear();  // a time that cannot be predicted well stops nobody
  }
  return costs;
}

}  // namespace astroid
