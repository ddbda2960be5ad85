#include "astroid/core/vector_target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <cstdint>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

/// Of the processor, whatever is forced.
std::vector<std::int64_t> all_targets() {
  hwy::SetSupportedTargetsForTest(0);
  return hwy::SupportedAndGeneratedTargets();
}

/// The target that is forced, or 0.
std::int64_t& forced_target() {
  static std::int64_t forced = 0;
  return forced;
}

void use(std::int64_t target) {
  forced_target() = target;
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string> vector_targets() {
  std::vector<std::string> names;
  const std::int64_t forced = forced_target();
  for (const std::int64_t target : all_targets()) names.emplace_back(hwy::TargetName(target));
  use(forced);
  return names;
}

std::string vector_target() {
  const std::int64_t forced = forced_target();
  return forced != 0 ? hwy::TargetName(forced) : vector_targets().front();
}

void force_vector_target(std::string_view name) {
  std::int64_t found = 0;
  for (const std::int64_t target : all_targets())
    if (hwy::TargetName(target) == name) found = target;
  if (found == 0 && !name.empty()) {
    use(forced_target());
    throw InputError(Problem{.parameter = "vector target",
                             .value = std::string(name),
                             .expected = fmt::format("one of {}", fmt::join(vector_targets(), ", ")),
                             .message = "this processor does not have these vector instructions"});
  }
  use(found);
}

}  // namespace astroid
