// The machine that a run works on, and its clock.
#pragma once

#include <string>

namespace astroid {

std::string host_name();
/// As /proc/cpuinfo has it; "unknown" where it says nothing.
std::string processor_name();
/// ISO 8601, whole seconds, Z.
std::string utc_now();

}  // namespace astroid
