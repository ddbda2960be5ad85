// Peaks of a filtered image, told apart by the depth of the saddles between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detect/smooth_image.hpp"

namespace astroid::detail {

struct PeakSettings {
  double threshold = 5.0;
  double footprint = 1.5;
  double prominence = 2.0;
  double contrast = 0.005;
  double photon_noise = 0.0;  ///< variance that light of height 1 adds, in units of that of the sky
};

struct FilteredPeak {
  int x = 0;
  int y = 0;
  float height = 0.0F;
  int area = 0;  ///< px
};

/// Peaks in the order of rows.
[[nodiscard]] std::vector<FilteredPeak> find_peaks(const SmoothImage& image, const PeakSettings& settings);

/// The same by raising a water level value by value over sorted pixels, slow and plain: what find_peaks() is tested
/// against.
[[nodiscard]] std::vector<FilteredPeak> reference_peaks(const SmoothImage& image, const PeakSettings& settings);

}  // namespace astroid::detail
