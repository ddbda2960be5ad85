#include "folders.hpp"

#include <system_error>

#include "astroid/core/error.hpp"

namespace astroid {

void create_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw EnvironmentError(folder.string(), error.message());
}

}  // namespace astroid
