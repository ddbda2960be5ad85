// Linear flux estimators: built once from what the ground believes, applied to every exposure as a gather.
//
//   flux = sum_i weight_i * (counts_i - bias) * gain - offset          [e- per exposure]
//
// Aperture, binary mask, weighted mask, PSF weights and local background are all of this form, so their noise is known
// exactly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/noise.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/readout_nodes.hpp"

namespace astroid {

namespace detail {
struct InterleavedFrames;
struct BatchTerms;
}  // namespace detail

/// What can be wrong with one measured flux; bits, each named in docs/flags.md and decoded in the report.
namespace measurement_flag {
inline constexpr std::uint32_t kEdge = 1U << 0;       ///< the aperture is cut by the edge of the frame or window
inline constexpr std::uint32_t kSaturated = 1U << 1;  ///< a pixel of the aperture is at full well or clipped by the ADC
inline constexpr std::uint32_t kBadPixel = 1U << 2;   ///< a pixel of the aperture is defective or not finite
inline constexpr std::uint32_t kContaminated = 1U << 3;  ///< neighbours give more than the configured share of the flux
inline constexpr std::uint32_t kNoBackground = 1U << 4;  ///< too few background pixels: the fallback was used
inline constexpr std::uint32_t kOutside = 1U << 5;       ///< the star is not on the frame: flux is NaN
inline constexpr std::uint32_t kNoFlux = 1U << 6;        ///< no pixel with light of the target: flux is NaN
inline constexpr std::uint32_t kSpoiltBackground = 1U << 7;  ///< background pixels are saturated or bloomed on
inline constexpr std::uint32_t kBlended = 1U << 8;     ///< PSF weights can't tell the star from its neighbours well
inline constexpr std::uint32_t kMerged = 1U << 9;      ///< two stars that cannot be told apart are measured as one
inline constexpr std::uint32_t kUnsettled = 1U << 10;  ///< the fit did not converge, or ran away: flux may be wrong
inline constexpr std::uint32_t kOutlier = 1U << 11;    ///< pixels near the star were left out of the fit
}  // namespace measurement_flag

/// A star as the ground believes it to be.
struct FieldStar {
  std::string id;
  PixelPosition position;
  double electrons = 0.0;  ///< per exposure, all of the PSF
};

/// Light that is smeared along columns while they are read, as the ground believes it, and what is done about it.
struct ColumnSmearing {
  int first_column = 0;
  std::vector<double> electrons;  ///< e- per pixel and exposure, of first_column and those after it; empty: none
  std::vector<double> upper;  ///< the same in rows from `upper_row` on, where these are read upwards; empty: as below
  int upper_row = 0;
  /// Overscan rows whose mean is subtracted from every pixel of their column; 0: what is smeared stays in the flux.
  int overscan_rows = 0;
  [[nodiscard]] bool is_upper(int row) const { return !upper.empty() && row >= upper_row; }
  [[nodiscard]] double at(int column, int row) const {
    const std::vector<double>& columns = is_upper(row) ? upper : electrons;
    const auto i = static_cast<std::int64_t>(column) - first_column;
    return i >= 0 && i < std::ssize(columns) ? columns[static_cast<std::size_t>(i)] : 0.0;
  }
};

/// Everything the ground believes when it builds estimators.
struct GroundModel {
  std::span<const FieldStar> stars;      ///< targets and every contaminant
  std::span<const std::size_t> targets;  ///< indices into `stars`, in the order of the results
  const PixelPsf* psf = nullptr;
  PixelNoise noise;                       ///< background is the expected sky + dark, e- per pixel and exposure
  std::span<const double> backgrounds{};  ///< the same at each target, where it is not the same everywhere; or empty
  Gain gain{1.0};
  Adu bias;
  double accuracy = 1e-6;  ///< of the faintest target's flux: what the cut-off wing of one neighbour may add
  /// e-, of the faintest target of the whole detector, so that estimators are the same for any part of it; 0: of
  /// `targets`
  double faintest_electrons = 0.0;
  double contamination_limit = 1e-3;  ///< share of neighbours in the flux above which kContaminated is set
  /// Relative error that the believed flux of any other star may have: 0.05 mag, the quality of a good catalogue.
  double flux_doubt = 0.05;
  /// px², of all stars together, against which PSF weights guard as against noise of one exposure; motion that averages
  /// out more slowly than pixel noise is to be given larger by that much. 0: the weights are those of stars at rest.
  MotionCovariance motion;
  ColumnSmearing smearing;
  double bias_variance = 0.0;        ///< e-², of the bias level where it is measured in each exposure; 0: it is known
  double row_offset_variance = 0.0;  ///< e-², of an offset that each row has in each exposure
  /// Amplitude, e-, and frequencies, cycles per pixel, of a wave over the detector of another phase in each exposure
  /// (F104). What of it is in measured levels of bias and smearing is left out.
  double pick_up = 0.0;
  double pick_up_column_frequency = 0.0;
  double pick_up_row_frequency = 0.0;
  bool bias_is_measured = false;  ///< in each exposure, so that its drift does not matter
  /// Which pixel is read through which node, and what the readout noise of each has more than `noise`, e-².
  ReadoutNodes nodes{{}, 1};
  std::array<double, kMostNodes> more_readout_variance{};
};

/// Expected electrons and variance (e-, e-²) of one estimator in one exposure, cause by cause.
struct EstimatorBudget {
  double target = 0.0;        ///< weighted electrons of the target
  double contaminants = 0.0;  ///< weighted electrons of all other stars that are in the flux
  double var_target = 0.0;    ///< photon noise of the target
  double var_contaminants = 0.0;
  double var_background = 0.0;  ///< photon noise of sky and dark under the aperture
  double var_readout = 0.0;
  double var_quantisation = 0.0;
  double var_background_estimate = 0.0;  ///< noise of the local background, 0 if it is known
  /// Of an error of the flux that is the same in every exposure, so no part of variance(): the neighbours' light that
  /// PSF weights take out may be wrong by GroundModel::flux_doubt. 0 for methods that leave it in the flux. Reported as
  /// delta_neighbours_rms of targets.csv.
  double var_neighbour_doubt = 0.0;
  double smearing = 0.0;                 ///< weighted electrons that are smeared into the flux and stay there
  double var_smearing = 0.0;             ///< photon noise of what is smeared into the pixels, corrected or not
  double var_smearing_correction = 0.0;  ///< of the column levels that are subtracted: the same for all rows
  double var_bias = 0.0;     ///< of a bias that is measured in each exposure, of offsets of rows and of pick-up
  double bias_weight = 0.0;  ///< change of the flux, e-, with a bias higher by 1 e- than believed
  [[nodiscard]] double variance() const {
    return var_target + var_contaminants + var_background + var_readout + var_quantisation + var_background_estimate +
           var_smearing + var_smearing_correction + var_bias;
  }
};

/// One term of an estimator: a pixel in the frame's buffer and its weight.
struct EstimatorTerm {
  std::uint32_t pixel = 0;
  float weight = 0.0F;
};

/// The estimator of one target and what is known of it beforehand.
///
/// Weights by method: an aperture's are the exact overlaps of the pixels with the circle; a mask's are 1; the weighted
/// mask's are target / variance, normalised so that an isolated star gives all its flux (sum w p = 1). PSF weights are
/// those of generalised least squares (F48), sum w p = 1; where a neighbour is, they are negative.
/// Background pixels share one weight, -(sum of aperture weights) / n_B.
struct StarEstimator {
  std::size_t star = 0;              ///< index into GroundModel::stars
  std::size_t region = 0;            ///< of the layout
  Rectangle window;                  ///< where the mask could grow
  std::vector<EstimatorTerm> terms;  ///< aperture pixels first
  std::size_t aperture_terms = 0;    ///< the rest are background pixels
  /// e-: known background under the aperture, or minus the stars' light in a local one; with PSF weights also what is
  /// believed to be left of the neighbours.
  double offset = 0.0;
  double known_background = 0.0;   ///< e-, the offset that holds where background pixels are spoilt
  int mask_pixels = 0;             ///< pixels with weight in the aperture
  double enclosed_fraction = 0.0;  ///< weighted fraction of the target's flux, sum w p
  double spr_total = 0.0;          ///< F20: contaminants / all stars, sky excluded
  double nsr_exposure = 0.0;       ///< sqrt(variance) / target, one exposure, one camera (F7 where background is known)
  double gradient_x = 0.0;         ///< d ln F / dx of target and contaminants moving together, 1/px
  double gradient_y = 0.0;
  /// sqrt(sum (w dI/dx)²) / sum w I of the target, 1/px (F27). With PSF weights, which use the pixels of neighbours
  /// too, the sums of squares here and below are of the light of all stars.
  double prnu_gradient_x = 0.0;
  double prnu_gradient_y = 0.0;
  double prnu_static = 0.0;  ///< sqrt(sum (w p)²) / sum w p (F28)
  EstimatorBudget budget;
  std::uint32_t flags = 0;  ///< measurement_flag bits that hold for every exposure
};

/// Growth of sigma beyond which a star is blended: two equally bright stars half a FWHM apart. @source F42
inline constexpr double kBlendInflation = 1.4142135623730951;
/// Share of the flux that may hang on the believed fluxes of neighbours before a star is blended: 0.01 mag.
inline constexpr double kBlendDoubt = 0.01;

/// Where the mask of a star may grow: `size` × `size` pixels from floor(x) - size/2 + 1 for an even size (for 6:
/// floor(x) - 2), around the pixel that holds the star for an odd one.
[[nodiscard]] Rectangle mask_window(PixelPosition star, int size);

/// Builds the estimator of every target.
///
/// Neighbours enter with the light they shed on the target's pixels, whether or not they are on the frame. A local
/// background is the mean of annulus pixels; the star light they are believed to carry is taken out through `offset`.
/// The pixels are the darkest ones, as many as make the error of the mean smallest if that belief is wrong by
/// GroundModel::flux_doubt. With fewer than 12, or an error above half a sigma of a pixel, the known background is used
/// and kNoBackground set. With a mesh the frames come with their background subtracted (background.hpp), and the
/// estimators have no background term. A target whose centre is not on a pixel of the layout is kOutside; one without
/// expected light is kNoFlux; both have no terms. Among several regions the one with most of the aperture is read.
///
/// PSF weights treat the neighbours' fluxes as known to flux_doubt, the local background to its error and the positions
/// to GroundModel::motion; what they leave of the believed light is taken out, so that the flux is the target's alone.
/// kBlended is set when the noise with the neighbours' doubt exceeds kBlendInflation times that with known neighbours,
/// or the doubt kBlendDoubt of the flux.
///
/// @param layout  pixels that the frames will have.
/// @throws InputError when the settings contradict themselves or the layout.
/// @complexity  O(targets × neighbours × window); 32,240 stars in 480×480 px: see BM_BuildEstimators.
/// @source Marchiori2019 §4.6.3; F7, F9, F20, F27, F28, F48.
std::vector<StarEstimator> build_estimators(const PixelLayout& layout, const GroundModel& model,
                                            const PhotometrySettings& settings);

/// The estimators of a set of targets as contiguous arrays, ready to be applied.
class EstimatorSet {
 public:
  /// @throws BugError when the background pixels of an estimator differ in weight.
  EstimatorSet(std::span<const StarEstimator> estimators, Gain gain, Adu bias);
  [[nodiscard]] std::size_t size() const { return targets_.size(); }

  /// Measures all targets on one frame, in time proportional to the number of terms and without allocating.
  ///
  /// A saturated or bad pixel in the aperture sets its flag; the flux is what the pixels say, NaN if one is not finite.
  /// Background pixels that are saturated, bad or not finite are left out; with fewer than half of them left the known
  /// background is used and kNoBackground set.
  /// @param frame  over the layout the estimators were built for.
  /// @param flux   [out] shape (size()), e- per exposure; NaN where it cannot be measured.
  /// @param flags  [out] shape (size()), measurement_flag bits.
  /// @rng none  @thread safe  @accuracy same bits on every processor; 1e-13 relative against the naive sum
  void apply(const Frame& frame, std::span<double> flux, std::span<std::uint32_t> flags) const;

  /// The most frames that can be measured in one go.
  static constexpr std::size_t kMaxBatch = 16;

  /// Memory that a worker lends to apply_batch(); what it holds between calls means nothing.
  class BatchScratch {
   private:
    friend class EstimatorSet;
    struct alignas(64) Line {  // of a cache
      std::array<float, kMaxBatch> counts;
    };
    std::vector<Line> interleaved;
    std::vector<std::uint8_t> any_flag;  // of each pixel, in any frame
    std::vector<std::uint8_t> varying;   // flags that a pixel has in some frames only
    std::vector<std::uint32_t> good;     // pixels of a background
  };

  /// Called with the index of a target and its flux and flags in each frame.
  using TakeFluxes =
      std::function<void(std::size_t target, std::span<const double> flux, std::span<const std::uint32_t> flags)>;

  /// Measures all targets on several frames at once, several times faster than one by one.
  ///
  /// The frames are interleaved, frame by frame within a pixel, just ahead of the targets that read them, so a term is
  /// one load for all frames. Where a pixel's flags differ among the frames, or it is not finite, the target is
  /// measured frame by frame.
  /// @param frames  1 … kMaxBatch, over the layout the estimators were built for.
  /// @param take    called once for every target, in the order of their pixels.
  /// @rng none  @thread safe, each with its own scratch
  /// @accuracy    the bits of apply() (test: EstimatorBatch.HasTheBitsOfSingleFrames)
  /// @complexity  O(terms × frames), O(1) in the frames' size but for their flags  (bench: BM_ApplyBatch)
  void apply_batch(std::span<const Frame> frames, BatchScratch& scratch, const TakeFluxes& take) const;

 private:
  struct Measured {
    double flux;
    std::uint32_t flags;
  };
  struct Target {
    std::size_t index = 0;           // in the order of the results
    std::size_t aperture_begin = 0;  // in aperture_pixel_ and aperture_weight_
    std::size_t aperture_end = 0;
    std::size_t background_begin = 0;  // in background_pixel_
    std::size_t background_end = 0;
    std::size_t pixel_end = 0;  // one past the last pixel of this target and those before it
    double weight_sum = 0.0;    // of the aperture
    double offset = 0.0;
    double known_background = 0.0;
    std::uint32_t flags = 0;
  };
  void apply_one_by_one(std::span<const Frame> frames, const TakeFluxes& take) const;
  void find_stretch();
  [[nodiscard]] std::span<const std::uint32_t> aperture_of(const Target& target) const {
    return std::span(aperture_pixel_).subspan(target.aperture_begin, target.aperture_end - target.aperture_begin);
  }
  [[nodiscard]] std::span<const std::uint32_t> background_of(const Target& target) const {
    return std::span(background_pixel_)
        .subspan(target.background_begin, target.background_end - target.background_begin);
  }
  // `flagged` may be true when the frame has no flagged pixel; false saves looking.
  [[nodiscard]] Measured measure(const Frame& frame, bool flagged, const Target& target) const;
  // A target with flagged pixels, if all frames have the same; `finite`: `flux` holds sums over all of its pixels.
  // Returns whether flux and flags hold now.
  bool measure_spoilt(const detail::InterleavedFrames& frames, const detail::BatchTerms& terms, bool finite,
                      BatchScratch& scratch, std::span<double, kMaxBatch> flux,
                      std::span<std::uint32_t, kMaxBatch> flags) const;
  [[nodiscard]] double background_without_spoilt(const Frame& frame, const Target& target, std::uint32_t& flags) const;

  std::vector<Target> targets_;  // in the order of their pixels, so that neighbours share cache lines
  std::vector<std::uint32_t> aperture_pixel_;
  std::vector<float> aperture_weight_;
  std::vector<std::uint32_t> background_pixel_;
  std::size_t stretch_ = 0;  // pixels that a batch holds interleaved at a time: a power of two
  double gain_;
  double bias_;
};

}  // namespace astroid
