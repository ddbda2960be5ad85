#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "html.hpp"
#include "page.hpp"

namespace astroid {

namespace {

constexpr double kMillimagnitudes = 1000.0;
constexpr std::size_t kMostContaminated = 20;

std::string with_error(const std::string& value, const std::string& error) {
  if (error == "–") return value;
  return value + " <span class=\"err\">± " + error + "</span>";
}

std::string interval(const MedianEstimate& m, int decimals) {
  if (m.n == 0) return "–";
  return html::fixed(m.value, decimals) +
         fmt::format(" <span class=\"err\">{}–{}</span>", html::fixed(m.low, decimals), html::fixed(m.high, decimals));
}

std::string tile(const std::string& value, const std::string& meaning) {
  return "<div class=\"tile\"><b>" + value + "</b><span>" + meaning + "</span></div>\n";
}

std::string tiles(const PageContent& content) {
  const ReportInput& input = *content.input;
  if (input.targets.empty()) return {};
  std::int64_t exposures = 0;
  for (const TargetMetrics& target : input.targets) exposures = std::max(exposures, target.exposures + target.missing);
  const RunSetup& setup = input.setup;
  std::string out = tile(fmt::format("{}", input.targets.size()), "targets");
  out += tile(fmt::format("{}", exposures),
              fmt::format("exposures, {} of {} cameras simulated", setup.simulated_cameras, setup.cameras));
  const NoiseSummary noise = noise_summary(input.targets);
  if (noise.ratio.n > 0) {
    out += tile(fmt::format("{}", html::fixed(noise.ratio.value, 3)),
                fmt::format("measured / predicted noise, median (95 %: {}–{})", html::fixed(noise.ratio.low, 3),
                            html::fixed(noise.ratio.high, 3)));
  }
  const RecoverySummary recovery = recovery_summary(input.targets, setup);
  if (recovery.stars > 0) {
    out += tile(html::fixed(kMillimagnitudes * recovery.bias, 2, true) + " mmag",
                fmt::format("bias of {} uncontaminated stars (± {})", recovery.stars,
                            html::fixed(kMillimagnitudes * recovery.bias_err, 2)));
  }
  if (input.requirement) {
    const Compliance c = compliance(input.targets, *input.requirement);
    if (c.targets > 0) {
      out += tile(fmt::format("{} of {}", c.predicted, c.targets),
                  fmt::format("targets to mag {:g} predicted within {:.0f} ppm in {}", input.requirement->magnitude,
                              input.requirement->ppm, bin_text(input.bin_hours)));
    }
  }
  return "<div class=\"tiles\">\n" + out + "</div>\n";
}

}  // namespace

std::string verdict_section(const PageContent& content) {
  const ReportInput& input = *content.input;
  if (input.verdict.empty()) return tiles(content);
  const char* state = "";
  if (input.requirement) {
    if (const auto noise = noise_at_magnitude(input.targets, input.requirement->magnitude)) {
      state = noise->ppm <= input.requirement->ppm ? " met" : " missed";
    }
  }
  std::string out = fmt::format("<div class=\"verdict{}\" id=\"verdict\">", state);
  for (const std::string& line : input.verdict) out += "<p>" + html::escape(line) + "</p>";
  return out + "</div>\n" + tiles(content);
}

std::string noise_section(const PageContent& content) {
  if (content.noise.empty()) return {};
  const ReportInput& input = *content.input;
  std::vector<std::vector<std::string>> rows;
  for (const NoiseBin& bin : content.noise) {
    const NoiseByCause& c = bin.causes;
    rows.push_back({fmt::format("{:.1f}–{:.1f}", bin.mag_low, bin.mag_high), fmt::format("{}", bin.stars),
                    html::number(bin.predicted_ppm, 4), html::number(bin.measured_ppm, 4),
                    html::number(bin.measured_within_ppm, 4), interval(bin.ratio, 3), interval(bin.ratio_within, 3),
                    html::number(c.photon, 3), html::number(c.of_levels(), 3), html::number(c.readout, 3),
                    html::number(c.jitter, 3)});
  }
  const std::string ppm = "ppm";
  std::string body = html::table({{"magnitude", ""},
                                  {"stars", ""},
                                  {"predicted", ppm},
                                  {"measured", ppm},
                                  {"within bins", ppm},
                                  {"measured / predicted", "95 %"},
                                  {"the same within bins", "95 %"},
                                  {"photon", ppm},
                                  {"background", ppm},
                                  {"readout", ppm},
                                  {"jitter", ppm}},
                                 rows);
  body += fmt::format(
      "<p class=\"note\">Medians over the unsaturated targets of half a magnitude: noise of the mean over {} with {} "
      "camera{}, relative to the "
      "target's flux. Measured: standard deviation of the bin means; within bins: scatter inside bins, which does not "
      "see slower noise. "
      "Ratios are of the {} simulated camera{}, with the 95 % interval of the median. {}</p>\n",
      bin_text(input.bin_hours), input.setup.cameras, input.setup.cameras == 1 ? "" : "s",
      input.setup.simulated_cameras, input.setup.simulated_cameras == 1 ? "" : "s",
      html::links({{"noise_vs_magnitude.csv", "../analysis/noise_vs_magnitude.csv"},
                   {"targets.csv", "../analysis/targets.csv"}}));
  return html::section(
      "noise", "Noise against magnitude",
      figure_block(content, "noise_vs_magnitude") + figure_block(content, "measured_over_predicted") + body);
}

std::string recovery_section(const PageContent& content) {
  if (content.recovery.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  const auto mmag = [](double mag, int decimals) { return html::fixed(kMillimagnitudes * mag, decimals, true); };
  for (const RecoveryBin& bin : content.recovery) {
    rows.push_back({fmt::format("{:.1f}–{:.1f}", bin.mag_low, bin.mag_high), fmt::format("{}", bin.stars),
                    fmt::format("{}", bin.saturated), fmt::format("{}", bin.uncontaminated), mmag(bin.delta_median, 1),
                    mmag(bin.contamination_median, 1), mmag(bin.aperture_loss_median, 1),
                    with_error(mmag(bin.residual.value, 2), html::fixed(kMillimagnitudes * bin.residual.error, 2)),
                    html::fixed(kMillimagnitudes * bin.residual.scatter, 2),
                    html::fixed(kMillimagnitudes * bin.expected_scatter, 2), html::fixed(bin.pull_width, 2)});
  }
  std::string body = html::table({{"magnitude", ""},
                                  {"stars", ""},
                                  {"saturated", ""},
                                  {"uncon&shy;taminated", ""},
                                  {"measured − true", "mmag"},
                                  {"neighbours", "mmag"},
                                  {"aperture loss", "mmag"},
                                  {"bias", "mmag"},
                                  {"scatter", "mmag"},
                                  {"expected", "mmag"},
                                  {"pull width", ""}},
                                 rows);
  body +=
      "<p class=\"note\">Measured − true and its two explained parts are medians over unsaturated stars. Bias, scatter "
      "and pull width are of "
      "what those parts leave, for uncontaminated stars; the pull width is 1 when the expected errors are honest. ";
  const FaintBias faint = faint_star_bias(content.input->targets, content.input->setup);
  if (faint.relative.n > 1) {
    body += fmt::format(
        "The faintest magnitude (from {:.1f} on, {} stars) is measured {} ± {} ‰ off in flux, {} standard errors. ",
        faint.mag_from, faint.relative.n, html::fixed(1000.0 * faint.relative.value, 2, true),
        html::fixed(1000.0 * faint.relative.error, 2), html::fixed(std::abs(faint.z()), 1));
  }
  body += html::links({{"magnitude_recovery.csv", "../analysis/magnitude_recovery.csv"}}) + "</p>\n";
  return html::section("recovery", "Magnitude recovery", figure_block(content, "magnitude_recovery") + body);
}

std::string contamination_section(const PageContent& content) {
  const ReportInput& input = *content.input;
  const std::string figure = figure_block(content, "contamination");
  if (figure.empty() && input.contamination.empty()) return {};
  std::vector<const ContaminationRow*> worst;
  for (const ContaminationRow& row : input.contamination) {
    if (row.spr_tot > 0.0) worst.push_back(&row);
  }
  const std::size_t shown = std::min(kMostContaminated, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(shown), worst.end(),
                    [](const ContaminationRow* a, const ContaminationRow* b) { return a->spr_tot > b->spr_tot; });
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < shown; ++i) {
    const ContaminationRow& row = *worst[i];
    std::vector<std::string> cells{html::escape(row.id), html::fixed(row.mag, 2), html::number(row.spr_tot, 3),
                                   html::fixed(kMillimagnitudes * row.delta_mag, 1, true)};
    if (row.strongest.empty()) {
      cells.insert(cells.end(), {"–", "–", "–"});
    } else {
      const Contaminant& c = row.strongest.front();
      cells.insert(cells.end(), {html::escape(c.id), html::fixed(std::hypot(c.dx, c.dy), 2), html::number(c.spr, 3)});
    }
    rows.push_back(std::move(cells));
  }
  std::string body;
  if (!rows.empty()) {
    body = fmt::format("<h3>The {} most contaminated targets</h3>\n", rows.size());
    body += html::table({{"target", "", true},
                         {"magnitude", ""},
                         {"SPR", ""},
                         {"brighter by", "mmag"},
                         {"strongest neighbour", "", true},
                         {"distance", "px"},
                         {"its SPR", ""}},
                        rows);
    body +=
        "<p class=\"note\">SPR: share of neighbours in all star light of the aperture, sky excluded; CROWDSAP = 1 − "
        "SPR. " +
        html::links({{"contamination.csv", "../analysis/contamination.csv"}}) + "</p>\n";
  }
  return html::section("contamination", "Contamination", figure + body);
}

std::string budget_section(const PageContent& content) {
  const ReportInput& input = *content.input;
  if (input.budget.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const BudgetRow& row : input.budget) {
    if (std::abs(row.mag - std::round(row.mag)) > 1e-6) continue;  // whole magnitudes; the file has all
    const NoiseByCause& c = row.causes;
    rows.push_back({html::fixed(row.mag, 1),
                    html::number(row.electrons, 4) + (row.saturated ? " <span class=\"flag\">saturated</span>" : ""),
                    fmt::format("{}", row.mask_pixels), html::fixed(row.enclosed_fraction, 3),
                    html::number(1e6 * row.nsr_exposure, 4), html::number(row.nsr_1h_ppm, 4), html::number(c.photon, 3),
                    html::number(c.of_levels(), 3), html::number(c.readout, 3), html::number(c.quantisation, 3),
                    html::number(c.jitter, 3), html::number(c.prnu_jitter, 3)});
  }
  const std::string ppm = "ppm";
  std::string body = html::table({{"magnitude", ""},
                                  {"electrons", "e-"},
                                  {"pixels", ""},
                                  {"enclosed", ""},
                                  {"one exposure", ppm},
                                  {bin_text(input.bin_hours), ppm},
                                  {"photon", ppm},
                                  {"background", ppm},
                                  {"readout", ppm},
                                  {"rounding", ppm},
                                  {"jitter", ppm},
                                  {"jitter on gains", ppm}},
                                 rows);
  body +=
      "<p class=\"note\">An isolated star at the centre of a pixel, from formulae alone. One exposure: one camera "
      "without jitter. " +
      html::links({{"noise_budget.csv", "../analysis/noise_budget.csv"}}) + "</p>\n";
  return html::section("budget", "The noise budget, predicted", figure_block(content, "noise_budget") + body);
}

}  // namespace astroid
