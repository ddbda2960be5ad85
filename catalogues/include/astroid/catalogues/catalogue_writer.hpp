// Writes star catalogues as CSV.
#pragma once

#include <filesystem>

#include "astroid/catalogues/star_catalogue.hpp"

namespace astroid {

/// Writes id,ra,dec,mag (or x,y for pixels, electrons for counts), and colour and teff where some star has them, below
/// comment lines with the source, the passband and the notes. read_catalogue() gives the same stars back, bit for bit.
/// @throws EnvironmentError(path, cause)
void write_catalogue_csv(const std::filesystem::path& path, const StarCatalogue& catalogue);

}  // namespace astroid
