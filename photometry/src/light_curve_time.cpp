#include <cstddef>

#include "astroid/core/units.hpp"
#include "astroid/photometry/light_curves.hpp"

namespace astroid {

namespace {

// TIME counts from BJD 2457000 as TESS does; MJD counts from JD 2400000.5.
constexpr double kMjdOfTimeZero = 2457000.0 - 2400000.5;

}  // namespace

double mid_exposure(const LightCurveHeader& header, std::int64_t exposure, int camera) {
  double stagger = 0.0;
  if (camera > 0 && !header.stagger.empty()) stagger = header.stagger[static_cast<std::size_t>(camera) - 1];
  if (camera == 0)
    for (const double one : header.stagger) stagger += one / static_cast<double>(header.stagger.size());
  return stagger + (static_cast<double>(exposure) * header.cycle + 0.5 * header.exposure_time);
}

double mid_exposure_bjd(const LightCurveHeader& header, std::int64_t exposure) {
  return (header.start_mjd - kMjdOfTimeZero) + mid_exposure(header, exposure) / kSecondsPerDay;
}

}  // namespace astroid
