// The scene: what is there to be seen, and the instrument that looks. Immutable.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/sim/optics.hpp"
#include "astroid/sim/scene_summary.hpp"

namespace astroid {

/// A star on the detector or close enough to spill onto it.
struct SceneStar {
  std::string id;
  SkyPosition sky;          ///< NaN for a pixel catalogue
  PixelPosition position;   ///< px, at the nominal pointing, rounded to 2^-24 px
  Magnitude magnitude;      ///< in the zero point's passband
  double electrons = 0.0;   ///< detected per exposure, mean over the run
  double response = 1.0;    ///< what `electrons` have of throughput and vignetting
  AttitudeJacobian motion;  ///< px per arcsec of yaw, pitch and roll
  bool is_target = false;   ///< brighter than the target limit and on the computed pixels
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
  [[nodiscard]] const PixelPsf& psf() const { return *psf_; }
  [[nodiscard]] const std::optional<SkyProjection>& projection() const { return projection_; }
  [[nodiscard]] const SceneSummary& summary() const { return summary_; }
  [[nodiscard]] const AttitudeModel& attitude() const { return *attitude_; }
  [[nodiscard]] Seconds mid_time(std::int64_t exposure) const;
  /// What was assumed or left out while the scene was built, for the report.
  [[nodiscard]] std::span<const std::string> notes() const { return notes_; }

 private:
  void add_ghost(const SceneStar& star, SkyPosition direction);

  Mission mission_;
  std::optional<SkyProjection> projection_;
  std::vector<SceneStar> stars_;
  std::vector<Ghost> ghosts_;
  std::vector<std::size_t> targets_;
  std::shared_ptr<const PixelLayout> layout_;
  std::shared_ptr<const PixelPsf> psf_;
  std::shared_ptr<const AttitudeModel> attitude_;
  SceneSummary summary_;
  std::vector<std::string> notes_;
};

/// Indices of the stars that are targets when the full frame is computed: a decision that looks at these is the same in
/// windows and sub-fields.
std::vector<std::size_t> full_frame_targets(const Scene& scene);

/// Electrons that a star of magnitude m gives in one exposure (F1).
double star_electrons(Magnitude magnitude, const TelescopeSettings& telescope, Seconds exposure_time);

}  // namespace astroid
