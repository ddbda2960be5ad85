#include "astroid/analysis/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "astroid/core/csv.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/error.hpp"
#include "astroid/reports/tables.hpp"
#include "astroid/sim/scene.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

namespace {

/// "DX,DY,DMAG" of each --neighbour. @throws InputError with every one that is not that
std::vector<BudgetNeighbour> neighbours_of(const std::vector<std::string>& texts) {
  std::vector<BudgetNeighbour> neighbours;
  std::vector<Problem> problems;
  neighbours.reserve(texts.size());
  for (const std::string& text : texts) {
    std::vector<double> numbers;
    std::size_t begin = 0;
    while (begin <= text.size()) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::optional<double> number = parse_number(text.substr(begin, end - begin));
      if (number && std::isfinite(*number)) numbers.push_back(*number);
      begin = end + 1;
    }
    constexpr std::size_t kNumbers = 3;
    if (numbers.size() != kNumbers || std::ranges::count(text, ',') != kNumbers - 1) {
      problems.push_back({.parameter = "--neighbour",
                          .value = text,
                          .expected = "DX,DY,DMAG such as 2,0,1.5: pixels and magnitudes",
                          .message = "is not three numbers"});
      continue;
    }
    neighbours.push_back({.dx = numbers[0], .dy = numbers[1], .fainter = DeltaMag(numbers[2])});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return neighbours;
}

}  // namespace

int budget(const BudgetOptions& options) {
  if (!(options.mag_to >= options.mag_from))
    throw InputError(Problem{.parameter = "--to",
                             .value = fmt::format("{}", options.mag_to),
                             .expected = "at least --from",
                             .message = "no magnitudes to compute"});
  if (!options.output.empty() && std::filesystem::exists(options.output) && !options.overwrite)
    throw InputError(
        Problem{.file = options.output, .expected = "another name, or --overwrite", .message = "the file exists"});
  const std::vector<BudgetNeighbour> neighbours = neighbours_of(options.neighbours);
  const Mission mission = read(options.configuration).mission;
  std::vector<double> magnitudes;
  const auto steps = static_cast<int>(std::floor((options.mag_to - options.mag_from) / options.mag_step + 1e-9));
  for (int i = 0; i <= steps; ++i) magnitudes.push_back(options.mag_from + i * options.mag_step);
  const PsfAccuracy accuracy(1e-6 * mission.simulation.accuracy.value());
  const std::vector<BudgetRow> rows =
      analytic_budget(mission, *imaged_psf(mission, make_recorded_psf(mission, accuracy, make_psf(mission, accuracy))),
                      magnitudes, neighbours);

  fmt::print("{} at the centre of a pixel; noise in {:g} h with {} camera(s), ppm\n\n",
             neighbours.empty() ? "Isolated star" : "Star with neighbours", mission.analysis.bin.value() / 3600.0,
             mission.telescope.cameras);
  fmt::print("{:>6} {:>12} {:>4} {:>9} {:>12} {:>8} | {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "mag",
             "e-/exposure", "px", "enclosed", "NSR exposure", "NSR", "photon", "backgr.", "readout", "quant.",
             "b.estim.", "jitter", "PRNU");
  for (const BudgetRow& row : rows) {
    const NoiseByCause& c = row.causes;
    fmt::print(
        "{:6.2f} {:12.6g} {:4d} {:9.6f} {:12.6e} {:8.3f} | {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} "
        "{:8.3f}{}{}\n",
        row.mag, row.electrons, row.mask_pixels, row.enclosed_fraction, row.nsr_exposure, row.nsr_1h_ppm, c.photon,
        c.background, c.readout, c.quantisation, c.background_estimate, c.jitter, c.prnu_jitter,
        row.saturated ? "  saturated" : "",
        neighbours.empty() ? "" : fmt::format("  SPR {:.8f}, contaminants {:.3f} ppm", row.spr_tot, c.contaminants));
  }
  if (!options.output.empty()) {
    write_noise_budget(options.output, rows);
    fmt::print("\n{}\n", options.output);
  }
  return 0;
}

}  // namespace astroid::commands
