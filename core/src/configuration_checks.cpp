#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration_draft.hpp"

namespace astroid::configuration {

namespace {

/// Complains about parameters that are good alone but not together.
class Checker {
 public:
  explicit Checker(Draft& draft) : draft_(draft) {}

  /// Unless `holds`, complains about `path` — if neither it nor `other` was complained about before. Says it where
  /// `path` was written, or `other` where `path` is a default.
  void require(bool holds, std::string_view path, std::string_view other, const std::string& message,
               const std::string& expected) {
    if (holds || is_bad(path) || (!other.empty() && is_bad(other))) return;
    const auto subject = draft_.given.find(path);
    const auto partner = draft_.given.find(other);
    Problem problem{.parameter = std::string(path), .expected = expected, .message = message};
    if (subject != draft_.given.end()) problem.value = subject->second.as_written;
    if (subject != draft_.given.end() && !subject->second.file.empty()) {
      problem.file = subject->second.file;
      problem.line = subject->second.line;
    } else if (partner != draft_.given.end() && !partner->second.file.empty()) {
      problem.file = partner->second.file;
      problem.line = partner->second.line;
    } else {
      problem.file = draft_.file;
    }
    draft_.problems.push_back(problem);
  }

 private:
  [[nodiscard]] bool is_bad(std::string_view path) const { return draft_.bad.contains(path); }

  Draft& draft_;
};

void check_times(const Mission& m, Checker& checker) {
  checker.require(m.simulation.exposure_time <= m.simulation.cycle, "Simulation/ExposureTime", "Simulation/Cycle",
                  "longer than the cycle", fmt::format("at most Cycle ({} s)", m.simulation.cycle.value()));
  checker.require(m.analysis.bin >= m.simulation.cycle, "Analysis/Bin", "Simulation/Cycle",
                  "shorter than one exposure cycle", fmt::format("at least Cycle ({} s)", m.simulation.cycle.value()));
  for (const std::int64_t step : m.output.dump_steps) {
    checker.require(step < m.simulation.exposures, "Output/DumpSteps", "Simulation/Exposures",
                    fmt::format("there is no exposure {}", step),
                    fmt::format("exposures from 0 to {}", m.simulation.exposures - 1));
  }
}

void check_detector(const Mission& m, Checker& checker) {
  const CcdSettings& ccd = m.ccd;
  if (ccd.has_sub_field) {
    const auto check = [&](int first, int count, int whole, std::string_view path, std::string_view other) {
      checker.require(static_cast<long>(first) + count <= whole, path, other, "the sub-field leaves the detector",
                      fmt::format("at most {} where it starts at {}", whole - first, first));
    };
    if (ccd.columns > 0) check(ccd.sub_x0, ccd.sub_columns, ccd.columns, "CCD/SubField/columns", "CCD/SubField/x");
    if (ccd.rows > 0) check(ccd.sub_y0, ccd.sub_rows, ccd.rows, "CCD/SubField/rows", "CCD/SubField/y");
  }
  if (ccd.columns > 0 && ccd.rows > 0) {
    checker.require(ccd.window <= std::min(ccd.columns, ccd.rows), "CCD/Window", "", "larger than the detector",
                    fmt::format("at most {} px", std::min(ccd.columns, ccd.rows)));
  }
  checker.require(ccd.bias.value() < std::ldexp(1.0, ccd.adc_bits) - 1.0, "CCD/Bias", "CCD/ADCBits",
                  "saturates the converter",
                  fmt::format("less than 2^ADCBits - 1 = {} ADU", std::ldexp(1.0, ccd.adc_bits) - 1.0));
}

void check_photometry(const Mission& m, Checker& checker) {
  const PhotometrySettings& photometry = m.photometry;
  checker.require(photometry.annulus_inner < photometry.annulus_outer, "Photometry/Annulus/Inner",
                  "Photometry/Annulus/Outer", "not inside the outer radius",
                  fmt::format("less than Outer ({} px)", photometry.annulus_outer.value()));
  checker.require(m.ccd.window == 0 || photometry.mask_window <= m.ccd.window, "Photometry/MaskWindow", "CCD/Window",
                  "larger than the window around the target", fmt::format("at most CCD/Window ({} px)", m.ccd.window));
}

void check_optics(const Mission& m, Checker& checker) {
  const DistortionSettings& distortion = m.telescope.distortion;
  const auto check_count = [&](std::size_t count, std::size_t most, std::string_view path) {
    checker.require(count <= most, path, "", fmt::format("{} coefficients", count), fmt::format("at most {}", most));
  };
  constexpr std::size_t kRadial = 3;
  check_count(distortion.radial.size(), kRadial, "Telescope/Distortion/Radial");
  check_count(distortion.tangential.size(), 2, "Telescope/Distortion/Tangential");
  check_count(distortion.prism.size(), 2, "Telescope/Distortion/Prism");
  checker.require(distortion.model != DistortionModel::kSip || !distortion.file.empty(), "Telescope/Distortion/File",
                  "Telescope/Distortion/model", "is missing", "the name of a readable file, since the model is sip");
  checker.require(
      m.telescope.vignetting.model != VignettingModel::kPolynomial || !m.telescope.vignetting.polynomial.empty(),
      "Telescope/Vignetting/Polynomial", "Telescope/Vignetting/model", "is missing",
      "coefficients, since the model is polynomial");
  checker.require(m.psf.model != PsfModel::kField || !m.psf.file.empty(), "PSF/File", "PSF/Model", "is missing",
                  "the name of a readable file, since the model is field");
}

}  // namespace

void check_together(const Mission& mission, Draft& draft) {
  Checker checker(draft);
  check_times(mission, checker);
  check_detector(mission, checker);
  check_photometry(mission, checker);
  check_optics(mission, checker);
  checker.require(mission.telescope.simulated_cameras <= mission.telescope.cameras, "Telescope/SimulatedCameras",
                  "Telescope/Cameras", "more than there are",
                  fmt::format("at most Cameras ({})", mission.telescope.cameras));
  checker.require(mission.satellite.jitter.model != JitterModel::kFile || !mission.satellite.jitter.file.empty(),
                  "Satellite/Jitter/File", "Satellite/Jitter/model", "is missing",
                  "the name of a readable file, since the model is file");
  checker.require(mission.psf.model != PsfModel::kTable || !mission.psf.file.empty(), "PSF/File", "PSF/Model",
                  "is missing", "the name of a readable file, since the model is table");
}

}  // namespace astroid::configuration
