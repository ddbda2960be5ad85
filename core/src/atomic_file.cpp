#include "astroid/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr std::size_t kBufferBytes = 1U << 16U;
constexpr mode_t kFileMode = 0666;  // narrowed by the user's umask

std::string cause_of(int error_number) {
  return std::generic_category().message(error_number);
}

// Best effort: some file systems refuse to synchronise a folder, and the renaming itself has succeeded by then.
void synchronise_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

std::filesystem::path partial_path(const std::filesystem::path& path) {
  // "results/" and "results" are the same folder: the suffix belongs to the name, not inside the folder.
  std::filesystem::path partial = path.has_filename() ? path : path.parent_path();
  partial += ".partial";
  return partial;
}

void rename_complete(const std::filesystem::path& from, const std::filesystem::path& to, Durability durability) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw EnvironmentError(to.string(), cause_of(errno));
  if (durability == Durability::kAtOnce) synchronise_folder(to.parent_path());
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  if (!path_.has_filename()) throw EnvironmentError(path_.string(), "is not the name of a file");
  if (std::filesystem::is_directory(path_)) throw EnvironmentError(path_.string(), cause_of(EISDIR));
  descriptor_ = ::open(partial_path(path_).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (descriptor_ < 0) throw EnvironmentError(path_.string(), cause_of(errno));
  buffer_.reserve(kBufferBytes);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(partial_path(path_).c_str());
}

void AtomicFile::flush() {
  write_out(buffer_);
  buffer_.clear();
}

void AtomicFile::write_out(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw EnvironmentError(path_.string(), cause_of(errno));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::write(std::string_view bytes) {
  if (descriptor_ < 0) throw BugError("AtomicFile: written to after its end: " + path_.string());
  if (bytes.size() >= kBufferBytes) {
    flush();
    write_out(bytes);
    return;
  }
  const std::size_t part = std::min(bytes.size(), kBufferBytes - buffer_.size());
  buffer_.append(bytes.substr(0, part));
  if (buffer_.size() == kBufferBytes) flush();
  buffer_.append(bytes.substr(part));
}

void AtomicFile::overwrite(std::uint64_t at, std::string_view bytes) {
  if (descriptor_ < 0) throw BugError("AtomicFile: written to after its end: " + path_.string());
  flush();
  const off_t end = ::lseek(descriptor_, 0, SEEK_CUR);
  if (end < 0) throw EnvironmentError(path_.string(), cause_of(errno));
  ASTROID_CHECK_LE(at + bytes.size(), static_cast<std::uint64_t>(end));
  if (::lseek(descriptor_, static_cast<off_t>(at), SEEK_SET) < 0)
    throw EnvironmentError(path_.string(), cause_of(errno));
  write_out(bytes);
  if (::lseek(descriptor_, end, SEEK_SET) < 0) throw EnvironmentError(path_.string(), cause_of(errno));
}

void AtomicFile::commit(Durability durability) {
  if (descriptor_ < 0) throw BugError("AtomicFile: committed twice: " + path_.string());
  flush();
  if (durability == Durability::kAtOnce && ::fsync(descriptor_) != 0)
    throw EnvironmentError(path_.string(), cause_of(errno));
  try {
    // Some file systems report a full disk only here. The descriptor is gone even when close() fails.
    if (::close(std::exchange(descriptor_, -1)) != 0) throw EnvironmentError(path_.string(), cause_of(errno));
    rename_complete(partial_path(path_), path_, durability);
  } catch (...) {
    ::unlink(partial_path(path_).c_str());
    throw;
  }
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

std::string read_text_file(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw EnvironmentError(path.string(), cause_of(errno));
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } const closer{descriptor};
  std::string text;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
    text.reserve(static_cast<std::size_t>(status.st_size));
  }
  std::array<char, kBufferBytes> chunk{};
  for (;;) {
    const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw EnvironmentError(path.string(), cause_of(errno));
    if (count == 0) return text;
    const std::string_view bytes(chunk.data(), static_cast<std::size_t>(count));
    const std::size_t nul = bytes.find('\0');
    if (nul != std::string_view::npos) {
      text.append(bytes.substr(0, nul));
      const auto line = 1 + std::count(text.begin(), text.end(), '\n');
      throw InputError(Problem{.file = path.string(),
                               .line = static_cast<long>(line),
                               .expected = "plain text (ASCII or UTF-8)",
                               .message = "contains a NUL byte, so it is not a text file"});
    }
    text.append(bytes);
  }
}

}  // namespace astroid
