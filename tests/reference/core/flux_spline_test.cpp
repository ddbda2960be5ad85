// The phase library at its nodes against GSL's natural cubic splines through the running integral.
#include <gsl/gsl_interp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

double spline_at(const std::vector<double>& values, double u) {
  std::vector<double> knots(values.size());
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = static_cast<double>(i);
  const std::unique_ptr<gsl_interp, decltype(&gsl_interp_free)> spline(
      gsl_interp_alloc(gsl_interp_cspline, values.size()), gsl_interp_free);
  gsl_interp_init(spline.get(), knots.data(), values.data(), values.size());
  return gsl_interp_eval(spline.get(), knots.data(), values.data(), std::clamp(u, 0.0, knots.back()), nullptr);
}

// Flux of the table below and left of (u, v), in samples from its corner.
double running_integral(const PsfTable& table, double u, double v) {
  std::vector<double> along_v = {0.0};
  std::vector<double> column_sums(static_cast<std::size_t>(table.samples.nx()), 0.0);
  for (int y = 0; y < table.samples.ny(); ++y) {
    std::vector<double> along_u = {0.0};
    for (int x = 0; x < table.samples.nx(); ++x) {
      column_sums[static_cast<std::size_t>(x)] += table.samples.at(x, y);
      along_u.push_back(along_u.back() + column_sums[static_cast<std::size_t>(x)]);
    }
    along_v.push_back(spline_at(along_u, u));
  }
  return spline_at(along_v, v);
}

TEST(PrfPsf, AtItsPhasesIsTheSplineOfTheRunningIntegral) {
  PsfTable table;
  table.samples = Image<double, unit::Relative>(11, 9);
  double total = 0.0;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 11; ++x) {
      table.samples.at(x, y) = 1.0 / (1.0 + (x - 5.3) * (x - 5.3) + 2.0 * (y - 3.8) * (y - 3.8)) + 0.01 * ((x * y) % 3);
      total += table.samples.at(x, y);
    }
  }
  table.samples_per_pixel = 2.3;
  table.centre_x = 5.1;
  table.centre_y = 4.2;
  const auto psf = make_prf_psf(table, 1.0, 8);
  const Rectangle box{-3, -3, 7, 7};
  std::vector<double> p(box.size());
  for (const PixelPosition star : {PixelPosition{0.0, 0.0}, PixelPosition{0.125, 0.75}, PixelPosition{-0.5, 0.375}}) {
    psf->integrate(star, box, p);
    std::size_t i = 0;
    for (int y = box.y0; y < box.y1(); ++y) {
      for (int x = box.x0; x < box.x1(); ++x, ++i) {
        const double u = table.centre_x + 0.5 + (x - 0.5 - star.x) * table.samples_per_pixel;
        const double v = table.centre_y + 0.5 + (y - 0.5 - star.y) * table.samples_per_pixel;
        const double du = u + table.samples_per_pixel;
        const double dv = v + table.samples_per_pixel;
        const double flux = running_integral(table, du, dv) - running_integral(table, u, dv) -
                            running_integral(table, du, v) + running_integral(table, u, v);
        EXPECT_NEAR(p[i], flux / total, 1e-14) << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace astroid
