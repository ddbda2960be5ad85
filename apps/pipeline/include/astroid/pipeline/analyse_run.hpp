// Analysis after the fact: of a finished run, or of fluxes and truth from anywhere.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

/// Reads the light curves of a finished run again and writes analysis/ and report/ anew.
///
/// @param folder     of the run: config.xml and photometry/lightcurves.fits are read.
/// @param overrides  parameters to change, such as Analysis/Bin; those that would change the exposures are refused.
/// @param output     where the results go; the run's own folder to replace its report.
/// @throws InputError when the folder is no finished run with light curves; EnvironmentError.
AssessResult analyse_run(const std::filesystem::path& folder, const ConfigurationSurroundings& overrides,
                         const std::filesystem::path& output);

/// What a comparison of fluxes and truth found.
struct TableComparison {
  std::size_t truth = 0, sources = 0, matched = 0;
  double bias_mmag = 0.0, bias_error_mmag = 0.0;
  double pull_width = 0.0;  ///< rms of (measured - true) / stated error
  std::vector<std::string> notes;
};

/// Compares a table of fluxes with a truth table and writes matched.csv and magnitude_recovery.csv into `output`.
///
/// Stars are matched by id where both tables have the ids, else one to one by position within a pixel, brightest first.
/// @throws InputError with every problem of the tables.
TableComparison compare_tables(const std::filesystem::path& truth, const std::filesystem::path& sources,
                               const std::filesystem::path& output);

/// Writes single stars of a run as light-curve files that lightkurve opens. @returns the files written
std::vector<std::filesystem::path> export_stars(const std::filesystem::path& folder, std::span<const std::string> ids,
                                                const std::filesystem::path& output);

}  // namespace astroid
