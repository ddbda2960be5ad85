// The four kinds of failure and their exit codes. Libraries throw these; only the program prints and exits.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace astroid {

enum class ExitCode : int {
  kSuccess = 0,
  kInput = 2,        ///< the user's configuration, catalogue or image is wrong
  kEnvironment = 3,  ///< disk, permissions, FITS I/O
  kBug = 70,         ///< a broken invariant of ours
};

/// One thing that is wrong with the user's input. Fields that do not apply are empty (line: 0).
struct Problem {
  std::string file{};
  long line = 0;
  std::string parameter{};   ///< "CCD/ReadoutNoise", "column ra"
  std::string value{};       ///< as written
  std::string expected{};    ///< what would be right, with unit and range
  std::string message{};     ///< one sentence
  std::string suggestion{};  ///< "did you mean ReadoutNoise?", may be empty

  /// "file:line: parameter = value: message; expected …; did you mean …" with the parts that are there.
  [[nodiscard]] std::string text() const;
};

/// The user's input is wrong: carries every problem found, not only the first. Exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The machine failed us: path and cause. Exit code 3.
class EnvironmentError : public std::runtime_error {
 public:
  EnvironmentError(const std::string& path, const std::string& cause);
};

/// A broken invariant of the program itself. Exit code 70.
class BugError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws BugError with the two values printed unless `a op b` holds; use for invariants, never for user input.
#define ASTROID_CHECK_OP_(a, op, b)                                                                         \
  do {                                                                                                      \
    const auto check_a_ = (a);                                                                              \
    const auto check_b_ = (b);                                                                              \
    if (!(check_a_ op check_b_))                                                                            \
      ::astroid::detail::check_failed(__FILE__, __LINE__, #a " " #op " " #b, static_cast<double>(check_a_), \
                                      static_cast<double>(check_b_));                                       \
  } while (false)
#define ASTROID_CHECK_EQ(a, b) ASTROID_CHECK_OP_(a, ==, b)
#define ASTROID_CHECK_LT(a, b) ASTROID_CHECK_OP_(a, <, b)
#define ASTROID_CHECK_LE(a, b) ASTROID_CHECK_OP_(a, <=, b)

namespace detail {
[[noreturn]] void check_failed(const char* file, int line, const char* expression, double left, double right);
}

}  // namespace astroid
