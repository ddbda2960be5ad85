#include "field/field_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/place.hpp"
#include "field/stamp_sums.hpp"
#include "small_matrix.hpp"

namespace astroid::detail {

namespace {

constexpr std::size_t kParameters = 3;
// A star's wing ends where it is this share of the noise of the sky.
constexpr double kWingLevel = 0.05;
// In units of the FWHM: a Gaussian's overlap at that distance is 3e-4 of that at zero.
constexpr double kCouplingReach = 2.4;
// Steps in position are damped as if each star were known to be within this many FWHM of where it is, and end there.
constexpr double kStepFwhm = 0.4;
// A flux that changes by less than this share of its error has settled.
constexpr double kSettled = 0.1;
// A flux may fall to this share of what it was in one step: then its position still means something.
constexpr double kLeastShare = 0.1;
// It may grow to this many times as much and so many errors, and the sky change by so many times its noise: where the
// model is far off, its light lowers the weights of the pixels that contradict it, and full steps run away.
constexpr double kMostShare = 3.0;
constexpr double kMostErrors = 20.0;

}  // namespace

FieldSolver::FieldSolver(const PixelPsf& psf, const PsfReach& reach, const FieldPixels& pixels, int sky_cell)
    : psf_(psf),
      reach_(reach),
      pixels_(pixels),
      coupling_reach_(kCouplingReach * std::max(reach.fwhm(), 1.0)),
      stamps_(psf),
      light_(pixels.electrons.nx(), pixels.electrons.ny(), pixels.electrons.pad()),
      weight_(light_.nx(), light_.ny(), light_.pad()),
      residual_(light_.nx(), light_.ny(), light_.pad()),
      sky_(light_.nx(), light_.ny(), sky_cell),
      sky_coefficients_(sky_.size(), 0.0),
      sky_slope_(sky_.size(), 0.0),
      block_weight_(sky_.blocks(), 0.0),
      block_values_(sky_.blocks(), 0.0) {
  double sum = 0.0;
  for (int y = 0; y < pixels.sky.ny(); ++y)
    for (const float level : pixels.sky.row(y)) sum += std::max(0.0, static_cast<double>(level));
  const double mean = sum / (static_cast<double>(pixels.sky.nx()) * pixels.sky.ny());
  level_ = kWingLevel * std::sqrt(mean + pixels.read_variance);
}

double FieldSolver::sky_at(double x, double y) const {
  const SplineWeights wx = sky_.x().at(x);
  const SplineWeights wy = sky_.y().at(y);
  double level = 0.0;
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t a = 0; a < 4; ++a)
      level += wy.weight[b] * wx.weight[a] * sky_coefficients_[(wy.first + b) * sky_.columns() + wx.first + a];
  const int i = std::clamp(static_cast<int>(std::floor(x + 0.5)), 0, light_.nx() - 1);
  const int j = std::clamp(static_cast<int>(std::floor(y + 0.5)), 0, light_.ny() - 1);
  return level + static_cast<double>(*pixels_.sky.at(i, j));
}

void FieldSolver::sort_stars() {
  // Rows of bands, so that stars that share pixels are near each other in memory.
  constexpr double kBand = 16.0;  // px
  std::sort(stars_.begin(), stars_.end(), [](const ModelStar& a, const ModelStar& b) {
    const double band_a = std::floor(a.y / kBand);
    const double band_b = std::floor(b.y / kBand);
    if (band_a != band_b) return band_a < band_b;
    if (a.x != b.x) return a.x < b.x;
    return a.y < b.y;
  });
}

void FieldSolver::render() {
  sort_stars();
  for (ModelStar& star : stars_) star.half = reach_.half(star.flux, level_);
  stamps_.update(stars_);
  neighbours_ = Neighbours(stars_, coupling_reach_);
  add_light();
  weigh();
}

void FieldSolver::add_light() {
  std::ranges::fill(light_.values(), 0.0F);
  for (std::size_t i = 0; i < stars_.size(); ++i) add_stamp(stamps_[i], static_cast<float>(stars_[i].flux), light_);
}

void FieldSolver::weigh() {
  const auto read_variance = static_cast<float>(pixels_.read_variance);
  std::vector<double> correction(static_cast<std::size_t>(light_.nx()));
  for (int y = 0; y < light_.ny(); ++y) {
    sky_.evaluate_row(sky_coefficients_, y, correction);
    const auto light = light_.row(y);
    const auto sky = pixels_.sky.row(y);
    const auto data = pixels_.electrons.row(y);
    const auto usable = pixels_.usable.row(y);
    const auto weight = weight_.row(y);
    const auto residual = residual_.row(y);
    for (std::size_t x = 0; x < correction.size(); ++x) {
      const float model = light[x] + (sky[x] + static_cast<float>(correction[x]));
      weight[x] = usable[x] / (read_variance + std::max(model, 0.0F));
      residual[x] = usable[x] * (data[x] - model);
    }
  }
}

void FieldSolver::assemble() {
  terms_.assign(stars_.size(), {});
  pairs_.clear();
  first_pair_.assign(stars_.size() + 1, 0);
  std::vector<float> scratch;
  for (std::size_t i = 0; i < stars_.size(); ++i) {
    const StampView stamp = stamps_[i];
    const auto plane = place_in(0, stamp.side, stamp.stride);
    if (scratch.size() < 3 * plane + 4) scratch.resize(3 * plane + 4);
    first_pair_[i] = pairs_.size();
    assemble_star(i, scratch);
  }
  first_pair_[stars_.size()] = pairs_.size();
  assemble_sky();
}

const PairTerms* FieldSolver::pair(std::size_t first, std::size_t second) const {
  for (std::size_t k = first_pair_[first]; k < first_pair_[first + 1]; ++k)
    if (pairs_[k].second == second) return &pairs_[k];
  return nullptr;
}

void FieldSolver::assemble_star(std::size_t i, std::span<float> scratch) {
  const StampView stamp = stamps_[i];
  const auto plane = place_in(0, stamp.side, stamp.stride);
  const WeightedStamp weighted{scratch.data(), scratch.data() + plane, scratch.data() + 2 * plane};
  const StampSums s = weigh_stamp(stamp, weight_, residual_, weighted);
  const double f = stars_[i].flux;
  StarTerms& t = terms_[i];
  t.curvature = {s.pp, f * s.ppx, f * s.ppy, f * f * s.pxpx, f * f * s.pxpy, f * f * s.pypy};
  t.slope = {s.rp, f * s.rpx, f * s.rpy};
  t.sky = {s.p, f * s.px, f * s.py};
  neighbours_.find(stars_[i].x, stars_[i].y, coupling_reach_, near_);
  for (const std::uint32_t k : near_) {
    if (k <= i) continue;
    PairTerms pair{static_cast<std::uint32_t>(i), k, pair_sums(stamp, weighted, stamps_[k])};
    const double g = stars_[k].flux;
    for (std::size_t a = 0; a < kParameters; ++a)
      for (std::size_t b = 0; b < kParameters; ++b) pair.curvature[3 * a + b] *= (a > 0 ? f : 1.0) * (b > 0 ? g : 1.0);
    pairs_.push_back(pair);
  }
}

void FieldSolver::assemble_sky() {
  std::ranges::fill(block_weight_, 0.0);
  std::ranges::fill(block_values_, 0.0);
  const std::size_t columns = sky_.blocks_x();
  for (int y = 0; y < light_.ny(); ++y) {
    const auto weight = weight_.row(y);
    const auto residual = residual_.row(y);
    const std::size_t row = static_cast<std::size_t>(y / SplineAxis::kBlock) * columns;
    for (std::size_t block = 0; block < columns; ++block) {
      float w = 0.0F;
      float wr = 0.0F;
      const std::size_t end = std::min(weight.size(), (block + 1) * SplineAxis::kBlock);
      for (std::size_t x = block * SplineAxis::kBlock; x < end; ++x) {
        w += weight[x];
        wr += weight[x] * residual[x];
      }
      block_weight_[row + block] += static_cast<double>(w);
      block_values_[row + block] += static_cast<double>(wr);
    }
  }
  std::ranges::fill(sky_slope_, 0.0);
  sky_.collect_blocks(block_values_, sky_slope_);
  mean_block_weight_ =
      std::accumulate(block_weight_.begin(), block_weight_.end(), 0.0) / static_cast<double>(block_weight_.size());
  if (!(mean_block_weight_ > 0.0)) mean_block_weight_ = 1.0;
}

void FieldSolver::invert_blocks() {
  inverse_.resize(stars_.size());
  const double position = 1.0 / std::pow(kStepFwhm * std::max(reach_.fwhm(), 1.0), 2);
  // A star of whose light no pixel is usable stays what it is.
  constexpr double kLeastCurvature = 1e-30;
  for (std::size_t i = 0; i < stars_.size(); ++i) {
    auto& c = terms_[i].curvature;
    c[0] += kLeastCurvature;
    c[3] += position;
    c[5] += position;
    inverse_[i] = inverse_of_symmetric(c);
  }
}

void FieldSolver::multiply(std::span<const double> v, std::span<double> product) const {
  const std::size_t n = stars_.size();
  const std::size_t sky = kParameters * n;
  const auto sky_in = v.subspan(sky);
  const auto sky_out = product.subspan(sky);
  sky_.evaluate_blocks(sky_in, block_values_);
  for (std::size_t b = 0; b < block_values_.size(); ++b) block_values_[b] *= block_weight_[b];
  std::ranges::fill(sky_out, 0.0);
  sky_.collect_blocks(block_values_, sky_out);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& t = terms_[i];
    const double* u = v.data() + kParameters * i;
    const SplineWeights wx = sky_.x().at(stars_[i].x);
    const SplineWeights wy = sky_.y().at(stars_[i].y);
    const double light = t.sky[0] * u[0] + t.sky[1] * u[1] + t.sky[2] * u[2];
    double level = 0.0;
    for (std::size_t b = 0; b < 4; ++b) {
      const std::size_t row = (wy.first + b) * sky_.columns() + wx.first;
      for (std::size_t a = 0; a < 4; ++a) {
        const double w = wy.weight[b] * wx.weight[a];
        level += w * sky_in[row + a];
        sky_out[row + a] += w * light;
      }
    }
    double* out = product.data() + kParameters * i;
    const auto& c = t.curvature;
    out[0] = c[0] * u[0] + c[1] * u[1] + c[2] * u[2] + t.sky[0] * level;
    out[1] = c[1] * u[0] + c[3] * u[1] + c[4] * u[2] + t.sky[1] * level;
    out[2] = c[2] * u[0] + c[4] * u[1] + c[5] * u[2] + t.sky[2] * level;
  }
  for (const PairTerms& pair : pairs_) {
    const double* a = v.data() + kParameters * pair.first;
    const double* b = v.data() + kParameters * pair.second;
    double* out_a = product.data() + kParameters * pair.first;
    double* out_b = product.data() + kParameters * pair.second;
    const auto& c = pair.curvature;
    for (std::size_t k = 0; k < kParameters; ++k) {
      out_a[k] += c[3 * k] * b[0] + c[3 * k + 1] * b[1] + c[3 * k + 2] * b[2];
      out_b[k] += c[k] * a[0] + c[3 + k] * a[1] + c[6 + k] * a[2];
    }
  }
}

void FieldSolver::precondition(std::span<const double> v, std::span<double> result) const {
  const std::size_t n = stars_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double* u = v.data() + kParameters * i;
    double* out = result.data() + kParameters * i;
    const auto& m = inverse_[i];
    for (std::size_t k = 0; k < kParameters; ++k) out[k] = m[3 * k] * u[0] + m[3 * k + 1] * u[1] + m[3 * k + 2] * u[2];
  }
  const auto sky = result.subspan(kParameters * n);
  std::ranges::copy(v.subspan(kParameters * n), sky.begin());
  sky_.solve_gram(sky);
  for (double& value : sky) value /= mean_block_weight_;
}

std::size_t FieldSolver::step(double tolerance, int most_iterations) {
  invert_blocks();
  const std::size_t n = stars_.size();
  const std::size_t unknowns = kParameters * n + sky_.size();
  std::vector<double> residual(unknowns);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < kParameters; ++k) residual[kParameters * i + k] = terms_[i].slope[k];
  std::ranges::copy(sky_slope_, residual.begin() + static_cast<std::ptrdiff_t>(kParameters * n));

  std::vector<double> solution(unknowns, 0.0);
  std::vector<double> conditioned(unknowns);
  std::vector<double> product(unknowns);
  precondition(residual, conditioned);
  std::vector<double> direction = conditioned;
  double rho = std::inner_product(residual.begin(), residual.end(), conditioned.begin(), 0.0);
  const double enough = tolerance * tolerance * rho;
  for (int i = 0; i < most_iterations && rho > enough && rho > 0.0; ++i) {
    multiply(direction, product);
    const double curvature = std::inner_product(direction.begin(), direction.end(), product.begin(), 0.0);
    if (!(curvature > 0.0)) break;
    const double alpha = rho / curvature;
    for (std::size_t k = 0; k < unknowns; ++k) {
      solution[k] += alpha * direction[k];
      residual[k] -= alpha * product[k];
    }
    precondition(residual, conditioned);
    const double next = std::inner_product(residual.begin(), residual.end(), conditioned.begin(), 0.0);
    const double beta = next / rho;
    rho = next;
    for (std::size_t k = 0; k < unknowns; ++k) direction[k] = conditioned[k] + beta * direction[k];
  }

  const double most = kStepFwhm * std::max(reach_.fwhm(), 1.0);
  std::size_t unsettled = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double* delta = solution.data() + kParameters * i;
    ModelStar& star = stars_[i];
    const double error = terms_[i].curvature[0] > 0.0 ? 1.0 / std::sqrt(terms_[i].curvature[0]) : 0.0;
    const double flux =
        std::clamp(star.flux + delta[0], kLeastShare * star.flux, kMostShare * star.flux + kMostErrors * error);
    star.change = std::abs(flux - star.flux) * std::sqrt(terms_[i].curvature[0]);
    unsettled += star.change > kSettled ? 1 : 0;
    star.flux = flux;
    star.x += std::clamp(delta[1], -most, most);
    star.y += std::clamp(delta[2], -most, most);
  }
  for (std::size_t k = 0; k < sky_coefficients_.size(); ++k) {
    const double sky = sky_coefficients_[k];
    const double noise = std::sqrt(std::max(0.0, sky) + pixels_.read_variance);
    const double most_sky = kMostErrors * noise + kLeastShare * std::abs(sky);
    sky_coefficients_[k] = sky + std::clamp(solution[kParameters * n + k], -most_sky, most_sky);
  }
  return unsettled;
}

}  // namespace astroid::detail
