// photometry/lightcurves.fits: one file for all stars, written in blocks of exposures as the run goes on.
//
// HDU TIME      table: TIME (BJD_TDB - 2457000, d, mid-exposure), CADENCENO
// HDU STARS     table: ID, MAG, X, Y, REFERENCE (e- per exposure, double), NSR (sigma / REFERENCE of one exposure),
// FLAGS HDU CAMERA1 … one image per camera: FLUX[star][exposure], float32 relative deviation from REFERENCE HDU
// COMBINED  the mean of the cameras HDU FLAGS     table: CAMERA, STAR, CADENCENO, FLAGS, only where a flag is set
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace astroid {

/// A star of a light-curve file.
struct LightCurveStar {
  std::string id;
  double magnitude = 0.0;
  double x = 0.0, y = 0.0;
  double reference = 0.0;  ///< e- per exposure
  double nsr_exposure = 0.0;
  std::uint32_t flags = 0;
};

struct LightCurveFlag {
  std::uint32_t camera = 0;
  std::uint32_t star = 0;
  std::int64_t exposure = 0;
  std::uint32_t flags = 0;
};

struct LightCurveHeader {
  std::int64_t exposures = 0;
  int cameras = 1;
  double start_mjd = 0.0;            ///< TDB, start of the first exposure
  double cycle = 0.0;                ///< s
  double exposure_time = 0.0;        ///< s
  std::vector<std::string> history;  ///< the plan, line by line
};

/// Writes lightcurves.fits beside, in blocks; renames on commit(). Not thread-safe.
class LightCurveWriter {
 public:
  LightCurveWriter(const std::string& path, const LightCurveHeader& header, std::span<const LightCurveStar> stars);
  ~LightCurveWriter();
  LightCurveWriter(const LightCurveWriter&) = delete;
  LightCurveWriter& operator=(const LightCurveWriter&) = delete;
  LightCurveWriter(LightCurveWriter&&) = delete;
  LightCurveWriter& operator=(LightCurveWriter&&) = delete;

  /// @param deviation  shape (stars, count): relative deviation of exposures first … first+count-1 of one camera.
  void write_block(int camera, std::int64_t first, std::size_t count, std::span<const float> deviation);
  void add_flags(std::span<const LightCurveFlag> flags);
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One light curve read back.
struct LightCurve {
  LightCurveStar star;
  std::vector<double> time;  ///< s since start, mid-exposure
  std::vector<double> flux;  ///< e- per exposure; NaN where flagged unmeasurable
  std::vector<std::uint32_t> flags;
};
/// @throws InputError when the file has no such star or is not a light-curve file.
LightCurve read_light_curve(const std::string& path, const std::string& id, int camera);

/// Writes one star as a file that lightkurve opens (no CREATOR card, TELESCOP = 'ASTROID', TIMESYS TDB).
void export_light_curve(const std::string& path, const LightCurve& curve, const LightCurveHeader& header);

}  // namespace astroid
