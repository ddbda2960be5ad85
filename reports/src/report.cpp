#include "astroid/reports/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "astroid/reports/tables.hpp"
#include "figures.hpp"
#include "page.hpp"

namespace astroid {

namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw EnvironmentError(folder.string(), error.message());
}

void remove_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) throw EnvironmentError(folder.string(), error.message());
}

std::vector<Figure> figures_of(const ReportInput& input, std::span<const NoiseBin> noise,
                               std::span<const RecoveryBin> recovery) {
  FigureContext context;
  context.magnitude_label = input.passband.empty() ? "magnitude" : fmt::format("magnitude ({})", input.passband);
  context.bin_text = bin_text(input.bin_hours);
  context.setup = input.setup;
  context.requirement = input.requirement;
  std::vector<Figure> figures;
  if (!noise.empty()) figures.push_back(figure_noise(input.targets, noise, context));
  const bool compared =
      std::any_of(noise.begin(), noise.end(), [](const NoiseBin& b) { return b.ratio.n + b.ratio_within.n > 0; });
  if (compared) figures.push_back(figure_ratio(input.targets, noise, context));
  if (!recovery.empty()) figures.push_back(figure_recovery(input.targets, recovery, context));
  const bool contaminated =
      std::any_of(input.targets.begin(), input.targets.end(), [](const TargetMetrics& t) { return t.spr_tot > 0.0; });
  if (contaminated) figures.push_back(figure_contamination(input.targets, context));
  if (std::count_if(input.budget.begin(), input.budget.end(), [](const BudgetRow& r) { return !r.saturated; }) > 1) {
    figures.push_back(figure_budget(input.budget, context));
  }
  if (input.image && input.image->nx() > 0 && input.image->ny() > 0)
    figures.push_back(figure_image(*input.image, input.image_caption));
  if (!input.light_curves.empty()) figures.push_back(figure_light_curves(input.light_curves, context));
  return figures;
}

}  // namespace

WrittenReport write_report(const fs::path& folder, const ReportInput& input) {
  const std::vector<NoiseBin> noise = noise_vs_magnitude(input.targets);
  const std::vector<RecoveryBin> recovery = magnitude_recovery(input.targets, input.setup);
  WrittenReport written;

  const fs::path analysis = folder / "analysis";
  make_folder(analysis);
  const auto product = [&written, &analysis](const char* name) {
    written.products.push_back(std::string("analysis/") + name);
    return analysis / name;
  };
  if (!input.targets.empty()) {
    write_table(product("targets.csv"), target_columns(), input.targets);
    write_table(product("noise_vs_magnitude.csv"), noise_columns(), std::span<const NoiseBin>(noise));
    write_table(product("magnitude_recovery.csv"), recovery_columns(), std::span<const RecoveryBin>(recovery));
  }
  if (!input.contamination.empty())
    write_table(product("contamination.csv"), contamination_columns(), input.contamination);
  if (!input.budget.empty()) write_noise_budget(product("noise_budget.csv"), input.budget);

  const fs::path report = folder / "report";
  const fs::path partial = partial_path(report);
  remove_folder(partial);
  make_folder(partial);
  write_text_file(partial / "columns.md", columns_markdown());
  const std::vector<Figure> figures = figures_of(input, noise, recovery);
  written.problems = draw_figures(partial / "figures", figures, input.threads);
  PageContent content;
  content.input = &input;
  content.noise = noise;
  content.recovery = recovery;
  content.figures = figures;
  content.figure_folder = partial / "figures";
  content.problems = written.problems;
  write_text_file(partial / "index.html", page(content));
  remove_folder(report);
  rename_complete(partial, report);

  for (const auto& entry : fs::recursive_directory_iterator(report)) {
    if (entry.is_regular_file()) written.products.push_back(fs::relative(entry.path(), folder).generic_string());
  }
  std::sort(written.products.begin(), written.products.end());
  written.index = report / "index.html";
  return written;
}

}  // namespace astroid
