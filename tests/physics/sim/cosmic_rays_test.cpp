// Tracks of cosmic rays: exact parts of pixels, and every part of the detector like the whole.
#include "astroid/sim/cosmic_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "astroid/core/frame.hpp"

namespace astroid {
namespace {

using Electrons2d = Image<double, unit::SampledElectrons>;

double sum(const Electrons2d& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

TEST(CosmicRays, LeaveEachPixelItsPartOfTheTrack) {
  {
    Electrons2d image(6, 6);
    EXPECT_DOUBLE_EQ(leave_track({{1.0, 2.0}, {2.0, 0.0}, 100.0}, image.view()), 100.0);
    EXPECT_DOUBLE_EQ(image.at(1, 2), 25.0);
    EXPECT_DOUBLE_EQ(image.at(2, 2), 50.0);
    EXPECT_DOUBLE_EQ(image.at(3, 2), 25.0);
  }
  {
    // From (0, 0) to (3, -1.5) above row 2: columns at 0.5, 1.5, 2.5, rows at 1.5 and 0.5.
    Electrons2d image(6, 6);
    leave_track({{0.0, 2.0}, {3.0, -1.5}, 60.0}, image.view());
    EXPECT_NEAR(image.at(0, 2), 10.0, 1e-12);
    EXPECT_NEAR(image.at(1, 2), 10.0, 1e-12);
    EXPECT_NEAR(image.at(1, 1), 10.0, 1e-12);
    EXPECT_NEAR(image.at(2, 1), 20.0, 1e-12);
    EXPECT_NEAR(image.at(3, 1), 10.0, 1e-12);
    EXPECT_NEAR(image.at(3, 0), 0.0, 1e-12);
    EXPECT_NEAR(sum(image), 60.0, 1e-12);
  }
  {
    // A point; a diagonal through corners; tracks that enter from outside, miss and leave.
    Electrons2d image(4, 4);
    leave_track({{3.4, 3.4}, {0.0, 0.0}, 7.0}, image.view());
    EXPECT_EQ(image.at(3, 3), 7.0);
    leave_track({{-0.5, -0.5}, {4.0, 4.0}, 8.0}, image.view());
    EXPECT_NEAR(image.at(0, 0), 2.0, 1e-12);
    EXPECT_NEAR(image.at(3, 3), 9.0, 1e-12);
    EXPECT_NEAR(leave_track({{-10.0, 1.0}, {20.0, 0.0}, 20.0}, image.view()), 4.0, 1e-12);
    EXPECT_EQ(leave_track({{-10.0, 9.0}, {20.0, 0.0}, 20.0}, image.view()), 0.0);
  }
}

TEST(CosmicRays, ConserveChargeAlongAnyTrack) {
  for (int i = 0; i < 1000; ++i) {
    Electrons2d image(120, 120);
    const double angle = 0.0062831853 * i;
    const CosmicRay ray{{60.0 + std::fmod(0.37 * i, 1.0), 60.0 - std::fmod(0.71 * i, 1.0)},
                        {50.0 * std::cos(angle), 50.0 * std::sin(angle)},
                        4094.9};
    leave_track(ray, image.view());
    EXPECT_NEAR(sum(image), 4094.9, 1e-12 * 4094.9) << angle;
  }
}

CosmicRayModel many() {
  CosmicRayModel model;
  model.hits_per_pixel = 0.01;
  model.charge_location = 2500.0;
  model.charge_scale = 2000.0;
  model.charge_shape = 30.0;
  model.longest_track = 15.0;
  return model;
}

TEST(CosmicRays, OfAWindowAreThoseOfTheFullFrame) {
  const RandomStream stream = make_stream(7, StreamId{51}, 1, 0);
  CosmicRayModel slab = many();
  slab.is_slab = true;
  slab.thickness = 0.9;
  slab.electrons_per_path = 1440.0;
  slab.fluctuation = 0.1;
  slab.longest_track = 60.0;
  for (const CosmicRayModel& model : {many(), slab}) {
    Electrons2d frame(200, 150);
    Image<std::uint8_t, unit::Flags> frame_flags(200, 150);
    const auto all_flags = frame_flags.view();
    add_cosmic_rays(model, stream, {3}, frame.view(), &all_flags);
    EXPECT_GT(sum(frame), 0.0);
    for (const Rectangle& area : {Rectangle{0, 0, 6, 6}, Rectangle{194, 144, 6, 6}, Rectangle{60, 31, 7, 2},
                                  Rectangle{0, 149, 200, 1}, Rectangle{199, 0, 1, 150}}) {
      Electrons2d window(area);
      Image<std::uint8_t, unit::Flags> window_flags(area);
      const auto flags = window_flags.view();
      add_cosmic_rays(model, stream, {3}, window.view(), &flags);
      for (int y = area.y0; y < area.y1(); ++y)
        for (int x = area.x0; x < area.x1(); ++x) {
          EXPECT_EQ(window.at(x, y), frame.at(x, y));
          EXPECT_EQ(window_flags.at(x, y), frame_flags.at(x, y));
          EXPECT_EQ(window_flags.at(x, y) == pixel_flag::kCosmicRay, window.at(x, y) > 0.0);
        }
    }
  }
}

TEST(CosmicRays, OfARateOfZeroAreNone) {
  CosmicRayModel model = many();
  model.hits_per_pixel = 0.0;
  Electrons2d image(50, 50);
  EXPECT_EQ(add_cosmic_rays(model, make_stream(7, StreamId{51}, 0, 0), {0}, image.view()), 0.0);
  for (const double pixel : image.pixels()) EXPECT_EQ(pixel, 0.0);
}

}  // namespace
}  // namespace astroid
