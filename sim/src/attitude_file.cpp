#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/sim/attitude.hpp"
#include "named_columns.hpp"

namespace astroid {

namespace {

constexpr int kMaxSteps = 1000;
constexpr int kMinSteps = 8;

class FileAttitude final : public AttitudeModel {
 public:
  FileAttitude(std::string path, std::vector<double> time, std::vector<Attitude> attitude,
               const SimulationSettings& simulation)
      : path_(std::move(path)),
        time_(std::move(time)),
        attitude_(std::move(attitude)),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()),
        exposures_(simulation.exposures) {}

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps));
    for (std::int64_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < attitude.size(); ++i)
        attitude[i] = at(static_cast<double>(k) * cycle_ + (static_cast<double>(i) + 0.5) * exposure_ / steps);
      visit(attitude);
    }
  }

  [[nodiscard]] AttitudeVariance variance() const override { return variance_of(attitude_); }

  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    const int steps = steps_for(0.0);
    const std::vector<Attitude> all = sample(exposures_, steps);
    const std::size_t block =
        static_cast<std::size_t>(std::min(exposures, exposures_)) * static_cast<std::size_t>(steps);
    std::vector<Attitude> means;
    for (std::size_t first = 0; first + block <= all.size(); first += block) {
      Attitude mean;
      for (std::size_t i = first; i < first + block; ++i) {
        mean.yaw += all[i].yaw / static_cast<double>(block);
        mean.pitch += all[i].pitch / static_cast<double>(block);
        mean.roll += all[i].roll / static_cast<double>(block);
      }
      means.push_back(mean);
    }
    return variance_of(means);
  }

  [[nodiscard]] int steps_for(double /*fraction*/) const override {
    // A file's motion between its samples is a straight line: two steps a sample integrate it well.
    double spacing = exposure_;
    for (std::size_t i = 1; i < time_.size(); ++i) spacing = std::min(spacing, time_[i] - time_[i - 1]);
    const double steps = std::ceil(2.0 * exposure_ / spacing);
    return static_cast<int>(std::clamp(steps, static_cast<double>(kMinSteps), static_cast<double>(kMaxSteps)));
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("attitude from {} ({} samples, {} to {} s)", path_, time_.size(), time_.front(), time_.back());
  }

 private:
  [[nodiscard]] Attitude at(double time) const {
    const auto above = std::upper_bound(time_.begin(), time_.end(), time);
    if (above == time_.begin()) return attitude_.front();
    if (above == time_.end()) return attitude_.back();
    const auto i = static_cast<std::size_t>(above - time_.begin());
    const double u = (time - time_[i - 1]) / (time_[i] - time_[i - 1]);
    const Attitude& a = attitude_[i - 1];
    const Attitude& b = attitude_[i];
    return {a.yaw + u * (b.yaw - a.yaw), a.pitch + u * (b.pitch - a.pitch), a.roll + u * (b.roll - a.roll)};
  }

  static AttitudeVariance variance_of(const std::vector<Attitude>& series) {
    if (series.size() < 2) return {};
    const auto n = static_cast<double>(series.size());
    Attitude mean;
    for (const Attitude& a : series) {
      mean.yaw += a.yaw / n;
      mean.pitch += a.pitch / n;
      mean.roll += a.roll / n;
    }
    AttitudeVariance variance;
    for (const Attitude& a : series) {
      variance.yaw += (a.yaw - mean.yaw) * (a.yaw - mean.yaw) / (n - 1.0);
      variance.pitch += (a.pitch - mean.pitch) * (a.pitch - mean.pitch) / (n - 1.0);
      variance.roll += (a.roll - mean.roll) * (a.roll - mean.roll) / (n - 1.0);
    }
    return variance;
  }

  std::string path_;
  std::vector<double> time_;
  std::vector<Attitude> attitude_;
  double cycle_, exposure_;
  std::int64_t exposures_;
};

}  // namespace

std::shared_ptr<const AttitudeModel> make_file_attitude(const std::string& path, const SimulationSettings& simulation) {
  const CsvTable table = read_csv(path);
  std::vector<Problem> problems;
  constexpr std::array<const char*, 4> kNames{"time_s", "yaw", "pitch", "roll"};
  const auto columns = find_named_columns(table, kNames, "columns time_s, yaw, pitch, roll (s, arcsec)", problems);
  if (!problems.empty()) throw InputError(std::move(problems));

  std::vector<double> time;
  std::vector<Attitude> attitude;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto numbers = finite_numbers(table, row, columns, problems);
    if (!numbers) continue;
    const std::array<double, 4>& values = *numbers;
    if (!time.empty() && values[0] <= time.back()) {
      problems.push_back(
          table.problem(row, *columns[0], "time does not increase", fmt::format("more than {}", time.back())));
      continue;
    }
    time.push_back(values[0]);
    attitude.push_back({values[1], values[2], values[3]});
  }
  const double end =
      static_cast<double>(simulation.exposures - 1) * simulation.cycle.value() + simulation.exposure_time.value();
  if (problems.empty() && (time.size() < 2 || time.front() > 0.0 || time.back() < end))
    problems.push_back({.file = path,
                        .parameter = "Satellite/Jitter/File",
                        .expected = fmt::format("samples from 0 to {} s", end),
                        .message = time.empty() ? "the file has no samples"
                                                : fmt::format("{} samples from {} to {} s do not cover the run",
                                                              time.size(), time.front(), time.back())});
  if (!problems.empty()) throw InputError(std::move(problems));
  return std::make_shared<const FileAttitude>(path, std::move(time), std::move(attitude), simulation);
}

}  // namespace astroid
