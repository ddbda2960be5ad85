#include "problem_list.hpp"

#include <fmt/format.h>

#include <utility>

namespace astroid {

void ProblemList::add(Problem problem) {
  if (problems_.size() < most_) {
    problems_.push_back(std::move(problem));
  } else {
    ++more_;
  }
}

void ProblemList::throw_if_any() const {
  if (problems_.empty() && more_ == 0) return;
  std::vector<Problem> problems = problems_;
  if (more_ > 0) {
    Problem rest;
    rest.file = file_;
    rest.message = fmt::format("… and {} more problem{}", more_, more_ == 1 ? "" : "s");
    problems.push_back(std::move(rest));
  }
  throw InputError(std::move(problems));
}

}  // namespace astroid
