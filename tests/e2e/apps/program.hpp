// Runs the program astroid as a user does, in a process of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace astroid::test {

/// What a program left behind.
struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string out, err;
  double seconds = 0.0;
};

/// Runs a program with arguments in `folder`, without a terminal. @throws std::runtime_error when it cannot start
ProgramResult run_program(const std::vector<std::string>& command, const std::filesystem::path& folder);

/// Runs astroid. Dates in products are those of SOURCE_DATE_EPOCH, so that runs can be compared byte by byte.
ProgramResult run_astroid(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// The same by way of another program: an emulator of processors, or `env` with variables.
ProgramResult run_astroid_through(const std::vector<std::string>& runner, const std::vector<std::string>& arguments,
                                  const std::filesystem::path& folder);

/// Whether a program is in the PATH.
bool has_program(const std::string& name);

std::string read_file(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);

/// Names of all files below a folder, relative to it, in order.
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// Expects the same files in the folders of two runs, byte for byte. Those that hold times (run.json) and drawings of
/// gnuplot are left out.
/// @param parts  only files whose names begin with one of these.  @returns the number of files compared
std::size_t expect_same_products(const std::filesystem::path& run, const std::filesystem::path& other,
                                 const std::vector<std::string>& parts = {""});

}  // namespace astroid::test
