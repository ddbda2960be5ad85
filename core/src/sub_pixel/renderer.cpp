#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "astroid/core/sub_pixel.hpp"
#include "astroid/core/units.hpp"
#include "motion_nodes.hpp"
#include "sub_pixel/deposit_kernel.hpp"
#include "sub_pixel/fourier_transform.hpp"
#include "sub_pixel/tile_grid.hpp"

namespace astroid {

namespace {

using Complex = std::complex<double>;

/// Of the map's sampling frequency: the highest that is used. The rest is what the spread of a star needs.
constexpr double kBandPerNode = 1.0 / 3.0;
constexpr double kDepositError = 1e-13;
/// Light beyond the reach of the PSF, as a share of the accuracy.
constexpr double kLostShare = 1e-3;

/// Numbers of sub-pixels that the map may have: products of small primes.
constexpr std::array<int, 26> kSubPixels = {1,  2,  3,  4,  5,  6,  7,  8,  10, 12, 14, 16,  18,
                                            20, 24, 28, 32, 36, 40, 48, 56, 64, 80, 96, 112, 128};

/// Of the blend, in units of a star's flux.
double error_beyond(const FieldSpectrum& psf, double band) {
  double worst = 0.0;
  for (const auto& member : psf.members) worst = std::max(worst, member->error_beyond(band));
  return psf.amplification * worst;
}

double reach_of(const FieldSpectrum& psf, double lost) {
  double widest = 0.0;
  for (const auto& member : psf.members) widest = std::max(widest, member->reach(lost / psf.amplification));
  return widest;
}

std::string describe(const FieldSpectrum& psf) {
  const std::string first = psf.members.front()->description();
  return psf.members.size() == 1 ? first
                                 : fmt::format("{} tables over the field; the first: {}", psf.members.size(), first);
}

int choose_sub_pixels(const FieldSpectrum& psf, const SubPixelSettings& settings) {
  if (settings.sub_pixels > 0) return settings.sub_pixels;
  const double allowed = (1.0 - kLostShare) * settings.accuracy;
  const auto suffices = [&](const PsfSpectrum& member, int n) {
    return psf.amplification * member.error_beyond(kBandPerNode * n) <= allowed;
  };
  auto n = kSubPixels.begin();
  for (const auto& member : psf.members)
    while (n != kSubPixels.end() && !suffices(*member, *n)) ++n;
  if (n != kSubPixels.end()) return *n;
  throw InputError(Problem{
      .parameter = "Simulation/Renderer",
      .value = "subpixel",
      .expected = "analytic or prf, or a wider PSF, or a larger error in Simulation/Accuracy",
      .message = fmt::format("{} needs more than {} sub-pixels per pixel for an error of {:.2g} of a star's flux",
                             describe(psf), kSubPixels.back(), settings.accuracy)});
}

std::vector<double> frequencies(long first, long last, double period) {
  std::vector<double> k;
  for (long i = first; i <= last; ++i) k.push_back(static_cast<double>(i) / period);
  return k;
}

}  // namespace

struct SubPixelRenderer::Workspace::Maps {
  detail::AlignedBuffer<double> map;
  detail::AlignedBuffer<Complex> spectrum;
  detail::AlignedBuffer<Complex> cell_spectrum;
  detail::AlignedBuffer<double> cells;
};

SubPixelRenderer::Workspace::Workspace() : maps_(std::make_unique<Maps>()) {}
SubPixelRenderer::Workspace::Workspace(Workspace&&) noexcept = default;
SubPixelRenderer::Workspace& SubPixelRenderer::Workspace::operator=(Workspace&&) noexcept = default;
SubPixelRenderer::Workspace::~Workspace() = default;

struct SubPixelRenderer::Design {
  Design(FieldSpectrum field, Rectangle detector, const SubPixelSettings& settings)
      : psf(std::move(field)),
        sub_pixels(choose_sub_pixels(psf, settings)),
        cells(settings.cells),
        band(kBandPerNode * sub_pixels),
        lost(std::clamp(kLostShare * settings.accuracy, 1e-16, 1e-6)),
        error(error_beyond(psf, band) + lost + kDepositError),
        reach(reach_of(psf, lost)),
        grid(detail::make_tile_grid(detector, {.sub_pixels = sub_pixels,
                                               .cells = cells,
                                               .margin = static_cast<int>(std::ceil(reach)) + 1,
                                               .memory_bytes = settings.memory_bytes})),
        kernel(std::max(static_cast<double>(last_frequency(grid.period_x)) / (sub_pixels * grid.period_x),
                        static_cast<double>(last_frequency(grid.period_y)) / (sub_pixels * grid.period_y))),
        map_transform(map_nodes(grid.period_x), map_nodes(grid.period_y)),
        cell_transform(cell_nodes(grid.period_x), cell_nodes(grid.period_y)) {
    make_transfer(settings.response);
  }

  [[nodiscard]] std::size_t map_nodes(int period) const {
    return static_cast<std::size_t>(period) * static_cast<std::size_t>(sub_pixels);
  }
  [[nodiscard]] std::size_t cell_nodes(int period) const {
    return static_cast<std::size_t>(period) * static_cast<std::size_t>(cells);
  }

  // A sum over frequencies up to this one reaches half a step farther: to the band at least.
  [[nodiscard]] long last_frequency(int period) const { return static_cast<long>(std::ceil(band * period - 0.5)); }

  void make_transfer(const PixelResponse& response);
  void deposit(PixelPosition star, double electrons, std::span<double> map) const;
  /// @param shares  of each star's light, `stride` apart; empty: all of it
  void deposit(const Rectangle& tile, std::span<const StarLight> stars, std::span<const double> shares,
               std::size_t stride, std::span<double> map) const;
  void fold(std::span<const Complex> spectrum, std::span<const Complex> factors, std::span<Complex> folded) const;
  void convolve(const Rectangle& tile, std::span<const StarLight> stars, Workspace::Maps& maps) const;

  FieldSpectrum psf;
  int sub_pixels;
  int cells;
  double band;
  double lost;
  double error;
  double reach;
  detail::TileGrid grid;
  detail::DepositKernel kernel;
  detail::FourierTransform map_transform;
  detail::FourierTransform cell_transform;
  std::vector<double> kx;                      // 0 … band
  std::vector<double> ky;                      // -band … band
  std::vector<std::vector<Complex>> transfer;  // of each member of the PSF
};

// What the spectrum of the map is multiplied by: the PSF, the integral over the cells (or the pixel and its response,
// which correlates rather than convolves: the conjugate), the way from the map's nodes to the cells' centres, and the
// division by the transform of the spread.
void SubPixelRenderer::Design::make_transfer(const PixelResponse& response) {
  const long last_x = last_frequency(grid.period_x);
  const long last_y = last_frequency(grid.period_y);
  kx = frequencies(0, last_x, grid.period_x);
  ky = frequencies(-last_y, last_y, grid.period_y);
  std::vector<Complex> integral(kx.size() * ky.size());
  if (cells == 1) {
    sample_response(response, kx, ky, integral);
    for (Complex& value : integral) value = std::conj(value);
  } else {
    ASTROID_CHECK_EQ(response.is_uniform(), true);
    // A cell is a small pixel; its centre lies (1/cells - 1)/2 px from the pixel's for the first one.
    const double scale = 1.0 / cells;
    const double centre = 0.5 * (scale - 1.0);
    std::vector<double> scaled_x = kx;
    std::vector<double> scaled_y = ky;
    for (double& k : scaled_x) k *= scale;
    for (double& k : scaled_y) k *= scale;
    sample_response({}, scaled_x, scaled_y, integral);
    for (std::size_t q = 0; q < ky.size(); ++q)
      for (std::size_t i = 0; i < kx.size(); ++i)
        integral[q * kx.size() + i] *= scale * scale * std::polar(1.0, 2.0 * kPi * centre * (kx[i] + ky[q]));
  }
  const auto spread = [this](double k) { return kernel.transform(k / sub_pixels); };
  const double periods = static_cast<double>(grid.period_x) * grid.period_y;
  std::vector<double> spread_x(kx.size());
  std::ranges::transform(kx, spread_x.begin(), spread);
  for (std::size_t q = 0; q < ky.size(); ++q) {
    const double spread_y = spread(ky[q]) * periods;
    for (std::size_t i = 0; i < kx.size(); ++i) integral[q * kx.size() + i] /= spread_x[i] * spread_y;
  }
  for (const auto& member : psf.members) {
    std::vector<Complex>& factors = transfer.emplace_back(integral.size());
    member->sample(kx, ky, factors);
    for (std::size_t i = 0; i < factors.size(); ++i) factors[i] *= integral[i];
  }
}

// `star` in nodes of the map.
void SubPixelRenderer::Design::deposit(PixelPosition star, double electrons, std::span<double> map) const {
  const detail::DepositKernel::Nodes x = kernel.nodes(star.x);
  const detail::DepositKernel::Nodes y = kernel.nodes(star.y);
  const auto nx = static_cast<long>(map_transform.nx());
  const auto ny = static_cast<long>(map_transform.ny());
  const auto wrap = [](long i, long n) { return ((i % n) + n) % n; };
  const std::size_t width = kernel.width();
  std::array<std::size_t, detail::DepositKernel::kWidest> columns{};
  for (std::size_t i = 0; i < width; ++i)
    columns[i] = static_cast<std::size_t>(wrap(x.first + static_cast<long>(i), nx));
  for (std::size_t j = 0; j < width; ++j) {
    double* row = &map[static_cast<std::size_t>(wrap(y.first + static_cast<long>(j), ny) * nx)];
    const double weight = electrons * y.weights[j];
    for (std::size_t i = 0; i < width; ++i) row[columns[i]] += weight * x.weights[i];
  }
}

void SubPixelRenderer::Design::deposit(const Rectangle& tile, std::span<const StarLight> stars,
                                       std::span<const double> shares, std::size_t stride,
                                       std::span<double> map) const {
  const auto inside = [this](double x, int first, int end) {
    return x >= first - 0.5 - reach && x < end - 0.5 + reach;
  };
  // Node 0 is the centre of the first pixel of the margin.
  const auto add = [&](PixelPosition star, double electrons) {
    if (!inside(star.x, tile.x0, tile.x1()) || !inside(star.y, tile.y0, tile.y1())) return;
    deposit({(star.x - (tile.x0 - grid.margin)) * sub_pixels, (star.y - (tile.y0 - grid.margin)) * sub_pixels},
            electrons, map);
  };
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const StarLight& star = stars[i];
    const double electrons = shares.empty() ? star.electrons : star.electrons * shares[i * stride];
    if (!star.broadened) {
      add(star.centre, electrons);
      continue;
    }
    for (const detail::MotionNode& node : detail::motion_nodes(star.motion))
      add({star.centre.x + node.shift.dx, star.centre.y + node.shift.dy}, electrons * node.weight);
  }
}

// From the band of the map's spectrum to the spectrum of the cells: sampling every cell's centre adds up frequencies
// that differ by the cells' own sampling frequency.
void SubPixelRenderer::Design::fold(std::span<const Complex> spectrum, std::span<const Complex> factors,
                                    std::span<Complex> folded) const {
  const auto nx = static_cast<long>(cell_transform.nx());
  const auto ny = static_cast<long>(cell_transform.ny());
  const auto map_ny = static_cast<long>(map_transform.ny());
  const std::size_t map_row = map_transform.nx() / 2 + 1;
  const auto row_length = nx / 2 + 1;
  const auto wrap = [](long i, long n) { return ((i % n) + n) % n; };
  const long last_y = (static_cast<long>(ky.size()) - 1) / 2;
  for (std::size_t q = 0; q < ky.size(); ++q) {
    const long j = static_cast<long>(q) - last_y;
    const Complex* from = &spectrum[static_cast<std::size_t>(wrap(j, map_ny)) * map_row];
    const Complex* factor = &factors[q * kx.size()];
    Complex* row = &folded[static_cast<std::size_t>(wrap(j, ny) * row_length)];
    Complex* mirrored = &folded[static_cast<std::size_t>(wrap(-j, ny) * row_length)];
    for (std::size_t i = 0; i < kx.size(); ++i) {
      const Complex value = from[i] * factor[i];
      const long column = wrap(static_cast<long>(i), nx);
      if (column < row_length) row[column] += value;
      if (i == 0) continue;  // its mirror image is in the band already
      const long mirror = wrap(-static_cast<long>(i), nx);
      if (mirror < row_length) mirrored[mirror] += std::conj(value);
    }
  }
}

void SubPixelRenderer::Design::convolve(const Rectangle& tile, std::span<const StarLight> stars,
                                        Workspace::Maps& maps) const {
  maps.map.resize(map_transform.real_size());
  maps.spectrum.resize(map_transform.complex_size());
  maps.cell_spectrum.resize(cell_transform.complex_size());
  maps.cells.resize(cell_transform.real_size());
  // Every member of a varying PSF has a map of its own, with its share of each star.
  const std::size_t members = psf.members.size();
  std::vector<double> shares(members > 1 ? members * stars.size() : 0);
  if (members > 1)
    for (std::size_t i = 0; i < stars.size(); ++i)
      psf.weights(stars[i].centre, std::span(shares).subspan(i * members, members));
  std::ranges::fill(maps.cell_spectrum.span(), Complex{});
  for (std::size_t k = 0; k < members; ++k) {
    std::ranges::fill(maps.map.span(), 0.0);
    deposit(tile, stars, members > 1 ? std::span<const double>(shares).subspan(std::min(k, shares.size())) : shares,
            members, maps.map.span());
    map_transform.forward(maps.map, maps.spectrum);
    fold(maps.spectrum.span(), transfer[k], maps.cell_spectrum.span());
  }
  cell_transform.backward(maps.cell_spectrum, maps.cells);
}

NegativeLight silence(std::span<double> light, double limit) {
  NegativeLight negative;
  for (double& pixel : light) {
    if (!(pixel < 0.0)) continue;
    negative.add({1, pixel});
    if (pixel >= -limit) pixel = 0.0;
  }
  return negative;
}

SubPixelRenderer::SubPixelRenderer(std::shared_ptr<const PsfSpectrum> psf, Rectangle detector,
                                   const SubPixelSettings& settings)
    : SubPixelRenderer(FieldSpectrum{.members = {std::move(psf)}, .weights = {}}, detector, settings) {}

SubPixelRenderer::SubPixelRenderer(FieldSpectrum psf, Rectangle detector, const SubPixelSettings& settings)
    : design_(std::make_unique<const Design>(std::move(psf), detector, settings)) {}

SubPixelRenderer::~SubPixelRenderer() = default;

NegativeLight SubPixelRenderer::render(const Rectangle& tile, std::span<const StarLight> stars, Workspace& workspace,
                                       std::span<double> light) const {
  ASTROID_CHECK_EQ(design_->cells, 1);
  render_cells(tile, stars, workspace, light);
  double brightest = 0.0;
  for (const StarLight& star : stars) brightest = std::max(brightest, star.electrons);
  return silence(light, design_->error * brightest);
}

void SubPixelRenderer::render_cells(const Rectangle& tile, std::span<const StarLight> stars, Workspace& workspace,
                                    std::span<double> light) const {
  const Design& d = *design_;
  ASTROID_CHECK_LE(tile.nx, d.grid.tile_x);
  ASTROID_CHECK_LE(tile.ny, d.grid.tile_y);
  const auto cells = static_cast<std::size_t>(d.cells);
  ASTROID_CHECK_EQ(light.size(), tile.size() * cells * cells);
  d.convolve(tile, stars, *workspace.maps_);
  const auto margin = static_cast<std::size_t>(d.grid.margin) * cells;
  const std::size_t width = static_cast<std::size_t>(tile.nx) * cells;
  const std::size_t rows = static_cast<std::size_t>(tile.ny) * cells;
  const double* map = workspace.maps_->cells.data();
  for (std::size_t row = 0; row < rows; ++row)
    std::copy_n(map + (row + margin) * d.cell_transform.nx() + margin, width,
                light.begin() + static_cast<std::ptrdiff_t>(row * width));
}

std::span<const Rectangle> SubPixelRenderer::tiles() const {
  return design_->grid.tiles;
}
double SubPixelRenderer::reach() const {
  return design_->reach;
}
int SubPixelRenderer::cells() const {
  return design_->cells;
}
int SubPixelRenderer::sub_pixels() const {
  return design_->sub_pixels;
}
double SubPixelRenderer::band() const {
  return design_->band;
}
double SubPixelRenderer::predicted_error() const {
  return design_->error;
}
double SubPixelRenderer::workspace_bytes() const {
  return design_->grid.workspace_bytes;
}
std::size_t SubPixelRenderer::maps() const {
  return design_->psf.members.size();
}
std::size_t SubPixelRenderer::map_size() const {
  return design_->map_transform.real_size();
}

std::string SubPixelRenderer::description() const {
  const Design& d = *design_;
  return fmt::format(
      "{} on a map of {} x {} sub-pixels per pixel, convolved up to {:.3g} cycles/px in {} tiles of {} x {} px; "
      "flux in any square within {:.2g} of the star's",
      describe(d.psf), d.sub_pixels, d.sub_pixels, d.band, d.grid.tiles.size(), d.grid.tile_x, d.grid.tile_y, d.error);
}

}  // namespace astroid
