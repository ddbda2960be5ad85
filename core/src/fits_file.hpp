// An open FITS file and what is known of its units: the part of FitsReader that images and tables share.
#pragma once

#include <cerrno>
#include <cstdint>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/fits_reader.hpp"
#include "cfitsio_call.hpp"

namespace astroid {

struct FitsReader::State {
  std::string path;
  fitsfile* file = nullptr;
  std::vector<FitsUnit> units{};

  explicit State(const std::string& p) : path(p) {}
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  State(State&&) = delete;
  State& operator=(State&&) = delete;

  [[nodiscard]] InputError refuse(const std::string& message, const std::string& expected) const {
    return InputError(Problem{.file = path, .expected = expected, .message = message});
  }
  /// "unit 2 (an image of 3 x 4 px)"
  [[nodiscard]] std::string unit_text(int unit) const;

  /// Makes a unit current; checks that it exists, is of the kind, and that the file is large enough to hold it.
  const FitsUnit& go_to(int unit, FitsUnit::Kind kind) const;
  void go_to(int unit) const;

  /// @throws InputError unless the table has these rows.
  void check_rows(int unit, std::int64_t first, std::int64_t count) const;

  /// Runs a CFITSIO function on the file and returns its status.
  template <class Function, class... Arguments>
  int attempt(Function function, Arguments... arguments) const {
    const CfitsioLock lock;
    int status = 0;
    errno = 0;
    function(file, arguments..., &status);
    if (status != 0) fits_clear_errmsg();
    return status;
  }
  /// The same, and turns failure into an InputError: a file that could be opened but not read is damaged.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const {
    const int status = attempt(function, arguments...);
    if (status != 0) throw refuse("cannot be read: " + cfitsio_message(status, 0), "a complete FITS file");
  }
};

}  // namespace astroid
