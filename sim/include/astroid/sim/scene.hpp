// The scene: what is there to be seen, and the instrument that looks. Immutable.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/catalogues/variability.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/sim/aberration.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/sim/attitude_trend.hpp"
#include "astroid/sim/bad_pixel_list.hpp"
#include "astroid/sim/optics.hpp"
#include "astroid/sim/renderer.hpp"
#include "astroid/sim/scene_summary.hpp"

namespace astroid {

/// A star on the detector or close enough to spill onto it.
struct SceneStar {
  std::string id;
  SkyPosition sky;                ///< NaN for a pixel catalogue
  PixelPosition position;         ///< px, at the nominal pointing, rounded to 2^-24 px
  Magnitude magnitude;            ///< in the zero point's passband
  double electrons = 0.0;         ///< detected per exposure, mean over the run
  double response = 1.0;          ///< what `electrons` have of throughput and vignetting
  AttitudeJacobian motion;        ///< px per arcsec of yaw, pitch and roll
  AberrationJacobian aberration;  ///< px per velocity of the spacecraft; zero where the mission leaves it out
  int variability = -1;           ///< index into Scene::variables(); -1: constant
  bool is_target = false;         ///< brighter than the target limit and on the computed pixels
};

/// What moves the line of sight.
struct AttitudeParts {
  bool jitter = false, drift = false, repointing = false;
};

/// The reflection of a bright star: a uniform disc, mirrored through the optical axis.
struct Ghost {
  PixelPosition position;   ///< px, of its centre at the nominal pointing
  double electrons = 0.0;   ///< per exposure, before throughput and vignetting
  AttitudeJacobian motion;  ///< px per arcsec, opposite to the star's
};

/// The immutable scene.
class Scene {
 public:
  /// @param mission    the configuration.
  /// @param catalogue  in the zero point's passband (convert_passband), or in pixels and electrons.
  /// @throws InputError when no star falls on the detector, or the attitude file does not cover the run.
  Scene(const Mission& mission, const StarCatalogue& catalogue);
  Scene(const Scene&) = delete;  // the summary points into the scene
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = delete;
  Scene& operator=(Scene&&) = delete;
  ~Scene() = default;

  [[nodiscard]] const Mission& mission() const { return mission_; }
  [[nodiscard]] Rectangle detector() const { return {0, 0, mission_.ccd.columns, mission_.ccd.rows}; }
  [[nodiscard]] std::span<const SceneStar> stars() const { return stars_; }
  /// Of all stars of the catalogue whose ghost may touch the detector, in catalogue order.
  [[nodiscard]] std::span<const Ghost> ghosts() const { return ghosts_; }
  /// Indices of the targets, in catalogue order.
  [[nodiscard]] std::span<const std::size_t> targets() const { return targets_; }
  [[nodiscard]] const std::shared_ptr<const PixelLayout>& layout() const { return layout_; }
  /// What the detector records of a star: with the common response within the pixel, if there is one.
  [[nodiscard]] const PixelPsf& psf() const { return *psf_; }
  /// What falls on the detector.
  [[nodiscard]] const PixelPsf& optical_psf() const { return *optical_psf_; }
  [[nodiscard]] const RendererChoice& renderer() const { return renderer_; }
  /// Null unless it is chosen.
  [[nodiscard]] const SubPixelRenderer* sub_pixel_renderer() const { return sub_pixel_renderer_.get(); }
  [[nodiscard]] const std::optional<SkyProjection>& projection() const { return projection_; }
  [[nodiscard]] const SceneSummary& summary() const { return summary_; }
  /// Bad pixels that are known by their place.
  [[nodiscard]] const BadPixelList& bad_pixels() const { return bad_pixels_; }
  /// How stars vary.
  [[nodiscard]] std::span<const VariableStar> variables() const { return variables_; }
  /// With everything that moves the line of sight.
  [[nodiscard]] const AttitudeModel& attitude() const { return *attitude_; }
  /// With some of it only.
  [[nodiscard]] std::shared_ptr<const AttitudeModel> attitude(const AttitudeParts& parts) const;
  /// The same at any time: its exposures fill the cycle. Of jitter from a model it is another realisation.
  [[nodiscard]] std::shared_ptr<const AttitudeModel> gapless_attitude(const AttitudeParts& parts) const;
  /// How far drift and re-pointing lead, and how fast.
  [[nodiscard]] const AttitudeTrend& attitude_trend() const { return trend_; }
  /// The zodiacal sky at a corner of the detector: lower left, lower right, upper left, upper right.
  /// @param time  since the start of the run
  [[nodiscard]] ElectronsPerSecond sky_at_corner(std::size_t corner, Seconds time) const;
  /// Middle of an exposure since the start of the run.
  [[nodiscard]] Seconds mid_time(std::int64_t exposure) const;
  /// The same since the start of the mission: quarters before that of the run count.
  [[nodiscard]] Seconds mission_time(std::int64_t exposure) const;
  /// Number of an exposure, counted from the start of the mission: what the noise of exposures is addressed by, so that
  /// quarters do not repeat each other's.
  [[nodiscard]] std::int64_t mission_number(std::int64_t exposure) const;
  /// What was assumed or left out while the scene was built, for the report.
  [[nodiscard]] std::span<const std::string> notes() const { return notes_; }

 private:
  void add_ghost(const SceneStar& star, SkyPosition direction);
  void find_sky();
  void read_variable_stars(const StarCatalogue& catalogue);

  Mission mission_;
  std::optional<SkyProjection> projection_;
  std::vector<SceneStar> stars_;
  std::vector<Ghost> ghosts_;
  std::vector<std::size_t> targets_;
  std::vector<VariableStar> variables_;
  BadPixelList bad_pixels_;
  std::shared_ptr<const PixelLayout> layout_;
  RendererChoice renderer_;
  std::shared_ptr<const PixelPsf> optical_psf_;
  std::shared_ptr<const PixelPsf> psf_;
  std::shared_ptr<const AttitudeModel> jitter_;
  AttitudeTrend drift_, repointing_, trend_;
  std::shared_ptr<const SubPixelRenderer> sub_pixel_renderer_;
  std::shared_ptr<const AttitudeModel> attitude_;
  ElectronsPerSecond rate_of_s10_{0.0};   // of a pixel; where the sky is zodiacal
  std::array<SkyPosition, 4> corners_{};  // of the detector, likewise
  SceneSummary summary_;
  std::vector<std::string> notes_;
};

/// Indices of the stars that are targets when the full frame is computed: a decision that looks at these is the same in
/// windows and sub-fields.
std::vector<std::size_t> full_frame_targets(const Scene& scene);

/// Electrons that a star of magnitude m gives in one exposure (F1).
double star_electrons(Magnitude magnitude, const TelescopeSettings& telescope, Seconds exposure_time);

}  // namespace astroid
