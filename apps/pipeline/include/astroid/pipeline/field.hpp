// From the configuration to the stars of the scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "astroid/analysis/truth.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Reads the catalogue (and the background catalogue) of a mission and converts it to the zero point's passband.
/// @throws InputError with every problem of a file; EnvironmentError.
StarCatalogue load_field(const Mission& mission);

/// The truth table of a scene: every star that can put light on the detector, variable ones with the mean of the run.
std::vector<TruthStar> truth_of(const Scene& scene);

/// Writes truth/stars.csv.
void write_truth(const std::filesystem::path& path, const Scene& scene);

/// Writes, where stars vary, variables.csv (id, place, electrons at relative flux 1, mean relative flux of the run,
/// model) and variability.csv (time in s since the start, then each star's relative flux averaged over the exposure).
/// @param suffix  of both names, before ".csv".
void write_variable_truth(const std::filesystem::path& folder, const Scene& scene, const std::string& suffix = "");

/// What the ground believes of a scene: here, the truth.
std::vector<FieldStar> field_stars(const Scene& scene);

}  // namespace astroid
