// Detection and fit of a whole field: find, fit all together, subtract, find again in what is left.
#pragma once

#include <cstddef>
#include <vector>

#include "field/field_solver.hpp"
#include "field/local_fit.hpp"
#include "field/matched_filter.hpp"

namespace astroid::detail {

struct FieldFitSettings {
  double threshold = 5.0;  ///< least flux of a star in units of its error, neighbours free
  int rounds = 10;         ///< of detection at most
  int sky_cell = 64;       ///< px
  double psf_doubt =
      0.0;  ///< share of a star's light in a pixel that the PSF may be wrong by: fainter than this is no star
  bool companions = true;  ///< whether stars are looked for that hide within a FWHM of another
};

/// The loop. Fluxes, positions and sky are those of all stars fitted at once.
class FieldFit {
 public:
  FieldFit(const PixelPsf& psf, const PsfReach& reach, const FieldPixels& pixels, const FieldFitSettings& settings);

  void run();
  [[nodiscard]] FieldSolver& solver() { return solver_; }
  [[nodiscard]] const MatchedFilter& filter() const { return filter_; }

 private:
  void iterate(int steps, double tolerance, std::size_t enough = 0);
  std::size_t prune();
  std::size_t add_from_residuals();
  std::size_t add_companions();
  bool accept(const Peak& peak);
  [[nodiscard]] bool may_be_psf_error(const Peak& peak) const;
  [[nodiscard]] bool was_refused(const Peak& peak) const;

  const FieldFitSettings& settings_;
  const PsfReach& reach_;
  FieldSolver solver_;
  MatchedFilter filter_;
  LocalFit local_;
  std::vector<Peak> accepted_;
  std::vector<Peak> refused_;  // those that the fit with all others found too faint
};

}  // namespace astroid::detail
