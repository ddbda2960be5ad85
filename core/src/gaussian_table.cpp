#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

PsfTable make_gaussian_table(double sigma, double accuracy) {
  constexpr double kSplineError = 4e-3;  // times (samples per sigma)^-4
  constexpr double kFewest = 8.0;
  const double per_sigma = std::max(kFewest, det::sqrt(det::sqrt(kSplineError / accuracy)));
  // Whole samples to a pixel, so that their edges fall on those of pixels.
  const double samples_per_pixel = std::ceil(per_sigma / sigma);
  const double reach = make_gaussian_psf(sigma)->stamp_half_width(std::clamp(0.1 * accuracy, 1e-15, 0.1));
  const int half = static_cast<int>(std::ceil(reach * samples_per_pixel));
  const double scale = 1.0 / (det::sqrt(2.0) * sigma * samples_per_pixel);
  std::vector<double> profile;
  for (int i = 0; i < half; ++i) profile.push_back(0.5 * (det::erfc(i * scale) - det::erfc((i + 1) * scale)));
  PsfTable table;
  table.samples = Image<double, unit::Relative>(2 * half, 2 * half);
  table.samples_per_pixel = samples_per_pixel;
  table.centre_x = table.centre_y = half - 0.5;
  const auto at = [&](int i) { return profile[static_cast<std::size_t>(i < half ? half - 1 - i : i - half)]; };
  for (int y = 0; y < 2 * half; ++y)
    for (int x = 0; x < 2 * half; ++x) table.samples.at(x, y) = at(x) * at(y);
  return table;
}

}  // namespace astroid
