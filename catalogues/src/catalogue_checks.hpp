// What makes a catalogue as a whole implausible or ambiguous.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
#include "catalogue_columns.hpp"
#include "catalogue_table.hpp"
#include "problem_list.hpp"

namespace astroid {

/// Radians stated, but a column holds larger values; or degrees stated, but the positions are radians beyond doubt.
///
/// The second is a matter of star density, which radians read as degrees raise by (180/pi)^2 = 3283: reported when at
/// least 100 stars, over at least 0.002 deg^2 and all within |ra| <= 2 pi, |dec| <= pi/2, stand 500 times denser
/// than the mean sky at some magnitude. Fields that are really there pass: the densest globular clusters only reach
/// that among faint stars.
/// @returns whether the unit is plausible
bool check_unit(const CatalogueTable& table, const CatalogueColumns& columns, const CatalogueOptions& options,
                ProblemList& problems);

/// Names stars without an id by a hash of their position; adds a problem for every id, and every unnamed star, that is
/// there twice. `rows` are the stars' rows of the table.
void name_stars(const CatalogueTable& table, const CatalogueColumns& columns, std::span<const std::size_t> rows,
                StarCatalogue& catalogue, ProblemList& problems);

}  // namespace astroid
