// Photometry of single images, anybody's: no model of the field is needed, only positions and, for masks, a PSF.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/fits_card.hpp"
#include "astroid/core/frame.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid {

/// A place to measure: in pixels, or in the sky where the image has coordinates. Pixels win if both are given.
struct SourceRequest {
  std::string id;
  std::optional<PixelPosition> pixel;
  std::optional<SkyPosition> sky;
};

/// One measured source. What cannot be measured is NaN, and `flags` says why.
struct SourceMeasurement {
  std::string id;
  double x = 0.0;  ///< px, 0-based
  double y = 0.0;
  double ra = 0.0;  ///< deg, NaN without coordinates
  double dec = 0.0;
  double flux = 0.0;      ///< e- per exposure
  double flux_err = 0.0;  ///< photon noise of the star, noise of the sky and readout, noise of the background level
  double mag = 0.0;       ///< NaN for flux <= 0
  double mag_err = 0.0;
  double background = 0.0;  ///< e- per pixel above the bias
  double snr = 0.0;
  double chi2 = 0.0;        ///< per degree of freedom, of the PSF alone in the pixels used; NaN without a PSF
  std::uint32_t flags = 0;  ///< measurement_flag bits
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double position_err = kUnknown;  ///< px, along each axis, of stars that were found
  /// By how many magnitudes the star would be brighter with the light of the known neighbours that was taken out of its
  /// flux, or that is in it where nothing is taken out.
  double crowding = kUnknown;
  double sharpness = kUnknown;  ///< share of the flux in its pixel over that of a star, less 1: a cosmic ray is > 0
};

struct ImagePhotometrySettings {
  PhotometryMethod method = PhotometryMethod::kAperture;
  Pixels aperture_radius{3.0};
  int mask_window = 6;
  std::shared_ptr<const PixelPsf> psf;  ///< needed by masks and PSF weights; with it fluxes are those of the whole star
  bool whole_star = true;               ///< divide by the fraction of the PSF that the pixels hold
  BackgroundMethod background = BackgroundMethod::kLocal;
  Adu known_background;  ///< counts per pixel, bias included; for BackgroundMethod::kKnown
  Pixels annulus_inner{5.0};
  Pixels annulus_outer{8.0};
  double annulus_clip = 3.0;  ///< sigma; infinity: the plain median
  MeshSettings mesh;
  std::shared_ptr<const BackgroundMap> map;  ///< instead of one made with `mesh`
  Magnitude zero_point{0.0};                 ///< that gives one detected e-/s; 0: instrumental magnitudes
};

/// Measures every source on region 0 of a frame.
///
/// The level under a star is the clipped median of its annulus, the mesh at its pixel, or the given value; the noise of
/// a pixel is the scatter measured with it, and for a given value its photon, readout and quantisation noise. With
/// fewer than 12 annulus pixels the median of a mesh is used and kNoBackground set. Masks need a flux to begin with:
/// an aperture of `aperture_radius` gives it, to the neighbours as well. PSF weights doubt that of the neighbours by
/// 100 % and put what is left of the doubt into flux_err; stars that are not in `sources` are not known to them.
/// @param frame  with gain, bias, readout noise and exposure time in its header, and flags set (read_frame()).
/// @param sky    coordinates of the image, or nullptr.
/// @throws InputError when the settings contradict themselves, or positions are in the sky and `sky` is nullptr. One
/// bad
///         source never ends the run.
/// @accuracy flux_err has pull width 1.00 ± 0.03 (test: ImagePhotometry.StatesHonestErrors).
/// @source F5, F9; BertinArnouts1996.
std::vector<SourceMeasurement> measure_image(const Frame& frame, const SkyProjection* sky,
                                             std::span<const SourceRequest> sources,
                                             const ImagePhotometrySettings& settings);

/// Writes photometry/sources.csv: id,x,y,ra,dec,flux,flux_err,mag,mag_err,background,snr,chi2,flags, and where any
/// source has them position_err,crowding,sharpness.
/// @throws EnvironmentError when the file cannot be written.
void write_sources(const std::filesystem::path& path, std::span<const SourceMeasurement> sources);

/// The same as a binary table SOURCES of a FITS file, with `cards` and lines of history in its header.
/// @throws EnvironmentError when the file cannot be written.
void write_sources_fits(const std::filesystem::path& path, std::span<const SourceMeasurement> sources,
                        std::span<const FitsCard> cards, std::span<const std::string> history);

/// What the user knows better than the header.
struct FrameReadOptions {
  std::optional<Gain> gain;
  std::optional<Electrons> readout_noise;
  std::optional<Adu> saturation;
  std::optional<Adu> bias;
  std::optional<Seconds> exposure_time;
  int unit = 0;            ///< header-data unit, 1 is the primary; 0: the first image
  std::int64_t plane = 0;  ///< of a cube
  /// Whether what OVERSCAN extensions show is subtracted from the columns of a plain image: light that was smeared
  /// while it was read.
  bool use_overscan = true;
};

/// An image of anybody's as a frame.
struct ImageFile {
  Frame frame;                       ///< one region, from (0, 0)
  std::optional<SkyProjection> sky;  ///< coordinates, where the header has usable ones
  std::vector<std::string> notes;    ///< what had to be assumed, one sentence each, for the user
  bool gain_assumed = false;         ///< neither the header nor the options say it
};

/// Reads an image and the keywords that photometry needs.
///
/// Gain: EGAIN, GAIN, CCDGAIN, ATODGAIN, GAINEFF, GAIN1, else 1 e-/ADU; an image with BUNIT of electrons has gain 1,
/// one of electrons per second its exposure time. Readout noise (e-): RDNOISE, READNOIS, RON, READNOISE, RDNOISE1,
/// RDNOIS1, else 0. Exposure time (s): EXPTIME, EXPOSURE, ITIME, INT_TIME, else 1. Saturation (ADU): SATURATE,
/// SATLEVEL, else the largest number of an integer image. Bias (ADU), on top of which light and its noise are: the mean
/// of PRESCAN extensions, else BIAS where its comment gives the unit [adu], else 0. Pixels that are not finite get
/// pixel_flag::kBad, those at or above the saturation kAdcSaturated.
/// @throws InputError naming the file and what is wrong; EnvironmentError when it cannot be read.
ImageFile read_frame(const std::filesystem::path& path, const FrameReadOptions& options = {});

}  // namespace astroid
