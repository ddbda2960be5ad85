// Files that are either complete or absent: written beside, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace astroid {

/// The name under which a product is written before it is complete: `path` + ".partial".
[[nodiscard]] std::filesystem::path partial_path(const std::filesystem::path& path);

/// Moves a complete file or folder to its final name and makes the renaming last a power cut.
/// @throws EnvironmentError(to, cause)
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// A file being written under partial_path(path), buffered; commit() flushes it to the disk and renames it to `path`.
/// Without commit() the destructor removes what was written. Every failure, a full disk too, is an EnvironmentError
/// that names `path`.  @thread one thread at a time
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// Nothing can be written afterwards.
  void commit();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void flush();

  std::filesystem::path path_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes `text` to `path` in one step: readers see the old file or the new one, never a part.
/// @throws EnvironmentError(path, cause)
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// The whole content of a text file.
/// @throws EnvironmentError when it cannot be read; InputError when it holds a NUL byte and so is not text.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

}  // namespace astroid
