#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "astroid/catalogues/variability.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kPpm = 1e-6;
constexpr double kDegreesPerTurn = 360.0;
constexpr std::string_view kKinds = "sinusoid, transit, eclipse or lightcurve";

/// Reads one table; problems gather.
class TableReader {
 public:
  TableReader(const CsvTable& table, double end, std::vector<Problem>& problems)
      : table_(table), end_(end), problems_(problems) {
    id_ = required_column("id");
    kind_ = required_column("kind");
  }

  std::vector<VariableStar> read() {
    std::vector<VariableStar> stars;
    if (!id_ || !kind_) return stars;
    std::map<std::string, std::size_t> known;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      const std::string id(table_.field(row, *id_));
      if (id.empty()) problems_.push_back(table_.problem(row, *id_, "is missing", "the id of a star of the catalogue"));
      const auto [entry, is_new] = known.emplace(id, stars.size());
      if (is_new) stars.push_back({.id = id, .line = table_.line(row), .variability = {}});
      VariableStar& star = stars[entry->second];
      read_component(row, star.variability);
      if (problems_.empty() && star.variability.least() < 0.0)
        problems_.push_back(table_.problem(row, *kind_, fmt::format("lets the flux of {} become negative", id),
                                           "components that together leave some light"));
    }
    return stars;
  }

 private:
  std::optional<std::size_t> required_column(const char* name) {
    const auto column = table_.column(name);
    if (!column)
      problems_.push_back({.file = table_.file(),
                           .line = table_.header_line(),
                           .parameter = fmt::format("column {}", name),
                           .expected = "columns id, kind and those that the kinds need",
                           .message = "is missing"});
    return column;
  }

  /// The number of a column, in the unit that `scale` makes of it.
  double number(std::size_t row, const char* name, double scale, double least, double most,
                std::optional<double> fallback = {}) {
    const auto column = table_.column(name);
    const bool empty = !column || table_.field(row, *column).empty();
    if (empty && fallback) return *fallback;
    if (empty) {
      problems_.push_back({.file = table_.file(),
                           .line = table_.line(row),
                           .parameter = fmt::format("column {}", name),
                           .expected = "a number",
                           .message = fmt::format("is missing, which {} needs", table_.field(row, *kind_))});
      return 1.0;
    }
    const std::optional<double> value = table_.number(row, *column);
    if (value && *value >= least && *value <= most) return *value * scale;
    problems_.push_back(table_.problem(row, *column, value ? "out of range" : "not a number",
                                       fmt::format("a number from {:.6g} to {:.6g}", least, most)));
    return scale;
  }

  void read_component(std::size_t row, Variability& variability) {
    constexpr double kMost = 1e9;      // of times, in their unit
    constexpr double kLeast = 1e-9;    // likewise, where 0 makes no sense
    constexpr double kAllLight = 1e6;  // ppm
    const std::string_view kind = table_.field(row, *kind_);
    if (kind == "sinusoid") {
      variability.add(
          SinusoidalVariation{.amplitude = number(row, "amplitude_ppm", kPpm, 0.0, kAllLight),
                              .period = number(row, "period_d", kSecondsPerDay, kLeast, kMost),
                              .phase = number(row, "phase_deg", 1.0 / kDegreesPerTurn, -kMost, kMost, 0.0)});
    } else if (kind == "transit" || kind == "eclipse") {
      PeriodicDips dips{.depth = number(row, "depth_ppm", kPpm, 0.0, kAllLight),
                        .duration = number(row, "duration_h", kSecondsPerHour, kLeast, kMost),
                        .ingress = number(row, "ingress_h", kSecondsPerHour, 0.0, kMost, 0.0),
                        .period = number(row, "period_d", kSecondsPerDay, kLeast, kMost),
                        .epoch = number(row, "epoch_d", kSecondsPerDay, -kMost, kMost)};
      if (problems_.empty() && dips.duration > dips.period)
        complain(row, "duration_h", "longer than the period",
                 fmt::format("at most {:.6g} h", dips.period / kSecondsPerHour));
      if (problems_.empty() && 2.0 * dips.ingress > dips.duration)
        complain(row, "ingress_h", "longer than half the duration",
                 fmt::format("at most {:.6g} h", 0.5 * dips.duration / kSecondsPerHour));
      variability.add(dips);
      if (kind == "transit") return;
      dips.depth = number(row, "secondary_ppm", kPpm, 0.0, kAllLight, 0.0);
      dips.epoch += 0.5 * dips.period;
      if (dips.depth > 0.0) variability.add(dips);
    } else if (kind == "lightcurve") {
      read_light_curve(row, variability);
    } else {
      problems_.push_back(table_.problem(row, *kind_, "is not a kind of variable star", std::string(kKinds)));
    }
  }

  void complain(std::size_t row, const char* name, const std::string& message, const std::string& expected) {
    problems_.push_back(table_.problem(row, *table_.column(name), message, expected));
  }

  void read_light_curve(std::size_t row, Variability& variability) {
    const auto column = table_.column("file");
    if (!column || table_.field(row, *column).empty()) {
      problems_.push_back({.file = table_.file(),
                           .line = table_.line(row),
                           .parameter = "column file",
                           .expected = "the name of a file of columns time_s, flux",
                           .message = "is missing, which lightcurve needs"});
      return;
    }
    const std::filesystem::path path =
        std::filesystem::path(table_.file()).parent_path() / std::string(table_.field(row, *column));
    if (!std::filesystem::is_regular_file(path)) {
      problems_.push_back(table_.problem(row, *column, "no such file", "the name of a readable file"));
      return;
    }
    const CsvTable curve = read_csv(path);
    const auto time_column = curve.header().empty() ? std::optional<std::size_t>(0) : curve.column("time_s");
    const auto flux_column = curve.header().empty() ? std::optional<std::size_t>(1) : curve.column("flux");
    if (!time_column || !flux_column || curve.columns() < 2) {
      problems_.push_back({.file = curve.file(),
                           .line = curve.header_line(),
                           .parameter = "columns",
                           .expected = "time_s, flux (s since the start of the run, relative)",
                           .message = "are not those of a light curve"});
      return;
    }
    auto samples = std::make_shared<SampledVariation>();
    samples->file = curve.file();
    for (std::size_t i = 0; i < curve.rows(); ++i) {
      const auto time = curve.number(i, *time_column);
      const auto flux = curve.number(i, *flux_column);
      if (!time || !std::isfinite(*time) || (!samples->time.empty() && *time <= samples->time.back()))
        problems_.push_back(curve.problem(i, *time_column, "is not a time after the one before", "a larger number"));
      else if (!flux || !(*flux >= 0.0) || !std::isfinite(*flux))
        problems_.push_back(curve.problem(i, *flux_column, "is not a relative flux", "a number of at least 0"));
      else
        append(*samples, *time, *flux);
    }
    if (samples->time.size() < 2 || samples->time.front() > 0.0 || samples->time.back() < end_) {
      if (problems_.empty())
        problems_.push_back({.file = curve.file(),
                             .parameter = "column time_s",
                             .expected = fmt::format("samples from 0 to {} s", end_),
                             .message = fmt::format("{} samples do not cover the run", samples->time.size())});
      return;
    }
    variability.add(std::shared_ptr<const SampledVariation>(std::move(samples)));
  }

  static void append(SampledVariation& samples, double time, double flux) {
    samples.integral.push_back(samples.time.empty() ? 0.0
                                                    : samples.integral.back() + 0.5 * (flux + samples.flux.back()) *
                                                                                    (time - samples.time.back()));
    samples.time.push_back(time);
    samples.flux.push_back(flux);
  }

  const CsvTable& table_;
  double end_;
  std::vector<Problem>& problems_;
  std::optional<std::size_t> id_, kind_;
};

}  // namespace

std::vector<VariableStar> read_variables(const std::filesystem::path& path, double end) {
  const CsvTable table = read_csv(path, {.separator = CsvSeparator::kComma, .header = CsvHeader::kPresent});
  std::vector<Problem> problems;
  std::vector<VariableStar> stars = TableReader(table, end, problems).read();
  if (!problems.empty()) throw InputError(std::move(problems));
  return stars;
}

}  // namespace astroid
