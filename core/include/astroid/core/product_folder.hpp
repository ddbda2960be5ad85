// The folder of a run's products: complete under its name, or beside it under .partial.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/atomic_file.hpp"

namespace astroid {

/// SHA-256 as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);
/// @throws EnvironmentError(path, cause)
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);

/// What to do when the products are there already.
enum class ExistingProducts {
  kRefuse,
  kOverwrite,  ///< replace them, at the moment the new ones are complete
  kResume,     ///< go on with an unfinished run
};

/// One file of the folder, for run.json.
struct Product {
  std::string path;  ///< relative to the folder, with /
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// Checksums that are known, by the path relative to the folder.
using KnownChecksums = std::map<std::string, std::string>;

/// Every complete file of a folder but run.json, in the order of their names, with its checksum; `known` ones are
/// taken as they are. @throws EnvironmentError(path, cause)
[[nodiscard]] std::vector<Product> products_in(const std::filesystem::path& folder, const KnownChecksums& known = {});

/// The folder that `-o DIR` names. A run writes in DIR.partial; commit() synchronises what is in it, in one go, and
/// renames it to DIR: so products need not be synchronised one by one (Durability::kWithFolder). A run that ends
/// otherwise leaves DIR.partial (nothing if it is empty: neither it nor the folders above that were made for it). A
/// lock keeps two runs from writing the same folder.
/// @throws EnvironmentError(path, cause) when the disk or permissions fail, from every member function.
class ProductFolder {
 public:
  /// Creates DIR.partial, and the folders above it.
  /// @throws InputError when DIR or DIR.partial is there and `existing` does not allow it (the message names
  /// --overwrite and
  ///         --resume), when DIR is not a folder, when kOverwrite would replace a folder that no run of ours wrote (it
  ///         holds no run.json), when kResume finds a finished run, or when another run is writing it.
  ProductFolder(const std::filesystem::path& folder, ExistingProducts existing);
  ~ProductFolder();
  ProductFolder(const ProductFolder&) = delete;
  ProductFolder& operator=(const ProductFolder&) = delete;
  ProductFolder(ProductFolder&&) = delete;
  ProductFolder& operator=(ProductFolder&&) = delete;

  /// DIR, as it will be called.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// True when an unfinished run left something to go on with.
  [[nodiscard]] bool resumed() const { return resumed_; }

  /// Where to write the product `relative` ("images/0001.fits") now; the folders above it are created.
  [[nodiscard]] std::filesystem::path file(const std::filesystem::path& relative) const;

  /// Every file so far but run.json, in the order of their names, with its checksum.
  [[nodiscard]] std::vector<Product> products(const KnownChecksums& known = {}) const;

  /// Synchronises the products and gives the folder its name. Files left over from products that were never completed
  /// are removed.
  void commit();

 private:
  [[nodiscard]] std::filesystem::path working() const { return partial_path(path_); }
  void lock();
  void unlock();
  void remove_all_products();
  void remove_unfinished_files() const;

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  // folders above, outermost first
  bool resumed_ = false;
  bool committed_ = false;
  int lock_ = -1;
};

}  // namespace astroid
