#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "astroid/core/statistics/sums.hpp"
#include "astroid/core/textbook_psf.hpp"
#include "astroid/sim/optics.hpp"
#include "astroid/sim/renderer.hpp"
#include "sweeps.hpp"

namespace astroid::tradeoff {

namespace {

constexpr int kPlaces = 200;
constexpr int kDriftPlaces = 400;
constexpr double kDrift = 1.3;        // px, the worst of the paper in 90 d
constexpr double kLost = 1e-7;        // of a star's light beside its stamp, of all methods alike
constexpr double kMostBytes = 256e6;  // of a table
constexpr double kConverged = 1e-9;   // relative, where there is no closed form
constexpr double kMebibyte = 1024.0 * 1024.0;

/// Evenly spread over the pixel about 0, on no grid (the additive recurrence of two irrational numbers).
PixelPosition place(int k) {
  return {std::fmod(0.7548776662466927 * (k + 1), 1.0) - 0.5, std::fmod(0.5698402909980532 * (k + 1), 1.0) - 0.5};
}

double light(const PixelPsf& psf, PixelPosition star) {
  std::array<double, std::size_t{kMaskSide} * kMaskSide> fractions{};
  psf.integrate(star, {-kMaskSide / 2, -kMaskSide / 2, kMaskSide, kMaskSide}, fractions);
  double sum = 0.0;
  for (const double f : fractions) sum += f;
  return sum;
}

/// A way to make stars, and what it is compared with.
struct Candidate {
  std::string name;
  std::string parameter{};
  double value = TradeoffRow::kNothing;
  double bytes = TradeoffRow::kNothing;
  double promised = TradeoffRow::kNothing;
  bool chosen = false;
  std::function<std::shared_ptr<const PixelPsf>()> make;
};

TradeoffRow measure(const Candidate& candidate, const PixelPsf& exact, double seconds) {
  const double begin = cpu_seconds();
  const std::shared_ptr<const PixelPsf> psf = candidate.make();
  TradeoffRow row{.sweep = Sweep::kRenderer,
                  .setting = candidate.name,
                  .parameter = candidate.parameter,
                  .value = candidate.value,
                  .promised = candidate.promised,
                  .seconds_once = cpu_seconds() - begin,
                  .memory = candidate.bytes / kMebibyte,
                  .chosen = candidate.chosen};
  constexpr double kMillionth = 1e6;
  double squares = 0.0;
  row.error_max = 0.0;
  for (int k = 0; k < kPlaces; ++k) {
    const double error = kMillionth * (light(*psf, place(k)) / light(exact, place(k)) - 1.0);
    squares += error * error;
    row.error_max = std::max(row.error_max, std::abs(error));
  }
  row.error_rms = std::sqrt(squares / kPlaces);
  if (std::isfinite(row.promised)) row.of_promise = row.error_max / row.promised;
  // Slanted, so that both axes change phase; the same mask all the way.
  RunningMoments drift;
  for (int k = 0; k < kDriftPlaces; ++k) {
    const double along = kDrift * ((k + 0.5) / kDriftPlaces - 0.5);
    const PixelPosition star{0.13 + 0.8 * along, -0.21 + 0.6 * along};
    drift.add(kMillionth * (light(*psf, star) / light(exact, star) - 1.0));
  }
  row.error_drift = drift.standard_deviation();

  constexpr int kStars = 1000;
  constexpr int kSide = 128;
  Image<double, unit::ExpectedElectrons> image(kSide, kSide);
  std::vector<double> scratch;
  const double half_width = exact.stamp_half_width(kLost);
  row.seconds = median_seconds(
      [&] {
        for (int k = 0; k < kStars; ++k) {
          const PixelPosition p = place(k);
          psf->add_star(
              {.centre = {kSide * (p.x + 0.5), kSide * (p.y + 0.5)}, .electrons = 1.0, .half_width = half_width},
              image.view(), scratch);
        }
      },
      seconds);
  return row;
}

/// What the scene's renderer uses.
std::shared_ptr<const PixelPsf> psf_of(const std::shared_ptr<const Scene>& scene) {
  return {scene, &scene->psf()};
}

/// What the scene's stars mean, without an approximation, and as a surface brightness where that is at hand.
TextbookSource source_of(const PreparedGroup& run) {
  const Mission& mission = run.scene->mission();
  const PsfSettings& psf = mission.psf;
  TextbookSource source;
  const bool response = has_intra_pixel_response(mission);
  if (!response && psf.model == PsfModel::kGaussian) {
    source.exact = psf_of(run.scene);
    source.brightness = gaussian_brightness(std::hypot(psf.sigma.value(), psf.diffusion.value()));
  } else if (!response && psf.model == PsfModel::kTable) {
    const PsfTable table = psf.diffusion.value() > 0.0 ? diffuse_psf_table(read_psf_table(psf.file), psf.diffusion)
                                                       : read_psf_table(psf.file);
    source.exact = make_exact_table_psf(table);
    source.brightness = table_brightness(table);
  } else {
    source.exact = make_recorded_psf(mission, kConverged, make_psf(mission, kConverged));
  }
  source.reach = static_cast<int>(std::ceil(source.exact->stamp_half_width(kLost)));
  return source;
}

std::vector<Candidate> textbook(const TextbookSource& source) {
  std::vector<Candidate> all;
  const auto add = [&](TextbookMethod method, std::initializer_list<int> numbers) {
    for (const int n : numbers) {
      const double bytes = textbook_bytes(method, n, source.reach);
      if (bytes <= kMostBytes)
        all.push_back({.name = to_string(method, n),
                       .value = static_cast<double>(n),
                       .bytes = bytes,
                       .make = [method, n, source] { return make_textbook_psf(method, n, source); }});
    }
  };
  add(TextbookMethod::kSnap, {4, 8, 16, 32, 64, 128});
  if (source.brightness) {
    add(TextbookMethod::kMidpoint, {2, 4, 8, 16, 32});
    add(TextbookMethod::kGaussLegendre, {2, 3, 5});
  }
  add(TextbookMethod::kLinear, {4, 8, 16, 32, 64});
  add(TextbookMethod::kCubic, {4, 8, 16, 32, 64});
  return all;
}

}  // namespace

std::vector<TradeoffRow> sweep_renderers(const PreparedGroup& run, double seconds) {
  const Scene& scene = *run.scene;
  const Mission& mission = scene.mission();
  const TextbookSource source = source_of(run);
  std::vector<Candidate> all = textbook(source);
  constexpr double kMillionth = 1e-6;
  const double asked = mission.simulation.accuracy.value();
  const bool is_exact = scene.psf().approximation_error() == 0.0;
  if (!is_exact && mission.psf.phases == 0) {
    // One star's light to the accuracy itself; the plan of a scene shares the accuracy out and thinks of neighbours.
    for (const double ppm : {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0})
      all.push_back({.name = fmt::format("prf {:g} ppm", ppm),
                     .parameter = {},
                     .value = ppm,
                     .promised = ppm,
                     .make = [&mission, ppm] {
                       const PsfAccuracy accuracy(kMillionth * ppm, 1.0);
                       return make_recorded_psf(mission, accuracy, make_psf(mission, accuracy));
                     }});
  }
  all.push_back({.name = fmt::format("{} as planned for {:g} ppm",
                                     run.plan->renderer == "subpixel" ? "prf" : run.plan->renderer, asked),
                 .parameter = fmt::format("Simulation/Accuracy={:g}", asked),
                 .value = asked,
                 .promised = asked,
                 .chosen = true,
                 .make = [&run] { return psf_of(run.scene); }});
  std::vector<TradeoffRow> rows;
  rows.reserve(all.size());
  for (const Candidate& candidate : all) rows.push_back(measure(candidate, *source.exact, seconds));
  mark_pareto(rows);
  return rows;
}

}  // namespace astroid::tradeoff
