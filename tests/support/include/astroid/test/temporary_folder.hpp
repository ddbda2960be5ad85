// A folder that exists for one test, and the places where tests find data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace astroid::test {

/// A new empty folder under the system's temporary folder, removed with all its contents at the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a text file in the folder and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// A file of the shared real data beside the checkout (../shared/data), or nothing where that folder is absent.
std::optional<std::filesystem::path> shared_data(const std::string& relative);

/// The root of the source tree.
std::filesystem::path source_dir();

}  // namespace astroid::test
