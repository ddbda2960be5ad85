#include "astroid/pipeline/focal_plane.hpp"

#include <fmt/format.h>

#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/console.hpp"
#include "commands/run_options.hpp"

namespace astroid::commands {

namespace {
constexpr double kMillimagnitudes = 1000.0;
}  // namespace

int focal_plane(const FocalPlaneCommand& options) {
  const ResolvedConfiguration configuration = read(options.run.configuration, {});
  const FocalPlaneResult result = map_focal_plane(configuration, run_options(options.run, "Exposures"),
                                                  {.across = options.across,
                                                   .down = options.down,
                                                   .side = options.side,
                                                   .magnitude = options.magnitude,
                                                   .group = options.group});
  fmt::print("{:>8} {:>8} {:>8} {:>12} {:>12} {:>11} {:>10}\n", "column", "row", "clean", "predicted", "measured",
             "pollution", "recovery");
  fmt::print("{:>8} {:>8} {:>8} {:>12} {:>12} {:>11} {:>10}\n", "px", "px", "targets", "ppm", "ppm", "ratio", "mmag");
  for (const SubFieldMetrics& s : result.sub_fields)
    fmt::print("{:>8.1f} {:>8.1f} {:>8} {:>12.4g} {:>12.4g} {:>11.3g} {:>10.3g}\n", s.x, s.y, s.clean,
               s.nsr_predicted.value, s.nsr_measured.value, s.spr.value, kMillimagnitudes * s.recovery.value);
  for (const std::string& warning : result.warnings) fmt::print("note: {}\n", warning);
  fmt::print("Maps for magnitude {:.2f}: {}/report/figures, numbers in {}/analysis\n", result.reference_magnitude,
             options.run.run.folder, options.run.run.folder);
  return 0;
}

}  // namespace astroid::commands
