// Series of images, each a FITS file of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/fits_card.hpp"
#include "astroid/core/fits_writer.hpp"

namespace astroid {

/// Writes two-dimensional images of one shape, whose headers differ in the values of some cards.
///
/// The files are FitsWriter's to the byte and take a fraction of its time: CFITSIO makes the header once, in memory;
/// counts are converted and summed piece by piece on their way to the disk, each read once.
class FitsImageSeries {
 public:
  /// @param number   kUnsigned16 or kInt32.
  /// @param cards    of the header behind its shape, those that change too, with any value.
  /// @param history  HISTORY lines, behind the cards.
  FitsImageSeries(FitsNumber number, int nx, int ny, std::span<const FitsCard> cards,
                  std::span<const std::string> history);

  /// Writes one image in one go: complete under its name, or absent.
  /// @param counts   nx * ny values, rows from the first on; whole numbers in the range of the format (BugError).
  /// @param changed  cards that take new values; they are in the header and fit on one line (BugError).
  /// @throws EnvironmentError(path, cause), a full disk included; nothing is left.
  /// @accuracy exact (test: FitsImageSeriesWriting.IsTheWritersToTheByte).  @thread safe: different files in different
  /// threads.
  /// @complexity O(nx * ny)  (bench: BM_WriteImage).
  void write(const std::filesystem::path& path, std::span<const float> counts, std::span<const FitsCard> changed,
             Durability durability) const;

 private:
  FitsNumber number_;
  std::size_t pixels_;
  std::string header_;  // whole blocks
};

}  // namespace astroid
