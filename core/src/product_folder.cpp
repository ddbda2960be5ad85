#include "astroid/core/product_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "astroid/core/error.hpp"

namespace astroid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "run.json";   // what makes a folder one of ours
constexpr const char* kLockName = ".lock";  // in the partial folder

// Runs a function of std::filesystem and names the path when it fails.
template <class Function>
auto on_disk(const fs::path& path, Function function) {
  try {
    return function();
  } catch (const fs::filesystem_error& error) {
    throw EnvironmentError(path.string(), error.code().message());
  }
}

InputError refuse(const fs::path& path, const std::string& message, const std::string& expected,
                  const std::string& suggestion = {}) {
  return InputError(Problem{.file = path.string(), .expected = expected, .message = message, .suggestion = suggestion});
}

void check_final_folder(const fs::path& path, ExistingProducts existing) {
  if (!fs::exists(path)) return;
  if (!fs::is_directory(path)) throw refuse(path, "is not a folder", "a folder to write");
  if (fs::is_empty(path)) return;
  const bool ours = fs::exists(path / kMark);
  switch (existing) {
    case ExistingProducts::kRefuse:
      throw refuse(path, "is there already", "a new folder",
                   ours ? "--overwrite replaces it" : "it holds no products of a run, so it cannot be overwritten");
    case ExistingProducts::kResume:
      throw refuse(path, ours ? "holds a finished run already" : "is there already", "an unfinished run",
                   ours ? "--overwrite runs it anew" : "");
    case ExistingProducts::kOverwrite:
      if (!ours) throw refuse(path, "holds no products of a run (no run.json)", "a folder that a run of astroid wrote");
  }
}

// Brings all files of a folder to the disk: with their file system, because synchronising thousands of files one after
// the other waits for the disk as many times.
void synchronise_files(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::syncfs(descriptor) == 0;
  const int error_number = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw EnvironmentError(folder.string(), std::generic_category().message(error_number));
}

// Swaps two folders in one step, so that there is no moment without either; in three where the file system cannot.
void exchange(const fs::path& a, const fs::path& b) {
  if (::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) throw EnvironmentError(b.string(), std::generic_category().message(errno));
  fs::path aside = b;
  aside += ".replaced";
  rename_complete(b, aside);
  rename_complete(a, b);
  rename_complete(aside, a);
}

}  // namespace

ProductFolder::ProductFolder(const fs::path& folder, ExistingProducts existing) {
  if (folder.empty()) throw refuse(folder, "the name of the output folder is empty", "a folder to write");
  path_ = on_disk(folder, [&] { return fs::weakly_canonical(folder); });
  if (!path_.has_filename()) path_ = path_.parent_path();  // "results/"
  if (!path_.has_filename()) throw refuse(path_, "is not the name of a folder", "a folder to write");
  on_disk(path_, [&] {
    check_final_folder(path_, existing);
    const fs::path partial = working();
    const bool unfinished = fs::exists(partial) && !(fs::is_directory(partial) && fs::is_empty(partial));
    if (unfinished && existing == ExistingProducts::kRefuse) {
      throw refuse(partial, "an unfinished run is there", "no unfinished run",
                   "--overwrite removes it and starts anew");
    }
    for (fs::path above = partial.parent_path(); !above.empty() && !fs::exists(above); above = above.parent_path())
      made_.insert(made_.begin(), above);
    fs::create_directories(partial);
    lock();
    if (existing == ExistingProducts::kOverwrite) remove_all_products();
    resumed_ = unfinished && existing == ExistingProducts::kResume;
  });
}

ProductFolder::~ProductFolder() {
  unlock();
  if (committed_) return;
  std::error_code ignored;
  // Only what is empty goes.
  fs::remove(working(), ignored);
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, ignored);
}

void ProductFolder::remove_all_products() {
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(working())) {
      if (entry.path().filename() != kLockName) fs::remove_all(entry.path());
    }
  } catch (...) {
    unlock();  // called by the constructor, after whose failure there is no destructor
    throw;
  }
}

void ProductFolder::lock() {
  const fs::path name = working() / kLockName;
  lock_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw EnvironmentError(name.string(), std::generic_category().message(errno));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // file systems without locks: go on
  ::close(std::exchange(lock_, -1));
  throw refuse(path_, "another run is writing this folder", "a folder of its own for each run");
}

void ProductFolder::unlock() {
  if (lock_ < 0) return;
  ::unlink((working() / kLockName).c_str());
  ::close(std::exchange(lock_, -1));
}

fs::path ProductFolder::file(const fs::path& relative) const {
  fs::path target = working() / relative;
  on_disk(target, [&] { fs::create_directories(target.parent_path()); });
  return target;
}

std::vector<Product> ProductFolder::products(const KnownChecksums& known) const {
  return products_in(working(), known);
}

std::vector<Product> products_in(const fs::path& folder, const KnownChecksums& known) {
  std::vector<Product> result;
  on_disk(folder, [&] {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const std::string name = entry.path().lexically_relative(folder).generic_string();
      if (!entry.is_regular_file() || name == kMark || name == kLockName || entry.path().extension() == ".partial")
        continue;
      result.push_back({name, entry.file_size(), {}});
    }
  });
  std::sort(result.begin(), result.end(), [](const Product& a, const Product& b) { return a.path < b.path; });
  for (Product& product : result) {
    const auto found = known.find(product.path);
    product.sha256 = found != known.end() ? found->second : sha256_of_file(folder / product.path);
  }
  return result;
}

void ProductFolder::remove_unfinished_files() const {
  std::vector<fs::path> unfinished;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(working())) {
    if (entry.is_regular_file() && entry.path().extension() == ".partial") unfinished.push_back(entry.path());
  }
  for (const fs::path& file : unfinished) fs::remove(file);
}

void ProductFolder::commit() {
  if (committed_) throw BugError("ProductFolder: committed twice: " + path_.string());
  on_disk(path_, [&] {
    remove_unfinished_files();
    synchronise_files(working());
    const bool replaces = fs::exists(path_) && !fs::is_empty(path_);
    unlock();
    if (!replaces) {
      rename_complete(working(), path_);
    } else {
      exchange(working(), path_);
      fs::remove_all(working());
    }
  });
  committed_ = true;
}

}  // namespace astroid
