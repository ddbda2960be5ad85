#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/camera_groups.hpp"
#include "astroid/core/response.hpp"
#include "astroid/core/run_time.hpp"
#include "astroid/core/units.hpp"
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

void check_cmos(const Mission& m, Checker& checker) {
  const CmosSettings& cmos = m.cmos;
  const bool is_cmos = m.simulation.type == DetectorType::kCmos;
  // Silence would let a mission run without what it says.
  checker.require(is_cmos || cmos == CmosSettings{}, "Simulation/Type", "CMOS/Reads",
                  "is not the detector that the section CMOS describes", "CMOS, or no section CMOS");
  checker.require(4.0 * (cmos.coupling + cmos.corner_coupling) <= 0.5, "CMOS/Coupling/Side", "CMOS/Coupling/Corner",
                  "leaves less than half of its signal to a pixel", "side and corner of at most 12.5 % together");
  // A read that is cut at 0 counts as saturated, and then there is no ramp to fit.
  constexpr double kSigmas = 6.0;
  const double noise = std::hypot(m.ccd.readout_noise.value(), cmos.reset_noise.value()) / m.ccd.gain.value();
  const double lowest = std::ceil(kSigmas * std::hypot(noise, cmos.offset_rms.value()));
  checker.require(!is_cmos || cmos.reads <= 1 || m.ccd.bias.value() >= lowest, "CCD/Bias", "CMOS/Reads",
                  "lets the noise of reads fall below 0 ADU",
                  fmt::format("at least {:g} ADU, 6 sigma of readout noise, reset noise and offsets", lowest));
  checker.require(cmos.telegraph_fraction == 0.0 || cmos.telegraph_current.value() > 0.0, "CMOS/Telegraph/Current",
                  "CMOS/Telegraph/Fraction", "is 0, though pixels jump", "more than 0 e-/px/s");
  checker.require(cmos.persistence.time.size() == cmos.persistence.fraction.size(), "CMOS/Persistence/Time",
                  "CMOS/Persistence/Fraction", fmt::format("is a list of {}", cmos.persistence.time.size()),
                  fmt::format("{}, one for each fraction", cmos.persistence.fraction.size()));
  double held = 0.0;
  for (const double share : cmos.persistence.fraction) held += share;
  constexpr double kMostHeld = 0.2;
  checker.require(held <= kMostHeld, "CMOS/Persistence/Fraction", "", "holds more than 20 % of the charge in all",
                  "at most 20 % together");
  const double readout = cmos.line_time.value() * m.ccd.rows;
  checker.require(m.ccd.rows <= 0 || readout <= m.simulation.cycle.value(), "CMOS/LineTime", "Simulation/Cycle",
                  fmt::format("{} rows take {:g} s, longer than the cycle", m.ccd.rows, readout),
                  fmt::format("at most {:g} s", m.simulation.cycle.value() / std::max(1, m.ccd.rows)));
}

/// A turn between quarters puts every star elsewhere, which one run cannot show.
void check_quarters(const Mission& m, Checker& checker) {
  const double length = m.satellite.quarter_days * kSecondsPerDay;
  const bool turns = m.satellite.repointing.turn.value() != 0.0;
  checker.require(m.simulation.quarter == 0 || length > 0.0, "Simulation/Quarter", "Satellite/Quarter",
                  "is not the first, though the spacecraft is never pointed anew", "0, or Satellite/Quarter above 0 d");
  const double end = end_of_run(m.simulation).value();
  checker.require(
      !turns || length <= 0.0 || end <= length, "Simulation/Exposures", "Satellite/Repointing/Turn",
      fmt::format("the run lasts {:.6g} d, beyond the end of its quarter after {:.6g} d, when the spacecraft "
                  "turns and every star lands on another pixel",
                  end / kSecondsPerDay, m.satellite.quarter_days),
      "a run within one quarter, and one run for each (Simulation/Quarter)");
}

void check_traps(const Mission& m, Checker& checker) {
  const CtiSettings& cti = m.ccd.cti;
  if (cti.model != CtiModel::kTraps) return;
  const std::size_t species = cti.trap_density.size();
  checker.require(species > 0, "CCD/CTI/TrapDensity", "CCD/CTI/model", "is missing",
                  "the density of each species, since the model is traps");
  const auto check = [&](std::size_t number, std::string_view path) {
    checker.require(species == 0 || number == species, path, "CCD/CTI/TrapDensity",
                    fmt::format("has {} values", number), fmt::format("{}, one for each density", species));
  };
  check(cti.trap_cross_section.size(), "CCD/CTI/CrossSection");
  check(cti.trap_release_time.size(), "CCD/CTI/ReleaseTime");
  if (!cti.register_density.empty()) check(cti.register_density.size(), "CCD/CTI/RegisterDensity");
}

std::string one_for_each(std::string_view what, int nodes) {
  return fmt::format("{} {}, one for each node, or none", nodes, what);
}

void check_readout(const Mission& m, Checker& checker) {
  const CcdSettings& ccd = m.ccd;
  const auto fits = [&](const std::vector<double>& list) {
    return list.empty() || list.size() == static_cast<std::size_t>(ccd.nodes.count);
  };
  checker.require(fits(ccd.nodes.gain_factor), "CCD/Nodes/GainFactors", "CCD/Nodes/Count",
                  fmt::format("{} numbers for {} nodes", ccd.nodes.gain_factor.size(), ccd.nodes.count),
                  one_for_each("factors", ccd.nodes.count));
  checker.require(fits(ccd.nodes.noise_factor), "CCD/Nodes/NoiseFactors", "CCD/Nodes/Count",
                  fmt::format("{} numbers for {} nodes", ccd.nodes.noise_factor.size(), ccd.nodes.count),
                  one_for_each("factors", ccd.nodes.count));
  // Charge transfer moves all rows downwards; the halves of a column would have to move apart.
  const CtiSettings& cti = ccd.cti;
  const bool parallel = (cti.model == CtiModel::kSimple && cti.parallel > 0.0) ||
                        (cti.model == CtiModel::kTraps && std::any_of(cti.trap_density.begin(), cti.trap_density.end(),
                                                                      [](double d) { return d > 0.0; }));
  checker.require(!parallel || ccd.nodes.count < 4, "CCD/CTI/model", "CCD/Nodes/Count",
                  "loses charge between rows, which four nodes move in opposite directions",
                  "none, losses between columns alone, or one or two nodes");
  const auto check_response = [&](const std::vector<double>& coefficients, std::string_view path) {
    checker.require(coefficients.empty() || coefficients.size() == 3, path, "",
                    fmt::format("{} coefficients", coefficients.size()), "three numbers, a0 a1 a2, or none");
    if (coefficients.size() != 3) return;
    const double top = std::ldexp(1.0, ccd.adc_bits) - 1.0;
    checker.require(make_response(coefficients).rises(0.0, top), path, "CCD/ADCBits",
                    "the response falls within the range of the converter",
                    fmt::format("1 + a1 + 2 a2 I above 0 from 0 to {} ADU", top));
  };
  check_response(ccd.electronics.nonlinearity, "CCD/Electronics/NonLinearity");
  check_response(m.photometry.calibration.nonlinearity_coefficients, "Photometry/Calibration/NonLinearityCoefficients");
}

void check_calibration(const Mission& m, Checker& checker) {
  const CalibrationSettings& calibration = m.photometry.calibration;
  const ReferencePixels& reference = m.ccd.reference;
  checker.require(!calibration.smearing || reference.parallel_overscan > 0, "Photometry/Calibration/Smearing",
                  "CCD/ReferencePixels/Overscan", "there are no overscan rows to correct it with",
                  "off, or CCD/ReferencePixels/Overscan of 1 px or more");
  const bool has_prescan = reference.prescan > 0 && (m.ccd.nodes.count == 1 || reference.serial_overscan > 0);
  checker.require(calibration.bias != BiasSource::kPrescan || has_prescan, "Photometry/Calibration/Bias",
                  m.ccd.nodes.count == 1 ? "CCD/ReferencePixels/Prescan" : "CCD/ReferencePixels/SerialOverscan",
                  "there are no columns that show the bias of every node",
                  m.ccd.nodes.count == 1 ? "known, or CCD/ReferencePixels/Prescan of 1 px or more"
                                         : "known, or Prescan and SerialOverscan of 1 px or more");
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

void check_groups(const Mission& m, Checker& checker) {
  constexpr std::string_view kCameras = "Telescope/Groups/Cameras";
  const CameraGroups& groups = m.telescope.groups;
  const std::size_t count = groups.cameras.size();
  const auto check_list = [&](const std::vector<double>& list, std::string_view path) {
    checker.require(list.empty() || list.size() == count, path, kCameras,
                    fmt::format("has {} values for {} groups", list.size(), count),
                    count == 0 ? "nothing, or the cameras of each group in Telescope/Groups/Cameras"
                               : fmt::format("{}, one for each group, or none", count));
  };
  check_list(groups.tilt, "Telescope/Groups/Tilt");
  check_list(groups.azimuth, "Telescope/Groups/Azimuth");
  check_list(groups.roll, "Telescope/Groups/Roll");
  check_list(groups.stagger, "Telescope/Groups/Stagger");
  check_list(groups.offset_x, "Telescope/Groups/OffsetX");
  check_list(groups.offset_y, "Telescope/Groups/OffsetY");
  check_list(groups.throughput, "Telescope/Groups/Throughput");
  check_list(groups.end_of_life, "Telescope/Groups/EndOfLife");
  for (const double stagger : groups.stagger)
    checker.require(stagger < m.simulation.cycle.value(), "Telescope/Groups/Stagger", "Simulation/Cycle",
                    fmt::format("{} s is a cycle or more", stagger),
                    fmt::format("less than Cycle ({} s)", m.simulation.cycle.value()));
  if (count == 0) return;
  const int cameras = std::accumulate(groups.cameras.begin(), groups.cameras.end(), 0);
  checker.require(m.telescope.cameras == cameras, "Telescope/Cameras", kCameras, "is not the sum of the groups",
                  fmt::format("{}, as Telescope/Groups/Cameras has", cameras));
  const int turn = cameras_in_turn(m.telescope);
  checker.require(m.telescope.simulated_cameras % turn == 0, "Telescope/SimulatedCameras", kCameras,
                  "does not hold the same share of every group",
                  fmt::format("a multiple of {}, up to {}", turn, cameras));
}

}  // namespace

void check_together(const Mission& mission, Draft& draft) {
  Checker checker(draft);
  check_times(mission, checker);
  check_detector(mission, checker);
  check_cmos(mission, checker);
  check_quarters(mission, checker);
  check_traps(mission, checker);
  check_readout(mission, checker);
  check_calibration(mission, checker);
  check_photometry(mission, checker);
  check_optics(mission, checker);
  check_groups(mission, checker);
  checker.require(mission.telescope.simulated_cameras <= mission.telescope.cameras, "Telescope/SimulatedCameras",
                  "Telescope/Cameras", "more than there are",
                  fmt::format("at most Cameras ({})", mission.telescope.cameras));
  const JitterSettings& jitter = mission.satellite.jitter;
  const bool from_file = jitter.model == JitterModel::kFile || jitter.model == JitterModel::kSpectrum;
  checker.require(!from_file || !jitter.file.empty(), "Satellite/Jitter/File", "Satellite/Jitter/model", "is missing",
                  fmt::format("the name of a readable file, since the model is {}",
                              jitter.model == JitterModel::kFile ? "file" : "psd"));
  const StrayLightSettings& stray = mission.field.stray_light;
  checker.require(std::fabs(stray.gradient_x) + std::fabs(stray.gradient_y) <= 1.0, "StellarField/StrayLight/GradientY",
                  "StellarField/StrayLight/GradientX", "makes the stray light negative in a corner",
                  "at most 100 % together with the other gradient, without their signs");
  checker.require(mission.psf.model != PsfModel::kTable || !mission.psf.file.empty(), "PSF/File", "PSF/Model",
                  "is missing", "the name of a readable file, since the model is table");
}

}  // namespace astroid::configuration
