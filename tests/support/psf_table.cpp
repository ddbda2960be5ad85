#include "astroid/test/psf_table.hpp"

#include <cmath>
#include <vector>

namespace astroid::test {

namespace {

// The outer product of a profile with itself.
PsfTable table_of(const std::vector<double>& profile, double samples_per_pixel) {
  const auto n = static_cast<int>(profile.size());
  PsfTable table;
  table.samples = Image<double, unit::Relative>(n, n);
  table.samples_per_pixel = samples_per_pixel;
  table.centre_x = 0.5 * (n - 1);
  table.centre_y = 0.5 * (n - 1);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      table.samples.at(x, y) = profile[static_cast<std::size_t>(x)] * profile[static_cast<std::size_t>(y)];
    }
  }
  return table;
}

int samples_across(double samples_per_pixel, double half_width) {
  return 2 * static_cast<int>(std::ceil(half_width * samples_per_pixel));
}

}  // namespace

PsfTable gaussian_psf_table(double sigma, double samples_per_pixel, double half_width) {
  const int n = samples_across(samples_per_pixel, half_width);
  std::vector<double> profile;
  for (int i = 0; i < n; ++i) {
    const double scale = 1.0 / (std::sqrt(2.0) * sigma * samples_per_pixel);
    const double lower = std::abs(i - 0.5 * n) * scale;
    const double upper = std::abs(i + 1 - 0.5 * n) * scale;
    profile.push_back(0.5 * std::abs(std::erfc(lower) - std::erfc(upper)));
  }
  return table_of(profile, samples_per_pixel);
}

PsfTable sampled_gaussian_psf_table(double sigma, double samples_per_pixel, double half_width) {
  const int n = samples_across(samples_per_pixel, half_width);
  std::vector<double> profile;
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5 - 0.5 * n) / (sigma * samples_per_pixel);
    profile.push_back(std::exp(-0.5 * x * x));
  }
  return table_of(profile, samples_per_pixel);
}

}  // namespace astroid::test
