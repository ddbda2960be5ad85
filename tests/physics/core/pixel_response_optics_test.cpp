// Sensitivity that varies within the pixel, seen by PSFs with wings and by one that varies over the field: library and
// sub-pixel map against adaptive quadrature.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/sub_pixel.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"
#include "astroid/test/sub_pixel_psf.hpp"

namespace astroid {
namespace {

constexpr Rectangle kBox{-6, -6, 24, 24};
const std::vector<PixelPosition> kStars = {{2.0, 2.5}, {2.47, 1.77}};

/// Light that the map puts into the pixels: of cells times their sensitivity, or of the response in Fourier space.
std::vector<double> mapped(const SubPixelRenderer& renderer, const PixelResponse& response, PixelPosition star) {
  return test::light_by_cells(renderer, response, star, kBox);
}

/// What there is of a star's light, in parts that have each a brightness of their own.
struct Part {
  double share;
  test::SurfaceBrightness brightness;
};

struct Asked {
  double library, map;  // of the star's light
};

void expect_quadrature(const PixelPsf& library, const FieldSpectrum& spectrum, const PixelResponse& response,
                       const std::vector<Part> (&parts)[2], Asked asked) {
  const SubPixelRenderer cells(spectrum, kBox, {.accuracy = asked.map, .cells = response.cells});
  const SubPixelRenderer folded(spectrum, kBox, {.accuracy = asked.map, .response = response});
  for (std::size_t k = 0; k < kStars.size(); ++k) {
    std::vector<double> p(kBox.size());
    library.integrate(kStars[k], kBox, p);
    const auto by_cells = mapped(cells, response, kStars[k]);
    const auto in_fourier_space = mapped(folded, {}, kStars[k]);
    // Beside the star, and on both sides of the border between core and wings.
    for (const auto& [x, y] : {std::pair{2, 2}, std::pair{3, 2}, std::pair{8, 4}, std::pair{13, 2}}) {
      double exact = 0.0;
      for (const Part& part : parts[k])
        exact += part.share * static_cast<double>(
                                  test::integrate_response(part.brightness, response, kStars[k], x, y, 1e-12L).value);
      const auto i = static_cast<std::size_t>((y - kBox.y0) * kBox.nx + x - kBox.x0);
      EXPECT_NEAR(p[i], exact, asked.library) << x << " " << y;
      EXPECT_NEAR(by_cells[i], exact, asked.map) << x << " " << y;
      EXPECT_NEAR(in_fourier_space[i], exact, asked.map) << x << " " << y;
    }
  }
}

FieldSpectrum everywhere(std::shared_ptr<const PsfSpectrum> spectrum) {
  return {.members = {std::move(spectrum)}, .weights = {}};
}

TEST(PixelResponse, IsFoldedIntoAMoffatProfile) {
  constexpr PsfWings kWings{.reach = 20};
  const PixelResponse response = edge_response(5, 0.2, 0.2);
  const auto brightness = test::faded_brightness(test::moffat_density(1.4L, 2.5L), 20.0L);
  const std::vector<Part> star = {{1.0, brightness}};
  expect_quadrature(*make_moffat_psf(1.4, 2.5, kWings, 1e-7, 0, response),
                    everywhere(make_moffat_spectrum(1.4, 2.5, kWings)), response, {star, star}, {1e-7, 1e-10});
}

TEST(PixelResponse, IsFoldedIntoAnAiryPattern) {
  constexpr PsfWings kWings{.reach = 20};
  const PixelResponse response = cosine_response(6, 0.2);
  const auto brightness = test::faded_brightness(test::airy_density(1.5L, 0.3L), 20.0L);
  const std::vector<Part> star = {{1.0, brightness}};
  expect_quadrature(*make_airy_psf(1.5, 0.3, kWings, 1e-7, 0, response),
                    everywhere(make_airy_spectrum(1.5, 0.3, kWings)), response, {star, star}, {1e-7, 1e-10});
}

TEST(PixelResponse, IsFoldedIntoAPsfThatVariesOverTheField) {
  // Between three places the blend is linear in the star's.
  constexpr double kSide = 12.0;
  std::vector<FieldPsfTable> tables;
  tables.push_back({{0.0, 0.0}, test::gaussian_psf_table(0.6, 24.0, 5.0)});
  tables.push_back({{kSide, 0.0}, test::gaussian_psf_table(0.8, 24.0, 6.0)});
  tables.push_back({{0.0, kSide}, test::gaussian_psf_table(0.7, 24.0, 5.5)});
  const auto parts = [&](PixelPosition star) {
    const double x = star.x / kSide;
    const double y = star.y / kSide;
    return std::vector<Part>{{1.0 - x - y, test::table_brightness(tables[0].table)},
                             {x, test::table_brightness(tables[1].table)},
                             {y, test::table_brightness(tables[2].table)}};
  };
  const PixelResponse response = gaussian_response(5, 0.1);
  expect_quadrature(*make_field_psf(tables, Pixels(0.0), 1e-7, 0, response), make_field_spectrum(tables, Pixels(0.0)),
                    response, {parts(kStars[0]), parts(kStars[1])}, {1e-7, 1e-8});
}

}  // namespace
}  // namespace astroid
