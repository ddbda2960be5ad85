#include "astroid/photometry/phase_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "astroid/core/atomic_file.hpp"

namespace astroid {

std::vector<PhaseError> phase_errors(const Image<float, unit::Adu>& residual, Gain gain, double background_rms,
                                     std::span<const SourceMeasurement> sources, const PixelPsf& psf,
                                     std::size_t cells) {
  constexpr double kBright = 50.0;  // sigma
  struct Sum {
    double light = 0.0;
    double weight = 0.0;
  };
  std::vector<PhaseError> errors(cells * cells);
  std::vector<Sum> sums(errors.size());
  const auto n = static_cast<double>(cells);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i].phase_x = (static_cast<double>(i % cells) + 0.5) / n - 0.5;
    const std::size_t row = i / cells;
    errors[i].phase_y = (static_cast<double>(row) + 0.5) / n - 0.5;
  }
  const double noise = gain.value() * background_rms;
  for (const SourceMeasurement& source : sources) {
    if (source.flags != 0 || !(source.snr > kBright) || !std::isfinite(source.x) || !std::isfinite(source.y)) continue;
    const double px = std::floor(source.x + 0.5);
    const double py = std::floor(source.y + 0.5);
    const Rectangle pixel{static_cast<int>(px), static_cast<int>(py), 1, 1};
    if (!residual.area().contains(pixel.x0, pixel.y0)) continue;
    const double left = gain.value() * static_cast<double>(residual.at(pixel.x0, pixel.y0));
    std::array<double, 1> fraction{};
    psf.integrate({source.x, source.y}, pixel, fraction);
    const double light = source.flux * fraction[0];
    if (!std::isfinite(left) || !(light > 0.0)) continue;
    const auto cell = [&](double offset) { return std::min(cells - 1, static_cast<std::size_t>((offset + 0.5) * n)); };
    const std::size_t i = cell(source.y - py) * cells + cell(source.x - px);
    const double variance = noise * noise + light;
    sums[i].light += left * light / variance;
    sums[i].weight += light * light / variance;
    ++errors[i].stars;
  }
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i].residual = errors[i].stars > 0 ? sums[i].light / sums[i].weight : kNaN;
    errors[i].residual_error = errors[i].stars > 0 ? 1.0 / std::sqrt(sums[i].weight) : kNaN;
  }
  return errors;
}

void write_phase_errors(const std::filesystem::path& file, std::span<const PhaseError> errors) {
  std::string text = "phase_x,phase_y,stars,residual,residual_err\n";
  for (const PhaseError& e : errors)
    text += e.stars > 0 ? fmt::format("{:.3f},{:.3f},{},{:.6g},{:.3g}\n", e.phase_x, e.phase_y, e.stars, e.residual,
                                      e.residual_error)
                        : fmt::format("{:.3f},{:.3f},0,,\n", e.phase_x, e.phase_y);
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

}  // namespace astroid
