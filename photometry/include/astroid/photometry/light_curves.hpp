// photometry/lightcurves.fits: one file for all stars, written in blocks of exposures as the run goes on.
//
// 1 primary    no data; what the run was: CAMERAS, CYCLE, EXPTIME, MJD-BEG, the plan in HISTORY
// 2 TIME       table: TIME (BJD_TDB - 2457000, d, mid-exposure), CADENCENO
// 3 STARS      table: ID, MAG, X, Y, REFERENCE (e- per exposure, double), NSR (sigma / REFERENCE of one exposure),
// FLAGS 4 CAMERA1 …  one image per camera: FLUX[star][exposure], float32 relative deviation from REFERENCE … COMBINED
// the mean of the cameras; left out where there is only one, which then stands for it … FLAGS      table: CAMERA, STAR,
// CADENCENO, EXPOSURES, FLAGS, where flags are set that STARS does not have, in so
//              many exposures in a row from CADENCENO on
//
// Where groups of cameras see the stars differently, STARS is of their mean and tables STARS1 … before FLAGS are of
// each group. The cards GROUP and STAGGER of a camera's image say which is its own, and how long after the start of a
// cycle its exposures begin; TIME is the mean of all cameras.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/photometry/attitude_response.hpp"

namespace astroid {

/// A star of a light-curve file.
struct LightCurveStar {
  std::string id;
  double magnitude = 0.0;
  double x = 0.0, y = 0.0;
  double reference = 0.0;  ///< e- per exposure
  double nsr_exposure = 0.0;
  std::uint32_t flags = 0;      ///< measurement_flag bits that hold for every exposure
  AttitudeResponse response{};  ///< by which the attitude was taken out of it, where it was
};

/// Flags of consecutive measurements, beyond those that their star has in every exposure.
struct LightCurveFlag {
  std::uint32_t camera = 0;    ///< 1 … cameras
  std::uint32_t star = 0;      ///< 0-based
  std::int64_t exposure = 0;   ///< the first of them
  std::uint32_t flags = 0;     ///< the same in all of them
  std::int64_t exposures = 1;  ///< how many
};

/// Sorts flags by camera, star and exposure, and joins those that follow one another.
/// @param flags  no two of the same measurement.
void join_flags(std::vector<LightCurveFlag>& flags);

struct LightCurveHeader {
  std::int64_t exposures = 0;
  int cameras = 1;
  double start_mjd = 0.0;            ///< TDB, start of the first exposure
  double cycle = 0.0;                ///< s
  double exposure_time = 0.0;        ///< s
  std::vector<std::string> history;  ///< the plan, line by line
  std::vector<int> group{};          ///< of each camera, from 0; empty: all cameras are alike
  std::vector<double> stagger{};     ///< s, of each camera after the start of a cycle; empty: none
  bool is_corrected = false;         ///< for the attitude, which the file tells beside (with_attitude())
  bool has_responses = false;        ///< LightCurveStar::response holds for all exposures: masks are not refreshed
  double line_time = 0.0;            ///< s, by which a row is exposed later than the one below; 0: all at once
};

/// Mid-exposure of exposure k, seconds since the start of the first: exact in k, never summed up.
/// @param camera  1 … cameras; 0: the mean of all.
/// @accuracy 1e-7 s over 4.5 years.
[[nodiscard]] double mid_exposure(const LightCurveHeader& header, std::int64_t exposure, int camera = 0);

/// The same as BJD_TDB - 2457000, d. @accuracy 5e-8 s (the last bit of a day number near 5000).
[[nodiscard]] double mid_exposure_bjd(const LightCurveHeader& header, std::int64_t exposure);

/// Writes lightcurves.fits beside, in blocks; renames on commit(); without it nothing stays behind.
///
/// Memory hardly grows with the exposures: what is kept is the flags, in a row, the attitudes that fluxes were
/// corrected for, and, of several cameras, one block of their mean.
/// @throws EnvironmentError(path, cause), from every member function.  @thread one at a time, but for write_star()
class LightCurveWriter {
 public:
  /// @param groups  the stars as each group of cameras sees them, where there are several.
  LightCurveWriter(const std::string& path, const LightCurveHeader& header, std::span<const LightCurveStar> stars,
                   std::vector<std::vector<LightCurveStar>> groups = {});
  ~LightCurveWriter();
  LightCurveWriter(const LightCurveWriter&) = delete;
  LightCurveWriter& operator=(const LightCurveWriter&) = delete;
  LightCurveWriter(LightCurveWriter&&) = delete;
  LightCurveWriter& operator=(LightCurveWriter&&) = delete;

  /// Writes exposures first … first+count-1 of one camera. Blocks may come in any order, but one block comes from
  /// camera 1, 2, … in turn, so that the mean is always added up in the same order.
  /// @param camera     1 … cameras.
  /// @param deviation  shape (stars, count): relative deviation from the star's reference; NaN where unmeasurable.
  /// @throws BugError when a block repeats, does not fit, or skips a camera.
  void write_block(int camera, std::int64_t first, std::size_t count, std::span<const float> deviation);

  /// The same star by star: begin_block(), write_star() of every star in any order, end_block().
  /// @throws BugError as write_block() does.
  void begin_block(int camera, std::int64_t first, std::size_t count);
  /// Writes the exposures of the block of one star.  @thread several at a time, each with other stars.
  void write_star(std::size_t star, std::span<const float> deviation);
  /// @throws BugError unless as many stars were written as there are.
  void end_block();

  void add_flags(std::span<const LightCurveFlag> flags);
  /// The attitudes that the next exposures of a camera, in their order, were corrected for.
  void add_attitudes(int camera, std::span<const Attitude> attitudes);
  /// @throws BugError unless every exposure of every camera was written.
  void commit(Durability durability = Durability::kAtOnce);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The header and stars of a light-curve file.
struct LightCurveContents {
  LightCurveHeader header;
  std::vector<LightCurveStar> stars;
  std::vector<std::vector<LightCurveStar>> groups{};  ///< the same as each group of cameras sees them; or empty
};
/// @throws InputError when it is not a light-curve file; EnvironmentError when it cannot be read.
[[nodiscard]] LightCurveContents read_light_curve_contents(const std::string& path);

/// One light curve read back.
struct LightCurve {
  LightCurveStar star;
  std::vector<double> time;          ///< s since start, mid-exposure
  std::vector<double> flux;          ///< e- per exposure; NaN where flagged unmeasurable
  std::vector<std::uint32_t> flags;  ///< with those that the star always has
};

/// Reads light curves one after the other: of a file of gigabytes only what belongs to the star asked for.
/// @throws InputError when it is not a light-curve file; EnvironmentError when it cannot be read.
/// @thread one thread at a time
class LightCurveReader {
 public:
  explicit LightCurveReader(const std::string& path);
  ~LightCurveReader();
  LightCurveReader(const LightCurveReader&) = delete;
  LightCurveReader& operator=(const LightCurveReader&) = delete;
  LightCurveReader(LightCurveReader&&) = delete;
  LightCurveReader& operator=(LightCurveReader&&) = delete;

  [[nodiscard]] const LightCurveContents& contents() const;
  /// @param star    index in contents().stars.
  /// @param camera  1 … cameras; 0: the mean of all cameras, with the flags of all.
  /// @throws InputError when the file has no such star or camera.
  [[nodiscard]] LightCurve read(std::size_t star, int camera) const;
  /// The same for the star of that id.
  [[nodiscard]] LightCurve read(const std::string& id, int camera) const;
  /// What each exposure of a camera was corrected for; empty where nothing was corrected.
  [[nodiscard]] std::vector<Attitude> attitudes(int camera) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One light curve of a file, by LightCurveReader.
LightCurve read_light_curve(const std::string& path, const std::string& id, int camera);

/// Writes one star as a file that lightkurve opens (no CREATOR card, TELESCOP = 'ASTROID', TIMESYS TDB): columns TIME,
/// FLUX and FLUX_ERR (e- per exposure), QUALITY (measurement_flag bits), CADENCENO.
void export_light_curve(const std::string& path, const LightCurve& curve, const LightCurveHeader& header);

}  // namespace astroid
