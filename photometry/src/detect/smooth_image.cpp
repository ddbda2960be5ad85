#include "detect/smooth_image.hpp"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid::detail {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<float, 4>;
constexpr std::size_t kLanes = 4;
constexpr int kNoiseRows = 8;  // the noise hardly changes over so many rows

// out[x] = sum_k weight[k] in[k][x], scaled; `in` are lines, each readable to a whole vector.
void combine(std::span<const float* const> in, std::span<const float> weights, const float* scale, float* out,
             std::size_t count) {
  const Four d;
  for (std::size_t x = 0; x < count; x += kLanes) {
    auto sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, in[0] + x));
    for (std::size_t k = 1; k < weights.size(); ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, in[k] + x)));
    if (scale != nullptr) sum = hn::Mul(sum, hn::LoadU(d, scale + x));
    hn::StoreU(sum, d, out + x);
  }
}

bool usable(float counts, unsigned flags) {
  return (flags & pixel_flag::kBad) == 0 && std::isfinite(counts);
}

}  // namespace

double FilterKernel::norm() const {
  double columns = 0.0;
  double rows = 0.0;
  for (const float c : column) columns += static_cast<double>(c) * static_cast<double>(c);
  for (const float r : row) rows += static_cast<double>(r) * static_cast<double>(r);
  return std::sqrt(columns * rows);
}

FilterKernel gaussian_kernel(double fwhm) {
  constexpr double kReach = 2.5;  // sigma: what lies beyond adds 0.1 % to the significance
  constexpr int kWidest = 32;     // px
  const double k = kFwhmPerSigma / (fwhm * std::sqrt(2.0));
  const int half = std::clamp(static_cast<int>(std::ceil(kReach * fwhm / kFwhmPerSigma - 0.5)), 1, kWidest);
  FilterKernel kernel;
  double sum = 0.0;
  std::vector<double> line;
  for (int i = -half; i <= half; ++i) {
    line.push_back(0.5 * (det::erf((i + 0.5) * k) - det::erf((i - 0.5) * k)));
    sum += line.back();
  }
  for (const double value : line) kernel.row.push_back(static_cast<float>(value / sum));
  kernel.column = kernel.row;
  return kernel;
}

SmoothImage::SmoothImage(const Frame& frame, const BackgroundMap& background, const FilterKernel& kernel)
    : nx_(background.area().nx),
      ny_(background.area().ny),
      stride_(static_cast<std::size_t>(nx_) + 2 + kLanes),
      values_(stride_ * static_cast<std::size_t>(ny_ + 2) + kLanes, -1e30F) {
  const auto width = static_cast<std::size_t>(nx_);
  const std::size_t half_row = kernel.row.size() / 2;
  const int half_column = static_cast<int>(kernel.column.size() / 2);
  const Rectangle& area = background.area();
  const auto pixels = frame.pixels.view(0);
  const auto flags = frame.flags.view(0);
  std::vector<double> level(width);
  std::vector<double> rms(width);
  std::vector<float> scale(width + kLanes, 0.0F);
  std::vector<float> padded(width + 2 * half_row + kLanes, 0.0F);
  // Lines filtered along x, as many as the column needs, in turn; those outside the image are zero.
  const std::size_t lines = kernel.column.size();
  std::vector<std::vector<float>> ring(lines, std::vector<float>(width + kLanes, 0.0F));
  std::vector<const float*> shifted(kernel.row.size());
  for (std::size_t k = 0; k < shifted.size(); ++k) shifted[k] = padded.data() + k;
  std::vector<const float*> column(lines);
  const double norm = kernel.norm();
  for (int line = 0; line < ny_ + half_column; ++line) {
    std::vector<float>& target = ring[static_cast<std::size_t>(line) % lines];
    if (line < ny_) {
      const int y = area.y0 + line;
      background.level_row(y, level);
      const auto row = pixels.row(y);
      const auto row_flags = flags.row(y);
      float* light = padded.data() + half_row;
      for (std::size_t x = 0; x < width; ++x) {
        const float value = row[x] - static_cast<float>(level[x]);
        light[x] = usable(row[x], row_flags[x]) ? value : 0.0F;
      }
      combine(shifted, kernel.row, nullptr, target.data(), width);
    } else {
      std::fill(target.begin(), target.end(), 0.0F);
    }
    const int centre = line - half_column;
    if (centre < 0) continue;
    if (centre % kNoiseRows == 0) {
      background.rms_row(area.y0 + std::min(centre + kNoiseRows / 2, ny_ - 1), rms);
      for (std::size_t x = 0; x < width; ++x)
        scale[x] = rms[x] > 0.0 ? static_cast<float>(1.0 / (rms[x] * norm)) : 0.0F;
    }
    for (std::size_t k = 0; k < lines; ++k) {
      const int source = centre - half_column + static_cast<int>(k);
      column[k] = ring[static_cast<std::size_t>(source + static_cast<int>(lines)) % lines].data();
    }
    float* out = values_.data() + index(0, centre);
    combine(column, kernel.column, scale.data(), out, width);
    // Whole vectors were written: what lies beyond the last pixel is outside the image again.
    for (std::size_t k = 0; k < kLanes; ++k) out[width + k] = -1e30F;
  }
}

}  // namespace astroid::detail
