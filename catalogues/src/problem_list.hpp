// Problems of one file, collected; the first ones in full, the rest as a number.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {

class ProblemList {
 public:
  explicit ProblemList(std::string file, std::size_t most) : file_(std::move(file)), most_(most) {}
  void add(Problem problem);
  [[nodiscard]] bool empty() const { return problems_.empty(); }
  /// Throws InputError when there are problems; the last of them is then "… and N more problems" if some were only
  /// counted.
  void throw_if_any() const;

 private:
  std::string file_;
  std::size_t most_;
  std::size_t more_ = 0;
  std::vector<Problem> problems_;
};

}  // namespace astroid
