// The analytic budget against an independent program (make_noise_budget.py beside this file).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

Mission plato_mission() {
  Mission mission;
  mission.simulation.cycle = Seconds(25.0);
  mission.simulation.exposure_time = Seconds(21.0);
  mission.satellite.jitter = {JitterModel::kRedNoise, Arcseconds(0.038), Arcseconds(0.038),
                              Arcseconds(0.040),      Seconds(250.0),    ""};
  mission.telescope.zero_point = Magnitude(20.62);
  mission.telescope.cameras = 24;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.ccd.pixel_scale = PixelScale(15.0);
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(25.0);
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.prnu = 0.01;
  mission.photometry.method = PhotometryMethod::kMask;
  mission.photometry.mask_window = 6;
  mission.photometry.background = BackgroundMethod::kKnown;
  mission.analysis.bin = Seconds(3600.0);
  return mission;
}

TEST(NoiseBudget, AgreesWithAnIndependentProgram) {
  const CsvTable table = read_csv(test::source_dir() / "tests/golden/analysis/noise_budget_plato.csv");
  const auto value = [&table](std::size_t row, const char* name) { return *table.number(row, *table.column(name)); };
  std::vector<double> magnitudes;
  for (std::size_t row = 0; row < table.rows(); ++row) magnitudes.push_back(value(row, "mag"));
  ASSERT_EQ(magnitudes.size(), 17U);
  const auto psf = make_gaussian_psf(0.6);
  const auto rows = analytic_budget(plato_mission(), *psf, magnitudes);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto expect = [&](double ours, const char* name, double tolerance) {
      EXPECT_NEAR(ours / value(i, name), 1.0, tolerance) << name << " at mag " << magnitudes[i];
    };
    EXPECT_EQ(rows[i].mask_pixels, static_cast<int>(value(i, "mask_pixels"))) << magnitudes[i];
    expect(rows[i].electrons, "electrons", 1e-12);
    expect(rows[i].enclosed_fraction, "enclosed_fraction", 1e-12);
    expect(rows[i].nsr_exposure, "nsr_exposure", 1e-12);
    expect(rows[i].causes.photon, "photon_ppm", 1e-12);
    expect(rows[i].causes.background, "background_ppm", 1e-12);
    expect(rows[i].causes.readout, "readout_ppm", 1e-12);
    expect(rows[i].causes.quantisation, "quantisation_ppm", 1e-12);
    // The estimators take the gradient of the PSF from differences over a thousandth of a pixel.
    expect(rows[i].causes.prnu_jitter, "prnu_jitter_ppm", 1e-5);
    expect(rows[i].nsr_1h_ppm, "nsr_1h_ppm", 1e-7);
    EXPECT_NEAR(rows[i].causes.jitter, 0.0, 1e-6);  // a symmetric mask around the star loses as much as it gains
  }
}

}  // namespace
}  // namespace astroid
