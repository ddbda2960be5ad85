#include "astroid/test/temporary_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace astroid::test {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "astroid-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const std::string& name, const std::string& text) const {
  std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::optional<std::filesystem::path> shared_data(const std::string& relative) {
  const char* override_folder = std::getenv("ASTROID_SHARED_DATA");
  const std::filesystem::path folder = override_folder != nullptr ? std::filesystem::path(override_folder)
                                                                  : source_dir().parent_path() / "shared" / "data";
  std::filesystem::path file = folder / relative;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file;
}

std::filesystem::path source_dir() {
  return ASTROID_SOURCE_DIR;
}

}  // namespace astroid::test
