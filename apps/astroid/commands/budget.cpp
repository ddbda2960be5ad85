#include "astroid/analysis/budget.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "astroid/core/error.hpp"
#include "astroid/reports/tables.hpp"
#include "astroid/sim/scene.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

int budget(const BudgetOptions& options) {
  if (!(options.mag_to >= options.mag_from))
    throw InputError(Problem{.parameter = "--to",
                             .value = fmt::format("{}", options.mag_to),
                             .expected = "at least --from",
                             .message = "no magnitudes to compute"});
  if (!options.output.empty() && std::filesystem::exists(options.output) && !options.overwrite)
    throw InputError(
        Problem{.file = options.output, .expected = "another name, or --overwrite", .message = "the file exists"});
  const Mission mission = read(options.configuration).mission;
  std::vector<double> magnitudes;
  const auto steps = static_cast<int>(std::floor((options.mag_to - options.mag_from) / options.mag_step + 1e-9));
  for (int i = 0; i <= steps; ++i) magnitudes.push_back(options.mag_from + i * options.mag_step);
  const std::vector<BudgetRow> rows = analytic_budget(mission, *make_psf(mission), magnitudes);

  fmt::print("Isolated star at the centre of a pixel; noise in {:g} h with {} camera(s), ppm\n\n",
             mission.analysis.bin.value() / 3600.0, mission.telescope.cameras);
  fmt::print("{:>6} {:>12} {:>4} {:>9} {:>12} {:>8} | {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "mag",
             "e-/exposure", "px", "enclosed", "NSR exposure", "NSR", "photon", "backgr.", "readout", "quant.",
             "b.estim.", "jitter", "PRNU");
  for (const BudgetRow& row : rows) {
    const NoiseByCause& c = row.causes;
    fmt::print(
        "{:6.2f} {:12.6g} {:4d} {:9.6f} {:12.6e} {:8.3f} | {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f}{}\n",
        row.mag, row.electrons, row.mask_pixels, row.enclosed_fraction, row.nsr_exposure, row.nsr_1h_ppm, c.photon,
        c.background, c.readout, c.quantisation, c.background_estimate, c.jitter, c.prnu_jitter,
        row.saturated ? "  saturated" : "");
  }
  if (!options.output.empty()) {
    write_noise_budget(options.output, rows);
    fmt::print("\n{}\n", options.output);
  }
  return 0;
}

}  // namespace astroid::commands
