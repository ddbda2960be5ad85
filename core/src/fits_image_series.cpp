#include "astroid/core/fits_image_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "astroid/core/error.hpp"
#include "cfitsio_call.hpp"
#include "fits_cards.hpp"
#include "fits_checksum.hpp"
#include "fits_counts.hpp"

namespace astroid {

namespace {

constexpr std::size_t kBlock = 2880;                        // bytes, FITS standard
constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;  // written at a time; small enough for the fast caches

std::size_t whole_blocks(std::size_t bytes) {
  return (bytes + kBlock - 1) / kBlock * kBlock;
}

template <class Stored>
void write_counts(AtomicFile& file, std::string header, std::span<const float> counts) {
  file.write(header);
  std::array<Stored, kPieceBytes / sizeof(Stored)> piece;
  std::uint32_t sum = 0;
  for (std::size_t first = 0; first < counts.size(); first += piece.size()) {
    const std::size_t count = std::min(piece.size(), counts.size() - first);
    if (!store_fits_counts(counts.subspan(first, count), std::span(piece).first(count)))
      throw BugError(fmt::format("a pixel of {} is not a whole number in range", file.path().string()));
    std::fill(piece.begin() + static_cast<std::ptrdiff_t>(count), piece.end(), Stored{0});  // completes the last word
    const std::string_view bytes(reinterpret_cast<const char*>(piece.data()), kPieceBytes);
    sum = fits_sum(bytes, sum);
    file.write(bytes.substr(0, count * sizeof(Stored)));
  }
  const std::size_t size = counts.size() * sizeof(Stored);
  file.write(std::string(whole_blocks(size) - size, '\0'));
  fill_fits_checksums(header, sum);
  file.overwrite(0, header);
}

}  // namespace

FitsImageSeries::FitsImageSeries(FitsNumber number, int nx, int ny, std::span<const FitsCard> cards,
                                 std::span<const std::string> history)
    : number_(number), pixels_(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)) {
  if (number != FitsNumber::kUnsigned16 && number != FitsNumber::kInt32)
    throw BugError("FitsImageSeries: neither 16-bit nor 32-bit integers");
  const CfitsioLock lock;
  int status = 0;
  const auto check = [&] {
    if (status != 0) throw BugError("FitsImageSeries: " + cfitsio_message(status, 0));
  };
  fitsfile* opened = nullptr;
  ffinit(&opened, "mem://", &status);
  check();
  const auto close = [](fitsfile* file) {
    int ignored = 0;
    ffdelt(file, &ignored);
  };
  const std::unique_ptr<fitsfile, decltype(close)> file(opened, close);
  std::array<LONGLONG, 2> axes{nx, ny};
  ffcrimll(file.get(), number == FitsNumber::kUnsigned16 ? USHORT_IMG : LONG_IMG, static_cast<int>(axes.size()),
           axes.data(), &status);
  set_fits_unit_cards(file.get(), {}, &status);
  for (const FitsCard& card : cards) set_fits_card(file.get(), card, &status);
  for (const std::string& line : history) add_fits_history(file.get(), line, &status);
  char* text = nullptr;
  int count = 0;
  ffhdr2str(file.get(), 0, nullptr, 0, &text, &count, &status);
  check();
  header_ = text;
  fffree(text, &status);
  header_.resize(whole_blocks(header_.size()), ' ');
}

void FitsImageSeries::write(const std::filesystem::path& path, std::span<const float> counts,
                            std::span<const FitsCard> changed, Durability durability) const {
  ASTROID_CHECK_EQ(counts.size(), pixels_);
  std::string header = header_;
  replace_fits_card(header, fits_date_card());
  for (const FitsCard& card : changed) replace_fits_card(header, card);
  AtomicFile file(path);
  if (number_ == FitsNumber::kUnsigned16) {
    write_counts<std::uint16_t>(file, std::move(header), counts);
  } else {
    write_counts<std::uint32_t>(file, std::move(header), counts);
  }
  file.commit(durability);
}

}  // namespace astroid
