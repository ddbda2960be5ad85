#include "psf_diffusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"
#include "flux_spline.hpp"

namespace astroid {

namespace {

constexpr double kReach = 6.5;       // sigmas that a kernel extends to; beyond lies 1e-10
constexpr int kFinestDivision = 16;  // of a sample of a table that somebody gave

/// The same PSF with every sample divided into `parts` x `parts`, by the spline through its running integral.
PsfTable divided(const PsfTable& table, int parts) {
  if (parts == 1) {
    PsfTable copy{.samples = table.samples.clone()};
    copy.samples_per_pixel = table.samples_per_pixel;
    copy.centre_x = table.centre_x;
    copy.centre_y = table.centre_y;
    return copy;
  }
  const detail::FluxSpline spline(table);
  double total = 0.0;
  for (const double sample : table.samples.pixels()) total += sample;
  PsfTable fine;
  const int nx = parts * table.samples.nx();
  const int ny = parts * table.samples.ny();
  fine.samples = Image<double, unit::Relative>(nx, ny);
  fine.samples_per_pixel = table.samples_per_pixel * parts;
  fine.centre_x = (table.centre_x + 0.5) * parts - 0.5;
  fine.centre_y = (table.centre_y + 0.5) * parts - 0.5;
  const auto offset = [&](int edge, double centre) { return (edge - 0.5 - centre) / fine.samples_per_pixel; };
  std::vector<double> rows(spline.coefficient_rows());
  for (int x = 0; x < nx; ++x) {
    spline.integrate_rows(spline.x_edge(offset(x, fine.centre_x)), spline.x_edge(offset(x + 1, fine.centre_x)), rows);
    for (int y = 0; y < ny; ++y) {
      fine.samples.at(x, y) =
          total * detail::FluxSpline::integrate_column(rows, spline.y_edge(offset(y, fine.centre_y)),
                                                       spline.y_edge(offset(y + 1, fine.centre_y)));
    }
  }
  return fine;
}

/// Weights at 0, 1, 2 … samples to either side.
///
/// The flux in samples is a smooth function at their centres, so its convolution is a sum there: exact for a kernel
/// that is at least a sample wide (e^(-2 pi² (sigma/sample)²)). A narrower one keeps its variance by three points.
std::vector<double> gaussian_kernel(double sigma) {  // in samples
  if (sigma < 1.0) return {1.0 - sigma * sigma, 0.5 * sigma * sigma};
  const int last = static_cast<int>(std::ceil(kReach * sigma));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int k = 0; k <= last; ++k) {
    const double z = k / sigma;
    kernel.push_back(det::exp(-0.5 * z * z));
    sum += k == 0 ? kernel.back() : 2.0 * kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// Adds weight × in to out.
void add_scaled(std::span<const double> in, double weight, double* out) {
  for (std::size_t i = 0; i < in.size(); ++i) out[i] += weight * in[i];
}

/// Convolves both axes, extending each side by the kernel's reach.
Image<double, unit::Relative> convolved(const Image<double, unit::Relative>& image, const std::vector<double>& kernel) {
  const int last = static_cast<int>(kernel.size()) - 1;
  Image<double, unit::Relative> along_x(image.nx() + 2 * last, image.ny());
  Image<double, unit::Relative> both(along_x.nx(), image.ny() + 2 * last);
  for (int y = 0; y < image.ny(); ++y) {
    for (int k = -last; k <= last; ++k)
      add_scaled(image.row(y), kernel[static_cast<std::size_t>(std::abs(k))], &along_x.at(last + k, y));
    for (int k = -last; k <= last; ++k)
      add_scaled(std::as_const(along_x).row(y), kernel[static_cast<std::size_t>(std::abs(k))],
                 &both.at(0, y + last + k));
  }
  return both;
}

}  // namespace

PsfTable diffuse_psf_table(const PsfTable& table, Pixels sigma) {
  if (!(sigma.value() >= 0.0) || !std::isfinite(sigma.value())) {
    throw InputError(Problem{.parameter = "PSF/ChargeDiffusion",
                             .value = fmt::format("{}", sigma.value()),
                             .expected = "a finite number of pixels >= 0",
                             .message = "the charge diffusion is not usable"});
  }
  return detail::diffuse(table, sigma.value(), kFinestDivision);
}

PsfTable detail::diffuse(const PsfTable& table, double sigma, int finest_division) {
  if (sigma == 0.0) return divided(table, 1);
  const double samples = sigma * table.samples_per_pixel;
  const int parts = static_cast<int>(std::clamp(std::ceil(1.0 / samples), 1.0, static_cast<double>(finest_division)));
  const PsfTable fine = divided(table, parts);
  const std::vector<double> kernel = gaussian_kernel(samples * parts);
  const int margin = static_cast<int>(kernel.size()) - 1;
  PsfTable result;
  result.samples = convolved(fine.samples, kernel);
  result.samples_per_pixel = fine.samples_per_pixel;
  result.centre_x = fine.centre_x + margin;
  result.centre_y = fine.centre_y + margin;
  return result;
}

}  // namespace astroid
