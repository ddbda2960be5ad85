#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/psf_spectrum.hpp"
#include "astroid/core/units.hpp"
#include "circular_profile.hpp"
#include "gauss_legendre.hpp"
#include "sub_pixel/band_error.hpp"

namespace astroid {

namespace {

using Complex = std::complex<double>;

constexpr double kTurnsPerPanel = 6.0;

/// A circular profile that ends within a square: both coordinates mirror, so the transform is real and one of cosines.
class CircularSpectrum final : public PsfSpectrum {
 public:
  CircularSpectrum(detail::CircularProfile profile, int reach) : profile_(std::move(profile)), reach_(reach) {}

  void sample(std::span<const double> kx, std::span<const double> ky, std::span<Complex> values) const override {
    ASTROID_CHECK_EQ(values.size(), kx.size() * ky.size());
    double highest = 0.0;
    for (const auto list : {kx, ky})
      for (const double k : list) highest = std::max(highest, std::abs(k));
    // Light that is a diffraction pattern turns too, once in its own scale at most.
    const double turns = highest + 0.5 / profile_.scale;
    const auto nodes = detail::gauss_legendre(0.0, reach_, std::min(2.0 * profile_.scale, kTurnsPerPanel / turns));
    const std::size_t n = nodes.size();
    const auto cosines = [&](double k, std::vector<double>& along) {
      along.resize(n);
      for (std::size_t i = 0; i < n; ++i) {
        const double turn = k * nodes[i].place;
        along[i] = 2.0 * nodes[i].weight * det::cos(2.0 * kPi * (turn - std::floor(turn)));
      }
    };
    // Along x first, row of nodes by row: the density of a row is wanted once.
    std::vector<double> along_x(n * kx.size());  // [node x][kx]
    std::vector<double> cosine;
    for (std::size_t c = 0; c < kx.size(); ++c) {
      cosines(kx[c], cosine);
      for (std::size_t i = 0; i < n; ++i) along_x[i * kx.size() + c] = cosine[i];
    }
    std::vector<double> rows(n * kx.size(), 0.0);  // [node y][kx]
    for (std::size_t j = 0; j < n; ++j) {
      double* row = &rows[j * kx.size()];
      const double y2 = nodes[j].place * nodes[j].place;
      for (std::size_t i = 0; i < n; ++i)
        add_scaled(&along_x[i * kx.size()], profile_.density(nodes[i].place * nodes[i].place + y2), kx.size(), row);
    }
    std::vector<double> line(kx.size());
    for (std::size_t q = 0; q < ky.size(); ++q) {
      // Frequencies come in pairs mostly, of which the later one is a copy.
      const std::size_t mirror = ky.size() - 1 - q;
      Complex* out = &values[q * kx.size()];
      if (mirror < q && ky[mirror] == -ky[q]) {
        std::copy_n(&values[mirror * kx.size()], kx.size(), out);
        continue;
      }
      cosines(ky[q], cosine);
      std::ranges::fill(line, 0.0);
      for (std::size_t j = 0; j < n; ++j) add_scaled(&rows[j * kx.size()], cosine[j], kx.size(), line.data());
      std::ranges::copy(line, out);
    }
  }

  // Outside the square of half-width r is no more than outside the circle in it, as far as there is light.
  [[nodiscard]] double reach(double lost) const override {
    constexpr double kStep = 0.25;  // px
    double beyond = 0.0;
    double r = reach_ * std::sqrt(2.0);
    while (r > kStep) {
      for (const detail::QuadratureNode& node : detail::gauss_legendre(r - kStep, r, 2.0 * profile_.scale))
        beyond += 2.0 * kPi * node.weight * node.place * profile_.density(node.place * node.place);
      if (beyond >= lost) break;
      r -= kStep;
    }
    return std::min(r, reach_);
  }

  [[nodiscard]] double error_beyond(double band) const override {
    std::call_once(measured_, [this] {
      band_error_.emplace(PixelPosition{-reach_, -reach_}, PixelPosition{reach_, reach_},
                          [this](PixelPosition lower, PixelPosition upper) {
                            const auto inside = [this](double v) { return std::clamp(v, -reach_, reach_); };
                            return detail::profile_flux(profile_, {inside(lower.x), inside(lower.y)},
                                                        {inside(upper.x), inside(upper.y)});
                          });
    });
    // Beyond what a map can hold rounding is left.
    constexpr double kMostTurns = 600.0;  // over the reach
    const double measured = std::min(band, kMostTurns / reach_);
    return band_error_->of(*this, measured) * measured / band;
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("{}, faded out {} px from the star", profile_.name, reach_);
  }

 private:
  static void add_scaled(const double* from, double factor, std::size_t count, double* to) {
    for (std::size_t i = 0; i < count; ++i) to[i] += factor * from[i];
  }

  detail::CircularProfile profile_;
  double reach_;
  mutable std::once_flag measured_;
  mutable std::optional<detail::BandError> band_error_;
};

std::shared_ptr<const PsfSpectrum> make(const detail::CircularProfile& profile, const PsfWings& wings) {
  return std::make_shared<const CircularSpectrum>(detail::as_imaged(profile, wings), wings.reach);
}

}  // namespace

std::shared_ptr<const PsfSpectrum> make_moffat_spectrum(double fwhm, double beta, const PsfWings& wings) {
  return make(detail::moffat_profile(fwhm, beta, wings), wings);
}

std::shared_ptr<const PsfSpectrum> make_airy_spectrum(double lambda_over_d, double obscuration, const PsfWings& wings) {
  return make(detail::airy_profile(lambda_over_d, obscuration, wings), wings);
}

}  // namespace astroid
