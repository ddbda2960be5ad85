// A PSF that varies over the field: between tables, at them, and beside them.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"

namespace astroid {
namespace {

constexpr double kAccuracy = 1e-7;

std::vector<double> render(const PixelPsf& psf, PixelPosition star, Rectangle box) {
  std::vector<double> fractions(box.size());
  psf.integrate(star, box, fractions);
  return fractions;
}

Rectangle around(PixelPosition star, int half) {
  return {static_cast<int>(std::floor(star.x)) - half, static_cast<int>(std::floor(star.y)) - half, 2 * half + 1,
          2 * half + 1};
}

double width(double x, double y) {  // px, of the Gaussian at a place
  return 0.6 + 1e-4 * x + 5e-5 * y;
}

FieldPsfTable table_at(double x, double y) {
  return {{x, y}, test::gaussian_psf_table(width(x, y), 16.0, 6.0)};
}

std::vector<FieldPsfTable> corners_and_centre() {
  std::vector<FieldPsfTable> tables;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2000.0, 0.0}, {0.0, 2000.0}, {2000.0, 2000.0}, {1000.0, 1000.0}})
    tables.push_back(table_at(x, y));
  return tables;
}

TEST(FieldPsf, IsTheTableAtItsPlace) {
  const auto tables = corners_and_centre();
  const auto psf = make_field_psf(tables, Pixels(0.0), kAccuracy, 16);
  for (const FieldPsfTable& table : tables) {
    const auto alone = render(*make_prf_psf(table.table, kAccuracy, 16), table.position, around(table.position, 5));
    const auto blended = render(*psf, table.position, around(table.position, 5));
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(blended[i], alone[i], 1e-12);
  }
}

TEST(FieldPsf, LosesNoLightBetweenItsTables) {
  const auto psf = make_field_psf(corners_and_centre(), Pixels(0.1), kAccuracy, 16);
  for (const PixelPosition star : {PixelPosition{500.3, 1700.2}, {1000.0, 20.7}, {-300.0, 2500.0}, {1e6, -1e6}}) {
    const auto fractions = render(*psf, star, around(star, 12));
    EXPECT_NEAR(std::accumulate(fractions.begin(), fractions.end(), 0.0), 1.0, 1e-12);
  }
}

TEST(FieldPsf, FollowsWhatVariesLinearly) {
  // The centre of light of shifted tables: a thin-plate spline keeps what is linear in position. Of a PSF so wide that
  // the sum over pixels is the integral.
  std::vector<FieldPsfTable> tables;
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, {1800.0, 100.0}, {300.0, 2000.0}, {2000.0, 1900.0}, {900.0, 1100.0}, {1500.0, 700.0}}) {
    FieldPsfTable table{{x, y}, test::gaussian_psf_table(1.0, 8.0, 8.0)};
    table.table.centre_x -= 8.0 * (1e-4 * x - 2e-5 * y);  // light falls so many pixels to the right of the star
    tables.push_back(std::move(table));
  }
  const auto psf = make_field_psf(tables, Pixels(0.0), kAccuracy, 64);
  for (const PixelPosition star : {PixelPosition{700.0, 600.0}, {1234.0, 1600.0}}) {
    const Rectangle box = around(star, 12);
    const auto fractions = render(*psf, star, box);
    double x = 0.0;
    for (std::size_t i = 0; i < fractions.size(); ++i)
      x += fractions[i] * (box.x0 + static_cast<double>(i % static_cast<std::size_t>(box.nx)) - star.x);
    EXPECT_NEAR(x, 1e-4 * star.x - 2e-5 * star.y, 1e-5);
  }
}

TEST(FieldPsf, IsNearTheTruthOfASmoothField) {
  const auto psf = make_field_psf(corners_and_centre(), Pixels(0.0), kAccuracy, 16);
  const auto flux = [](const PixelPsf& p, PixelPosition star) {
    const auto f = render(p, star, around(star, 1));
    return std::accumulate(f.begin(), f.end(), 0.0);
  };
  const PixelPosition star{500.0, 1000.0};
  const auto truth = make_gaussian_psf(width(star.x, star.y));
  EXPECT_NEAR(flux(*psf, star) / flux(*truth, star), 1.0, 0.01);
}

TEST(FieldPsf, IsContinuousAcrossTheFieldAndBesideIt) {
  const auto psf = make_field_psf(corners_and_centre(), Pixels(0.0), kAccuracy, 16);
  const Rectangle box{-20, 980, 41, 41};
  for (const double x : {0.0, 0.25, 17.0}) {  // 0: the edge of the box around the places
    const auto left = render(*psf, {x - 1e-9, 1000.1}, box);
    const auto right = render(*psf, {x + 1e-9, 1000.1}, box);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-8);
  }
}

TEST(FieldPsf, HasTheGradientOfItsFractions) {
  const auto psf = make_field_psf(corners_and_centre(), Pixels(0.0), 1e-8, 32);
  const PixelPosition star{400.3, 900.8};
  const Rectangle box = around(star, 4);
  std::vector<double> dpdx(box.size()), dpdy(box.size());
  psf->integrate_gradient(star, box, dpdx, dpdy);
  constexpr double kStep = 1e-4;
  const auto right = render(*psf, {star.x + kStep, star.y}, box);
  const auto left = render(*psf, {star.x - kStep, star.y}, box);
  const auto upper = render(*psf, {star.x, star.y + kStep}, box);
  const auto lower = render(*psf, {star.x, star.y - kStep}, box);
  for (std::size_t i = 0; i < dpdx.size(); ++i) {
    EXPECT_NEAR(dpdx[i], (right[i] - left[i]) / (2.0 * kStep), 1e-7);
    EXPECT_NEAR(dpdy[i], (upper[i] - lower[i]) / (2.0 * kStep), 1e-7);
  }
}

TEST(FieldPsf, AddsTheFractionsOfIntegrate) {
  const auto psf = make_field_psf(corners_and_centre(), Pixels(0.0), kAccuracy, 16);
  std::vector<double> scratch;
  for (const bool broadened : {false, true}) {
    Image<double, unit::ExpectedElectrons> image(Rectangle{690, 1290, 20, 20});
    const StarLight star{{700.4, 1300.2}, 1e6, 30.0, {0.01, 0.002, 0.02}, broadened};
    psf->add_star(star, image.view(), scratch);
    std::vector<double> fractions(image.size());
    if (broadened) {
      psf->integrate_broadened(star.centre, star.motion, image.area(), fractions, scratch);
    } else {
      psf->integrate(star.centre, image.area(), fractions);
    }
    for (std::size_t i = 0; i < fractions.size(); ++i) EXPECT_NEAR(image.pixels()[i], 1e6 * fractions[i], 1e-6);
  }
}

TEST(FieldPsf, AcceptsFewTablesAndTablesInALine) {
  // One is everywhere the same; of two or more in a line the weights are linear along it.
  std::vector<FieldPsfTable> line;
  line.push_back(table_at(100.0, 100.0));
  const auto one = make_field_psf(line, Pixels(0.0), kAccuracy, 16);
  EXPECT_EQ(render(*one, {5000.25, 3.25}, around({5000.25, 3.25}, 3)),
            render(*one, {100.25, 100.25}, around({100.25, 100.25}, 3)));
  for (const double x : {300.0, 700.0, 1100.0}) line.push_back(table_at(x, 100.0));
  const auto psf = make_field_psf(line, Pixels(0.0), kAccuracy, 16);
  const auto middle = render(*psf, {500.0, 100.0}, around({500.0, 100.0}, 3));
  const auto left = render(*make_prf_psf(line[1].table, kAccuracy, 16), {0.0, 0.0}, {-3, -3, 7, 7});
  const auto right = render(*make_prf_psf(line[2].table, kAccuracy, 16), {0.0, 0.0}, {-3, -3, 7, 7});
  for (std::size_t i = 0; i < middle.size(); ++i) EXPECT_NEAR(middle[i], 0.5 * (left[i] + right[i]), 1e-12);
}

TEST(FieldPsf, RefusesTwoTablesInOnePlace) {
  std::vector<FieldPsfTable> tables;
  EXPECT_THROW(static_cast<void>(make_field_psf(tables, Pixels(0.0), kAccuracy)), InputError);
  tables.push_back(table_at(1.0, 2.0));
  tables.push_back(table_at(1.0, 2.0));
  EXPECT_THROW(static_cast<void>(make_field_psf(tables, Pixels(0.0), kAccuracy)), InputError);
}

}  // namespace
}  // namespace astroid
