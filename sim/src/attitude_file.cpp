#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/run_time.hpp"
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
        stagger_(simulation.stagger.value()),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()),
        exposures_(simulation.exposures) {}

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps));
    for (std::int64_t k = 0; k < count; ++k) {
      take_exposure(k, 0.0, attitude);
      visit(attitude);
    }
  }

  [[nodiscard]] AttitudeVariance variance() const override { return covariance_of(attitude_, attitude_); }

  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    return covariance_of_mean(exposures, Seconds(0.0));
  }

  [[nodiscard]] AttitudeVariance covariance_of_mean(std::int64_t exposures, Seconds lag) const override {
    return covariance_of(means(exposures, 0.0), means(exposures, lag.value()));
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

  /// The attitudes of exposure k, or of one that begins `lag` later.
  void take_exposure(std::int64_t k, double lag, std::vector<Attitude>& attitude) const {
    const double begin = stagger_ + lag + static_cast<double>(k) * cycle_;
    for (std::size_t i = 0; i < attitude.size(); ++i)
      attitude[i] = at(begin + (static_cast<double>(i) + 0.5) * exposure_ / static_cast<double>(attitude.size()));
  }

  /// Means over so many successive exposures each, as many as the run has.
  [[nodiscard]] std::vector<Attitude> means(std::int64_t exposures, double lag) const {
    const std::int64_t block = std::min(exposures, exposures_);
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps_for(0.0)));
    const auto count = static_cast<double>(attitude.size()) * static_cast<double>(block);
    std::vector<Attitude> means;
    for (std::int64_t first = 0; first + block <= exposures_; first += block) {
      Attitude mean;
      for (std::int64_t k = first; k < first + block; ++k) {
        take_exposure(k, lag, attitude);
        for (const Attitude& a : attitude) {
          mean.yaw += a.yaw / count;
          mean.pitch += a.pitch / count;
          mean.roll += a.roll / count;
        }
      }
      means.push_back(mean);
    }
    return means;
  }

  static Attitude mean_of(const std::vector<Attitude>& series) {
    const auto n = static_cast<double>(series.size());
    Attitude mean;
    for (const Attitude& a : series) {
      mean.yaw += a.yaw / n;
      mean.pitch += a.pitch / n;
      mean.roll += a.roll / n;
    }
    return mean;
  }

  /// Axis by axis. @param b  as many as `a`
  static AttitudeVariance covariance_of(const std::vector<Attitude>& a, const std::vector<Attitude>& b) {
    if (a.size() < 2) return {};
    const double free = static_cast<double>(a.size()) - 1.0;
    const Attitude mean_a = mean_of(a);
    const Attitude mean_b = mean_of(b);
    AttitudeVariance covariance;
    for (std::size_t i = 0; i < a.size(); ++i) {
      covariance.yaw += (a[i].yaw - mean_a.yaw) * (b[i].yaw - mean_b.yaw) / free;
      covariance.pitch += (a[i].pitch - mean_a.pitch) * (b[i].pitch - mean_b.pitch) / free;
      covariance.roll += (a[i].roll - mean_a.roll) * (b[i].roll - mean_b.roll) / free;
    }
    return covariance;
  }

  std::string path_;
  std::vector<double> time_;
  std::vector<Attitude> attitude_;
  double stagger_, cycle_, exposure_;
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
  const double end = end_of_run(simulation).value();
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
