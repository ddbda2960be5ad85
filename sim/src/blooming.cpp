#include "astroid/sim/blooming.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/plane_kernels.hpp"

namespace astroid {

namespace {

/// Fills free room with the charge carried past it. @returns what is carried on
double pour(double& pixel, double full_well, double carried) {
  if (carried <= 0.0 || pixel >= full_well) return carried;
  const double taken = std::min(full_well - pixel, carried);
  pixel = taken == carried ? pixel + carried : full_well;
  return carried - taken;
}

/// A pixel at or above the full well, by place in the image.
struct FullPixel {
  std::size_t x = 0;
  std::size_t y = 0;
  double half_excess = 0.0;
};

/// Clips the full pixels of an image and gives back what was above, column by column from the bottom.
std::vector<FullPixel> take_excess(const ImageView<double, unit::SampledElectrons>& electrons, double full_well) {
  const Rectangle& area = electrons.area();
  std::vector<FullPixel> full;
  std::vector<std::uint32_t> found(static_cast<std::size_t>(std::max(0, area.nx)));
  for (int y = area.y0; y < area.y1(); ++y) {
    const std::span<double> row = electrons.row(y);
    for (const std::uint32_t x : std::span(found).first(find_at_least(row, full_well, found))) {
      full.push_back({x, static_cast<std::size_t>(y - area.y0), 0.5 * (row[x] - full_well)});
      row[x] = full_well;
    }
  }
  std::ranges::sort(full,
                    [](const FullPixel& a, const FullPixel& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  return full;
}

/// Carries half of every excess of a column one way until it has found room. @returns what reaches the edge
/// @param full  in the order of the way.  @param pixel, touch  of a step along the way
template <class Iterator, class Place, class Pixel, class Touch>
double spill(Iterator full, Iterator end, std::size_t height, const Place& place, const Pixel& pixel,
             const Touch& touch, double full_well) {
  double carried = 0.0;
  std::size_t step = 0;
  for (; full != end; ++full) {
    const std::size_t next = place(full->y);
    for (; carried > 0.0 && step < next; ++step) {
      touch(step);
      carried = pour(pixel(step), full_well, carried);
    }
    step = next;
    touch(step);
    carried = pour(pixel(step), full_well, carried) + full->half_excess;
    ++step;
  }
  for (; carried > 0.0 && step < height; ++step) {
    touch(step);
    carried = pour(pixel(step), full_well, carried);
  }
  return carried;
}

}  // namespace

double bloom(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
             const ImageView<std::uint8_t, unit::Flags>* flags) {
  const std::vector<FullPixel> full = take_excess(electrons, full_well);
  const auto height = static_cast<std::size_t>(electrons.area().ny);
  const std::size_t stride = electrons.stride();
  double lost = 0.0;
  for (auto column = full.begin(); column != full.end();) {
    const std::size_t x = column->x;
    const auto end = std::find_if(column, full.end(), [x](const FullPixel& p) { return p.x != x; });
    const auto pixel = [&](std::size_t y) -> double& { return electrons.data()[y * stride + x]; };
    const auto touch = [&](std::size_t y) {
      if (flags != nullptr) flags->data()[y * flags->stride() + x] |= pixel_flag::kFullWell;
    };
    const auto from_top = [height](std::size_t y) { return height - 1 - y; };
    const double up = spill(
        column, end, height, [](std::size_t y) { return y; }, pixel, touch, full_well);
    const double down = spill(
        std::reverse_iterator(end), std::reverse_iterator(column), height, from_top,
        [&](std::size_t step) -> double& { return pixel(from_top(step)); },
        [&](std::size_t step) { touch(from_top(step)); }, full_well);
    lost += up + down;
    column = end;
  }
  return lost;
}

double clip_full_well(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
                      const ImageView<std::uint8_t, unit::Flags>* flags) {
  double removed = 0.0;
  for (const FullPixel& pixel : take_excess(electrons, full_well)) {
    removed += 2.0 * pixel.half_excess;
    if (flags != nullptr) flags->data()[pixel.y * flags->stride() + pixel.x] |= pixel_flag::kFullWell;
  }
  return removed;
}

double clip_full_well(std::span<double> electrons, double full_well, std::span<std::uint8_t> flags) {
  double removed = 0.0;
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    if (!(electrons[i] >= full_well)) continue;
    removed += electrons[i] - full_well;
    electrons[i] = full_well;
    flags[i] |= pixel_flag::kFullWell;
  }
  return removed;
}

}  // namespace astroid
