// Which frames are written, and how: images/*.fits and the intermediate maps of --dump-steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "astroid/core/fits_image_series.hpp"
#include "astroid/core/frame.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
#include "astroid/sim/simulator.hpp"

namespace astroid {

/// Frames and maps as FITS files under a run's folder. @thread safe: every file has one writer.
class ImageFiles {
 public:
  /// @param folder  of the run; empty: nothing is written.
  ImageFiles(const Scene& scene, const Plan& plan, std::filesystem::path folder);

  /// True when the configuration asks for the frame of this exposure.
  [[nodiscard]] bool writes(int camera, std::int64_t exposure) const;
  /// True when the configuration asks for the maps after each step of this exposure.
  [[nodiscard]] bool dumps(int camera, std::int64_t exposure) const;

  /// images/camera1_000000.fits: 16-bit ADU of a full frame or sub-field, or a cube of windows with a table of where
  /// they lie. @throws EnvironmentError
  void write(const Frame& frame) const;

  /// Writes steps/camera1_000000_05_prnu.fits after every step.
  [[nodiscard]] StepObserver step_writer(int camera, std::int64_t exposure) const;

 private:
  const Scene& scene_;
  std::vector<std::string> history_;
  std::filesystem::path folder_;
  std::optional<FitsImageSeries> series_{};  // unless images are cubes of windows
};

/// The plan's lines for HISTORY cards: without its predicted times, so that products do not change with the machine.
std::vector<std::string> history_of(const Plan& plan, const Scene& scene);

/// A copy of the largest region of a frame, for a picture.
Image<float, unit::Adu> largest_region(const Frame& frame);

}  // namespace astroid
