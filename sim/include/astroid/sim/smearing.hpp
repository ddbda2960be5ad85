// Smearing: light that falls on charge while it is clocked through the columns of a detector without a shutter.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/readout_nodes.hpp"
#include "astroid/core/units.hpp"
#include "astroid/sim/attitude.hpp"

namespace astroid {

class Scene;

/// How the columns of a scene are read.
ReadoutNodes readout_nodes(const Scene& scene);

/// What is smeared into the pixels of some columns, from all stars of the catalogue on all rows of the detector that
/// are read in the same direction, not from the pixels that happen to be computed.
///
/// Stars stand at their nominal places and change to first order with the attitude: the next order is (motion / PSF
/// width)² of what is smeared. Flat field and breathing of the PSF average out along a column and are not in it.
class SmearedColumns {
 public:
  /// @param first, columns  of which columns; those beside the detector stay dark.
  /// @param half  of the rows (ReadoutNodes::half).
  SmearedColumns(const Scene& scene, int first, int columns, int half = 0);

  /// e- per pixel and exposure of columns x0 … x0 + row.size() - 1 at an attitude.
  /// @param throughput  of the optics, relative to the start of the run.
  void at(const Attitude& attitude, double throughput, int x0, std::span<double> row) const;

  [[nodiscard]] int first() const { return first_; }

 private:
  int first_;
  std::vector<double> electrons_;                    // e- per pixel and exposure
  std::array<std::vector<double>, 3> per_arcsec_{};  // its change with yaw, pitch, roll
};

/// What frame transfer smears into the pixels of a layout less than into overscan rows, where the transfer before the
/// exposure takes another time than the one after it: then a row has not seen as much of the stars behind it, farther
/// from the register, as of those before it. Empty where both take the same time.
/// @returns  e- per pixel and exposure at the nominal attitude.
Plane<float, unit::ExpectedElectrons> missing_from_behind(const Scene& scene,
                                                          const std::shared_ptr<const PixelLayout>& layout);

/// e- per pixel and exposure that are smeared into each column of the detector at the nominal attitude; empty without
/// smearing. @param half  of the rows (ReadoutNodes::half).
std::vector<double> smeared_electrons(const Scene& scene, int half = 0);

/// Upper bound of the light of any column, e- per exposure: stars within a few columns of each other and the sky.
double brightest_column_bound(const Scene& scene);

}  // namespace astroid
