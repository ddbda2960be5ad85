// What commands show a person: a progress bar on a terminal, nothing elsewhere.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "astroid/pipeline/exposure_stream.hpp"

namespace astroid::commands {

/// A progress bar with the time left, on a terminal only; empty elsewhere.
Progress progress_bar(const std::string& what);

/// Processors of this machine, or what the user asked for.
int thread_count(int asked);

/// "1.2 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace astroid::commands
