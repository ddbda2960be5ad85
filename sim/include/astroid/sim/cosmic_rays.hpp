// Cosmic rays: particles that leave a track of charge in the detector.
#pragma once

#include <cstdint>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/random.hpp"

namespace astroid {

/// Side of the detector tiles that hits are drawn by, px. Part of the address of every hit: never changed.
inline constexpr int kCosmicTile = 32;

/// Particles of one exposure, in pixels and electrons.
struct CosmicRayModel {
  double hits_per_pixel = 0.0;  ///< mean number of tracks that begin in a pixel in one exposure
  bool is_slab = false;         ///< particles cross a slab of silicon; else trails of given length and charge

  // Trails (Jannsen2024): length uniform up to `longest_track`, charge skew-normal.
  double charge_location = 0.0;  ///< e-
  double charge_scale = 0.0;     ///< e-
  double charge_shape = 0.0;

  // Slab: isotropic flux, so the cosine to the normal has density 2 cos; charge along the path.
  double thickness = 1.0;           ///< px
  double electrons_per_path = 0.0;  ///< most probable, e-/px of path
  double fluctuation = 0.0;         ///< Moyal width relative to the most probable charge

  double longest_track = 0.0;  ///< px on the detector; of the slab, longer ones are not drawn
};

/// One particle.
struct CosmicRay {
  PixelPosition entry;     ///< px
  PixelShift track;        ///< from where it enters to where it leaves, px
  double electrons = 0.0;  ///< along the track, uniformly
};

/// When particles are counted: in an exposure, or between two non-destructive reads of it.
struct CosmicTime {
  std::uint32_t exposure = 0;
  std::uint16_t read = 0;
};

/// Mean and variance of the charge of one particle.
struct CosmicCharge {
  double mean = 0.0;      ///< e-
  double variance = 0.0;  ///< e-²
};
/// @accuracy  of the distribution before it is cut at zero (less than 1e-6 of it for the default).
CosmicCharge charge_of(const CosmicRayModel& model);

/// How far from where a particle enters its charge may be, px.
int reach_of(const CosmicRayModel& model);

/// The particles that enter in one tile of the detector: columns kCosmicTile * tile_x and following. Their number is
/// Poisson distributed with mean hits_per_pixel * kCosmicTile². Tiles before the first pixel and behind the last exist.
/// @rng  counter {tile_x, tile_y, exposure, read << 16 | draw}: draw 0 for the number, 1 + 2k for entry, direction and
///       length of the k-th, 2 + 2k for its charge (docs/random-numbers.md).
/// @valid  means of up to 20000 particles in a tile.
std::vector<CosmicRay> cosmic_rays_of_tile(const CosmicRayModel& model, const RandomStream& stream, int tile_x,
                                           int tile_y, CosmicTime time);

/// Leaves the charge of one particle along its track, each pixel getting the part of the track within it.
/// @param flags  [in,out] gains pixel_flag::kCosmicRay where charge was left.  @returns electrons left in the image.
/// @accuracy parts relative 1e-13, their sum 1e-15 (test: CosmicRays.LeaveEachPixelItsPartOfTheTrack).
double leave_track(const CosmicRay& ray, const ImageView<double, unit::SampledElectrons>& electrons,
                   const ImageView<std::uint8_t, unit::Flags>* flags = nullptr);

/// Adds the charge of every particle whose track meets an image, each pixel by its exact part of the track.
///
/// Every part of the detector gets the bits of the whole: a particle belongs to its tile, and tiles are gone through in
/// one order.
/// @param flags  [in,out] gains pixel_flag::kCosmicRay where charge was left.
/// @returns      electrons left in the image.
/// @complexity   O(tiles within reach + particles x length) (bench: BM_CosmicRays)  @thread safe
/// @source Jannsen2024; differs: number Poisson, sub-pixel parts exact, every row and column can be hit.
double add_cosmic_rays(const CosmicRayModel& model, const RandomStream& stream, CosmicTime time,
                       const ImageView<double, unit::SampledElectrons>& electrons,
                       const ImageView<std::uint8_t, unit::Flags>* flags = nullptr);

}  // namespace astroid
