// From the configuration to the stars of the scene.
#pragma once

#include <filesystem>
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

/// The truth table of a scene: every star that can put light on the detector.
std::vector<TruthStar> truth_of(const Scene& scene);

/// Writes truth/stars.csv.
void write_truth(const std::filesystem::path& path, const Scene& scene);

/// What the ground believes of a scene: here, the truth.
std::vector<FieldStar> field_stars(const Scene& scene);

}  // namespace astroid
