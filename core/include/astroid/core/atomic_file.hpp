// Files that are either complete or absent: written beside, then renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace astroid {

/// When a file must be safe from a power cut.
enum class Durability {
  kAtOnce,      ///< before it gets its name
  kWithFolder,  ///< when the ProductFolder around it gets its name: for series of files, each too small to wait for
};

/// The name under which a product is written before it is complete: `path` + ".partial".
[[nodiscard]] std::filesystem::path partial_path(const std::filesystem::path& path);

/// Moves a complete file or folder to its final name; with kAtOnce the renaming lasts a power cut.
/// @throws EnvironmentError(to, cause)
void rename_complete(const std::filesystem::path& from, const std::filesystem::path& to,
                     Durability durability = Durability::kAtOnce);

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
  /// Replaces bytes that are written already, from byte `at` on: for a header that is known last.
  void overwrite(std::uint64_t at, std::string_view bytes);
  /// Nothing can be written afterwards.
  void commit(Durability durability = Durability::kAtOnce);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void flush();
  void write_out(std::string_view bytes) const;

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
