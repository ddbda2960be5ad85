#include "catalogue_table.hpp"

#include <array>
#include <fstream>
#include <string_view>

namespace astroid {

namespace {

/// FITS begins with its first keyword; compressed by gzip it is known by its name.
bool is_fits(const std::filesystem::path& path) {
  constexpr std::string_view kFirstKeyword = "SIMPLE  =";
  constexpr std::string_view kGzip = "\x1f\x8b";
  std::array<char, kFirstKeyword.size()> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const std::string_view beginning(bytes.data(), static_cast<std::size_t>(file.gcount()));
  if (beginning == kFirstKeyword) return true;
  return beginning.starts_with(kGzip) && path.filename().string().find(".fit") != std::string::npos;
}

}  // namespace

std::unique_ptr<CatalogueTable> read_catalogue_table(const std::filesystem::path& path) {
  return is_fits(path) ? read_fits_table(path) : read_text_table(path);
}

}  // namespace astroid
