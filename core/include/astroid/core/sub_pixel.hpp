// The renderer `subpixel`: all stars of a field on a map finer than the pixel, convolved with the PSF in Fourier space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/psf_spectrum.hpp"

namespace astroid {

struct SubPixelSettings {
  double accuracy = 1e-7;    ///< allowed to the flux of a star in any square of pixels, relative to the star's flux
  int sub_pixels = 0;        ///< of the map, per pixel and axis; 0: from the accuracy
  int cells = 1;             ///< per pixel and axis in which the light is wanted: 1, or those of a response
  PixelResponse response{};  ///< the same in every pixel; folded into the PSF. Only where cells is 1
  double memory_bytes = 128.0 * 1024.0 * 1024.0;  ///< of the maps of one worker; smaller tiles where they do not fit
};

/// Light below zero that band-limited convolution leaves far from stars (ringing).
struct NegativeLight {
  std::int64_t pixels = 0;
  double electrons = 0.0;  ///< their sum, <= 0

  void add(const NegativeLight& other) {
    pixels += other.pixels;
    electrons += other.electrons;
  }
};

/// Sets light between -limit and 0 to 0. What is farther below comes from a PSF that is negative itself, and stays.
/// @returns all that was below 0.
NegativeLight silence(std::span<double> light, double limit);

/// Renders tiles of a detector: stars are spread over a map of n sub-pixels per pixel, the map is transformed (FFTW,
/// double precision), multiplied by the PSF, by the pixel's own response and by the correction of the spread, and
/// summed up to pixels.
///
/// A star is never snapped to a sub-pixel: what it leaves on the map is a pure phase ramp in the band that is used,
/// whatever its position. The pixel's integral is a product in Fourier space, so a pixel holds the integral and not a
/// sample of it. The map is padded by the reach of the PSF on all sides: nothing wraps around.
///
/// Tiles are laid out from the detector's first pixel and depend on nothing else, so that a window and the full frame
/// have the same bits. @accuracy  predicted_error(); bits may differ between processors (FFTW).
/// @source MarcosArenal2014 for the method (F100, F101), Beatty2005 and Barnett2019 for the spread.  @complexity
/// (bench: BM_SubPixelFrame)
class SubPixelRenderer {
 public:
  /// @throws InputError when the PSF needs a finer map than 128 sub-pixels, or the smallest tile more than the memory.
  SubPixelRenderer(std::shared_ptr<const PsfSpectrum> psf, Rectangle detector, const SubPixelSettings& settings);
  /// A PSF that varies over the field takes a map for each of its members; the error is that of its blends.
  SubPixelRenderer(FieldSpectrum psf, Rectangle detector, const SubPixelSettings& settings);
  SubPixelRenderer(const SubPixelRenderer&) = delete;
  SubPixelRenderer& operator=(const SubPixelRenderer&) = delete;
  SubPixelRenderer(SubPixelRenderer&&) = delete;
  SubPixelRenderer& operator=(SubPixelRenderer&&) = delete;
  ~SubPixelRenderer();

  /// Maps of one worker.
  class Workspace {
   public:
    Workspace();
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

   private:
    friend class SubPixelRenderer;
    struct Maps;
    std::unique_ptr<Maps> maps_;
  };

  /// Tiles of the detector, row by row.
  [[nodiscard]] std::span<const Rectangle> tiles() const;
  /// How far outside a tile a star still matters, px; the renderer leaves out those farther away.
  [[nodiscard]] double reach() const;

  /// Light of the stars in the pixels of a tile, row by row.
  ///
  /// Stars are added in the order given. Their stamps' half widths mean nothing here; their motion counts as in
  /// PixelPsf::integrate_broadened().
  /// @param light  [out] shape (tile.ny, tile.nx), e-; silence()d to predicted_error() of the brightest star.
  /// @thread safe with a workspace per thread
  NegativeLight render(const Rectangle& tile, std::span<const StarLight> stars, Workspace& workspace,
                       std::span<double> light) const;
  /// The same in cells: shape (tile.ny cells, tile.nx cells), e- per cell; not silenced.
  void render_cells(const Rectangle& tile, std::span<const StarLight> stars, Workspace& workspace,
                    std::span<double> light) const;

  [[nodiscard]] int sub_pixels() const;
  [[nodiscard]] int cells() const;
  [[nodiscard]] double band() const;             ///< highest frequency used along each axis, cycles/px
  [[nodiscard]] double predicted_error() const;  ///< of the settings' accuracy
  [[nodiscard]] double workspace_bytes() const;
  /// Maps of a tile, one after the other: members of the PSF.
  [[nodiscard]] std::size_t maps() const;
  /// Nodes of the map of one tile.
  [[nodiscard]] std::size_t map_size() const;
  [[nodiscard]] std::string description() const;

 private:
  struct Design;
  std::unique_ptr<const Design> design_;
};

}  // namespace astroid
