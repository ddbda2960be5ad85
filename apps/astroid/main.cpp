// The program: parses the command line, runs a command, and turns exceptions into messages and exit codes.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "astroid/core/error.hpp"
#include "astroid/core/vector_target.hpp"
#include "command_line.hpp"

int main(int argc, char** argv) {
  using astroid::ExitCode;
  try {
    // To compare or to test instruction sets; results do not depend on them.
    if (const char* target = std::getenv("ASTROID_VECTORS"); target != nullptr) astroid::force_vector_target(target);
    return astroid::run_command_line(argc, argv);
  } catch (const astroid::InputError& error) {
    const auto count = error.problems().size();
    fmt::print(stderr, "astroid: {} problem{} in the input:\n", count, count == 1 ? "" : "s");
    for (const astroid::Problem& problem : error.problems()) fmt::print(stderr, "  {}\n", problem.text());
    return static_cast<int>(ExitCode::kInput);
  } catch (const astroid::EnvironmentError& error) {
    fmt::print(stderr, "astroid: {}\n", error.what());
    return static_cast<int>(ExitCode::kEnvironment);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "astroid: not enough memory for this run (`astroid plan` predicts what it needs)\n");
    return static_cast<int>(ExitCode::kEnvironment);
  } catch (const std::exception& error) {
    fmt::print(stderr, "astroid: internal error, please report it: {}\n", error.what());
    return static_cast<int>(ExitCode::kBug);
  }
}
