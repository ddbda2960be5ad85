// CFITSIO's habits, in one place: its lock where it was built without one, and its words.
#pragma once

#include <fitsio.h>

#include <cerrno>
#include <mutex>
#include <string>
#include <system_error>

namespace astroid {

/// Held during every call of CFITSIO. Debian's library is built reentrant, so that different files may be used by
/// different threads at the same time; then this costs nothing. With one that is not, all calls take turns.
class CfitsioLock {
 public:
  CfitsioLock() {
    if (fits_is_reentrant() == 0) lock_ = std::unique_lock(mutex());
  }

 private:
  static std::recursive_mutex& mutex() {
    static std::recursive_mutex the_mutex;
    return the_mutex;
  }
  std::unique_lock<std::recursive_mutex> lock_;
};

/// CFITSIO's words for a status, with the operating system's cause if there is one.
inline std::string cfitsio_message(int status, int error_number) {
  std::string text(FLEN_STATUS, '\0');
  fits_get_errstatus(status, text.data());
  fits_clear_errmsg();
  text.resize(text.find('\0'));
  if (error_number != 0) text += " (" + std::generic_category().message(error_number) + ")";
  return text;
}

}  // namespace astroid
