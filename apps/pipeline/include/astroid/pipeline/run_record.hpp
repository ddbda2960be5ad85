// run.json: everything needed to know where a product came from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "astroid/core/product_folder.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

struct RunRecord {
  std::vector<std::string> command_line;
  int threads = 1;
  const PreparedRun* run = nullptr;
  const StreamResult* stream = nullptr;
  double analyse_seconds = 0.0;
  double wall_seconds = 0.0;
  std::vector<std::string> warnings;
  KnownChecksums checksums{};  ///< of products, where they were computed before
};

/// Writes run.json into the folder, with a checksum of every other product in it. @throws EnvironmentError
void write_run_record(const ProductFolder& folder, const RunRecord& record);

/// Lists the products of a finished run anew, after an analysis has replaced some. Nothing where there is no run.json.
/// @throws EnvironmentError
void refresh_run_record(const std::filesystem::path& folder);

/// Versions of the program and of the libraries it runs on, as `astroid doctor` prints them.
struct ComponentVersion {
  std::string name, version;
};
std::vector<ComponentVersion> component_versions();

/// Highest resident memory of this process so far, bytes.
double peak_memory_bytes();

}  // namespace astroid
