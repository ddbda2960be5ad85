// Which column of a catalogue means what.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
#include "catalogue_table.hpp"
#include "problem_list.hpp"

namespace astroid {

struct CatalogueColumns {
  std::optional<std::size_t> id;
  std::optional<std::size_t> first;       ///< ra or x
  std::optional<std::size_t> second;      ///< dec or y
  std::optional<std::size_t> brightness;  ///< magnitude or electrons
  std::optional<std::size_t> colour;      ///< the colour, or its blue magnitude when colour_red is there
  std::optional<std::size_t> colour_red;
  std::optional<std::size_t> teff;
  std::optional<std::size_t> pm_ra;  ///< both proper motions, or none
  std::optional<std::size_t> pm_dec;
  std::optional<std::size_t> epoch;
  PositionKind positions = PositionKind::kSky;
  BrightnessKind kind = BrightnessKind::kMagnitude;
  std::string passband;
  std::string colour_index;
  std::vector<std::string> notes;
};

/// Adds a problem for every column that is missing or contradicts what the user stated.
[[nodiscard]] CatalogueColumns find_columns(const CatalogueTable& table, const CatalogueOptions& options,
                                            ProblemList& problems);

}  // namespace astroid
