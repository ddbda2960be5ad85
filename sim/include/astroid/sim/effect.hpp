// What an effect is: data about itself and two functions. No files, no configuration strings, no clock, no mutable
// members.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/sub_pixel.hpp"
#include "astroid/sim/aberration.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/sim/cmos_state.hpp"
#include "astroid/sim/conditions.hpp"
#include "astroid/sim/moving_image.hpp"
#include "astroid/sim/scene_summary.hpp"
#include "astroid/sim/strip.hpp"

namespace astroid {

class Scene;
class SmearedColumns;
struct PlanKnobs;

/// Levels of the chain, in the order of the run.
enum class EffectLevel : std::uint8_t {
  kCatalogue,
  kPointing,
  kOptics,
  kSky,
  kSubPixel,
  kPixelMean,    ///< expected electrons
  kPixelSample,  ///< drawn electrons
  kReadout,      ///< ADU
};
std::string_view to_string(EffectLevel level);

/// What an effect can read and write; bits.
namespace plane_bit {
inline constexpr std::uint32_t kStars = 1U << 0;     ///< positions and fluxes of the scene (given)
inline constexpr std::uint32_t kAttitude = 1U << 1;  ///< displacement of the exposure
inline constexpr std::uint32_t kExpected = 1U << 2;  ///< expected electrons
inline constexpr std::uint32_t kSampled = 1U << 3;   ///< drawn electrons
inline constexpr std::uint32_t kAnalog = 1U << 4;    ///< ADU before digitising
inline constexpr std::uint32_t kDigital = 1U << 5;   ///< ADU as delivered
inline constexpr std::uint32_t kFlags = 1U << 6;     ///< pixel flags (given, zero)
inline constexpr std::uint32_t kRamp = 1U << 7;      ///< what is kept of the reads of a ramp
}  // namespace plane_bit

enum class RandomScope : std::uint8_t { kNone, kStatic, kPerExposure };

/// `halo_px` of an effect that needs a whole column or frame.
inline constexpr int kWholeColumn = -1;

/// Which pixels an effect changes.
enum class PixelSet : std::uint8_t {
  kExposed,  ///< those that light falls on
  kAll,      ///< reference pixels too
};

/// What an effect up to PixelMean does to the expected image. The noiseless image is recalled where nothing or little
/// moves; light that differs from exposure to exposure is then rendered alone, taken through the responses, and added.
enum class ImageRole : std::uint8_t {
  kNone,          ///< makes no image
  kLight,         ///< adds light, which changes through the attitude and the conditions only
  kVaryingLight,  ///< adds light that differs from exposure to exposure
  kResponse,      ///< multiplies or moves light, linearly, the same in every exposure
  kOffset,        ///< adds what is not light, the same in every exposure
  kMemory,        ///< comes after all others, and adds what the expected images of earlier exposures left behind
};

/// An effect's data about itself.
struct EffectSpec {
  std::string_view name;
  StreamId id;  ///< number of its random stream, never reused
  EffectLevel level;
  std::uint32_t reads;   ///< plane_bit
  std::uint32_t writes;  ///< plane_bit
  int halo_px;           ///< how far a pixel's result depends on other pixels; kWholeColumn: on all of them
  RandomScope random;
  std::string_view source;  ///< key in docs/references.bib, empty where the formula is elementary
  ImageRole role = ImageRole::kNone;
  PixelSet pixels = PixelSet::kExposed;
  bool per_read = false;  ///< runs once for every non-destructive read of an exposure
};

/// Whether an effect is needed, why, and what skipping it would cost.
struct EffectNeed {
  bool needed = false;
  std::string why;          ///< in words, with numbers
  double bias_bound = 0.0;  ///< e- per exposure on any target's flux, if skipped
  double variance_bound =
      0.0;  ///< of any target's flux at the longest reported time bin with all cameras, relative to its variance
  /// How long the conditions it sets may be taken as constant without moving a flux beyond its tolerance.
  Seconds steady{std::numeric_limits<double>::infinity()};
  /// Where all that those conditions do is to move stars smoothly: how, per second. The image may then be a polynomial
  /// in time, and they need not be constant.
  SlowMotion motion{};
};

/// What rendering a star takes.
struct RenderedStar {
  PixelPosition position;         ///< px, at the nominal pointing
  double electrons = 0.0;         ///< per exposure, before throughput and vignetting
  double half_width = 0.0;        ///< of its stamp, px
  AttitudeJacobian motion;        ///< px per arcsec of yaw, pitch and roll
  AberrationJacobian aberration;  ///< px per velocity of the spacecraft
  int variability = -1;           ///< of the scene; -1: constant
};

/// What is on one tile of the sub-pixel renderer.
struct SubPixelTile {
  Rectangle area;
  std::vector<RenderedStar> stars;  ///< those that may reach it
};

/// Sensitivity within the pixels of one camera.
struct IntraPixelState {
  PixelResponse common;
  double flat = 0.0;    ///< rms of the cells' own sensitivity
  RandomStream stream;  ///< of which a cell takes the draw of its number
};

/// What happens to one camera that does not change from exposure to exposure; built once, then only read.
struct CameraState {
  int camera = 0;
  std::shared_ptr<const PixelLayout> layout;                      ///< the computed pixels
  std::vector<Strip> strips;                                      ///< of the layout
  std::vector<std::vector<std::vector<RenderedStar>>> stars;      ///< [strip][area]: those that may reach it
  std::vector<std::vector<std::vector<RenderedStar>>> variables;  ///< likewise those whose flux varies
  std::vector<SubPixelTile> tiles;                                ///< instead of `stars`, of the sub-pixel renderer
  std::optional<IntraPixelState> intra_pixel;                     ///< nothing when the effect is off
  Plane<float, unit::Relative> vignetting;                        ///< 1 on the axis; empty when the effect is off
  Plane<float, unit::Relative> prnu;           ///< pixel response, mean 1; empty when the effect is off
  Plane<float, unit::Relative> flat_field;     ///< its large-scale part, mean 1; empty when the effect is off
  Plane<float, unit::ExpectedElectrons> dark;  ///< dark electrons per exposure; empty when the effect is off
  std::shared_ptr<const std::vector<SmearedColumns>> smearing;  ///< [half of the rows]: of the columns of the layout
  Plane<float, unit::ExpectedElectrons> unsmeared;  ///< what frame transfer smears less than that; empty: nothing
  std::vector<std::uint32_t> dead_pixels;           ///< places in the buffer of the layout, rising
  std::vector<std::uint32_t> hot_pixels;
  std::vector<double> hot_electrons;         ///< of each of them, per exposure
  std::vector<std::size_t> cross_talk_from;  ///< [delivered region][mirror]: the computed region that it hears
  CmosPatterns cmos;                         ///< of a CMOS detector
};

/// Where bands of rows look that are exposed one after the other. All empty where all rows are exposed at once.
struct RowBands {
  int rows = 0;                                 ///< of a band; the first begins with row 0
  std::span<const AttitudeMoments> attitude{};  ///< of each band while it is exposed
  std::span<const Attitude> steps{};            ///< [band][step], where the plan wants them
};

/// What the expected image of an earlier exposure adds to this one.
struct PastImage {
  std::shared_ptr<const Plane<float, unit::ExpectedElectrons>> electrons;  ///< none beyond the full well
  double share = 0.0;                                                      ///< of it
};

/// Everything that belongs to one exposure of one camera. One worker owns it.
struct ExposureState {
  int camera = 0;
  std::int64_t exposure = 0;
  std::int64_t number = 0;                    ///< of the exposure since the start of the mission: address of its noise
  int read = 0;                               ///< non-destructive read at work, from 0
  Conditions conditions;                      ///< that change slowly
  AttitudeMoments attitude;                   ///< of the exposure; zero when nothing moves
  std::span<const Attitude> attitude_steps;   ///< of the exposure, where the plan wants them
  RowBands bands;                             ///< for which both are otherwise, with a rolling shutter
  Seconds line_time{0.0};                     ///< by which a row is exposed later than the one below it
  std::vector<MovingImage::Exposure> moving;  ///< its noiseless image (of each band), where recalled from fixed maps
  std::vector<PastImage> past;                ///< with what of them is released in this exposure
  std::shared_ptr<const Plane<double, unit::ExpectedElectrons>> recalled;  ///< the same, where exposures share it
  bool still = false;                                                      ///< whether nothing is added to that
  StripPlane<double, unit::ExpectedElectrons> expected;
  StripPlane<double, unit::SampledElectrons> sampled;
  StripPlane<double, unit::Adu> analog;
  RampPlanes ramps;                    ///< where an exposure is read more than once
  Frame frame;                         ///< the delivered pixels
  std::unique_ptr<Frame> more;         ///< the computed pixels, where they are more than the delivered ones
  double lost_electrons = 0.0;         ///< charge that left through the edge of the frame or was clipped
  std::int64_t clipped_pixels = 0;     ///< by the ADC
  NegativeLight ringing;               ///< that the sub-pixel renderer silenced
  std::vector<double> effect_seconds;  ///< wall time of each effect of the plan, over all exposures this state has seen
  std::vector<double> scratch;         ///< of the effect at work; its content means nothing between calls
  std::vector<float> normals;          ///< the same for random numbers
  SubPixelRenderer::Workspace sub_pixel;  ///< the same of the sub-pixel renderer

  /// Digital numbers and flags of the computed pixels: what effects write.
  [[nodiscard]] Frame& computed() { return more != nullptr ? *more : frame; }

  /// The expected electrons that draws are made from: of the image that never changes, which is read where it lies, or
  /// of this exposure.
  [[nodiscard]] std::span<const double> expectation(const Strip& strip) {
    return still ? recalled->pixels().subspan(strip.begin, strip.size()) : expected.pixels(strip);
  }
};

/// What an effect may look at besides the exposure.
struct EffectContext {
  const Scene& scene;
  const PlanKnobs& knobs;
  const CameraState& camera;
  RandomStream stream;  ///< of this effect and camera
  const AttitudeSeries& attitude;
};

/// Whether a pixel's result does not depend on other pixels, so that the effect may be applied strip by strip.
constexpr bool is_local(const EffectSpec& spec) {
  return spec.halo_px == 0;
}

/// What an effect may look at when it draws or collects what is fixed for a camera.
struct PrepareContext {
  const Scene& scene;
  const PlanKnobs& knobs;
  RandomStream stream;  ///< of this effect and camera
  const AttitudeSeries& attitude;
};

/// One physical effect.
class Effect {
 public:
  Effect() = default;
  Effect(const Effect&) = delete;
  Effect& operator=(const Effect&) = delete;
  Effect(Effect&&) = delete;
  Effect& operator=(Effect&&) = delete;
  virtual ~Effect() = default;

  [[nodiscard]] virtual const EffectSpec& spec() const = 0;
  /// Decides from full-frame numbers of the scene, so windows and variants of one scene share the decision.
  [[nodiscard]] virtual EffectNeed is_needed(const SceneSummary& scene) const = 0;
  /// Enters what it does to the slow conditions at a time since the start. The default does nothing.
  virtual void set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const;
  /// Draws what is fixed for a camera (scope `static`). The default has nothing to draw.
  virtual void prepare(CameraState& camera, const PrepareContext& context) const;
  /// Replaces regions of pixels after this effect by those before it on which they depend, so that what is computed
  /// for a window is what the full frame has. The default grows each by `halo_px` (kWholeColumn: to whole columns).
  virtual void support(const Scene& scene, std::vector<Rectangle>& regions) const;
  /// Changes the pixels of one strip of an exposure, which is all of its pixel set where the effect is not local.
  /// @thread safe for different states.
  virtual void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const = 0;
};

}  // namespace astroid
