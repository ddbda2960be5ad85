#include "astroid/core/textbook_psf.hpp"

#include <fmt/format.h>
#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "flux_spline.hpp"

namespace astroid {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What all of them have in common: a pixel is a function of the star's place.
class PixelByPixel : public PixelPsf {
 public:
  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    // Nobody measures with these PSFs: differences do.
    constexpr double kStep = 1e-4;  // px
    std::vector<double> before(box.size());
    const auto difference = [&](PixelShift step, std::span<double> out) {
      integrate({centre.x + step.dx, centre.y + step.dy}, box, out);
      integrate({centre.x - step.dx, centre.y - step.dy}, box, before);
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = (out[i] - before[i]) / (2.0 * kStep);
    };
    difference({kStep, 0.0}, dpdx);
    difference({0.0, kStep}, dpdy);
  }
  [[nodiscard]] double approximation_error() const override { return kNan; }
};

class ExactTablePsf final : public PixelByPixel {
 public:
  explicit ExactTablePsf(const PsfTable& table) : spline_(table), stamps_(make_prf_psf(table, 1.0)) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    std::size_t i = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x)
        fractions[i++] =
            spline_.flux({x - 0.5 - centre.x, y - 0.5 - centre.y}, {x + 0.5 - centre.x, y + 0.5 - centre.y});
  }
  [[nodiscard]] double stamp_half_width(double lost) const override { return stamps_->stamp_half_width(lost); }
  [[nodiscard]] double approximation_error() const override { return 0.0; }
  [[nodiscard]] std::string description() const override { return "exact integral of a table"; }

 private:
  detail::FluxSpline spline_;
  std::shared_ptr<const PixelPsf> stamps_;
};

/// Samples of the surface brightness in every pixel, weighted.
class SampledPsf final : public PixelByPixel {
 public:
  struct Node {
    double place, weight;  // px from the pixel's centre
  };
  SampledPsf(std::string name, std::vector<Node> nodes, TextbookSource source)
      : name_(std::move(name)), nodes_(std::move(nodes)), source_(std::move(source)) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    std::size_t i = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x) {
        double sum = 0.0;
        for (const Node& v : nodes_) {
          double row = 0.0;
          for (const Node& u : nodes_)
            row += u.weight * source_.brightness(x + u.place - centre.x, y + v.place - centre.y);
          sum += v.weight * row;
        }
        fractions[i++] = sum;
      }
  }
  [[nodiscard]] double stamp_half_width(double lost) const override { return source_.exact->stamp_half_width(lost); }
  [[nodiscard]] std::string description() const override { return name_; }

 private:
  std::string name_;
  std::vector<Node> nodes_;
  TextbookSource source_;
};

std::vector<SampledPsf::Node> midpoints(int n) {
  std::vector<SampledPsf::Node> nodes;
  nodes.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) nodes.push_back({(i + 0.5) / n - 0.5, 1.0 / n});
  return nodes;
}

std::vector<SampledPsf::Node> gauss_nodes(int n) {
  gsl_integration_glfixed_table* const table = gsl_integration_glfixed_table_alloc(static_cast<std::size_t>(n));
  std::vector<SampledPsf::Node> nodes(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    gsl_integration_glfixed_point(-0.5, 0.5, i, &nodes[i].place, &nodes[i].weight, table);
  gsl_integration_glfixed_table_free(table);
  return nodes;
}

/// Exact images at regular phases of the star's pixel, and the nearest one or an interpolation.
class TabulatedPsf final : public PixelByPixel {
 public:
  TabulatedPsf(std::string name, int taps, int phases, TextbookSource source)
      : name_(std::move(name)),
        taps_(taps),
        phases_(phases),
        first_(-source.reach - kBorder),
        side_(2 * source.reach + 1 + 2 * kBorder),
        exact_(std::move(source.exact)) {
    const auto count = static_cast<std::size_t>(phases_);
    const std::size_t pixels = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    images_.resize(count * count * pixels);
    // The nearest phase is that of the sub-pixel's centre.
    const double offset = taps_ == 1 ? 0.5 / phases_ : 0.0;
    for (std::size_t q = 0; q < count; ++q)
      for (std::size_t p = 0; p < count; ++p)
        exact_->integrate({static_cast<double>(p) / phases_ + offset, static_cast<double>(q) / phases_ + offset},
                          {first_, first_, side_, side_}, std::span(images_).subspan((q * count + p) * pixels, pixels));
  }

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    std::ranges::fill(fractions, 0.0);
    const Axis x = axis(centre.x);
    const Axis y = axis(centre.y);
    for (int j = 0; j < taps_; ++j)
      for (int i = 0; i < taps_; ++i) add(x, y, i, j, box, fractions);
  }
  [[nodiscard]] double stamp_half_width(double lost) const override { return exact_->stamp_half_width(lost); }
  [[nodiscard]] std::string description() const override { return name_; }

 private:
  static constexpr int kBorder = 2;  // a tap may be a phase of the next pixel
  struct Tap {
    int phase = 0;
    int pixel = 0;
    double weight = 0.0;
  };
  using Axis = std::array<Tap, 4>;

  [[nodiscard]] Axis axis(double position) const {
    const double pixel = std::floor(position);
    const double s = (position - pixel) * phases_;
    const double node = std::min(std::floor(s), phases_ - 1.0);
    const double t = s - node;
    std::array<double, 4> weights{1.0, 0.0, 0.0, 0.0};
    if (taps_ == 2) weights = {1.0 - t, t, 0.0, 0.0};
    if (taps_ == 4)
      weights = {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                 -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
    Axis taps;
    for (int k = 0; k < taps_; ++k) {
      const int phase = static_cast<int>(node) + k - (taps_ == 4 ? 1 : 0);
      const int shift = phase < 0 ? -1 : phase / phases_;
      taps[static_cast<std::size_t>(k)] = {phase - shift * phases_, static_cast<int>(pixel) + shift,
                                           weights[static_cast<std::size_t>(k)]};
    }
    return taps;
  }

  void add(const Axis& x, const Axis& y, int i, int j, Rectangle box, std::span<double> fractions) const {
    const Tap& u = x[static_cast<std::size_t>(i)];
    const Tap& v = y[static_cast<std::size_t>(j)];
    const double weight = u.weight * v.weight;
    const auto side = static_cast<std::size_t>(side_);
    const double* const image = &images_[static_cast<std::size_t>(v.phase * phases_ + u.phase) * side * side];
    const Rectangle known = intersect(box, {u.pixel + first_, v.pixel + first_, side_, side_});
    for (int row = known.y0; row < known.y1(); ++row) {
      const double* from =
          image + static_cast<std::ptrdiff_t>(row - v.pixel - first_) * side_ + (known.x0 - u.pixel - first_);
      double* to = fractions.data() + static_cast<std::ptrdiff_t>(row - box.y0) * box.nx + (known.x0 - box.x0);
      for (int column = 0; column < known.nx; ++column) to[column] += weight * from[column];
    }
  }

  std::string name_;
  int taps_;
  int phases_;
  int first_;
  int side_;
  std::shared_ptr<const PixelPsf> exact_;
  std::vector<double> images_;  // [phase y][phase x][row][column]
};

}  // namespace

SurfaceBrightness gaussian_brightness(double sigma) {
  const double scale = -0.5 / (sigma * sigma);
  const double peak = 1.0 / (2.0 * M_PI * sigma * sigma);
  return [scale, peak](double dx, double dy) { return peak * std::exp(scale * (dx * dx + dy * dy)); };
}

SurfaceBrightness table_brightness(const PsfTable& table) {
  return [spline = detail::FluxSpline(table)](double dx, double dy) { return spline.density({dx, dy}); };
}

std::shared_ptr<const PixelPsf> make_exact_table_psf(const PsfTable& table) {
  return std::make_shared<const ExactTablePsf>(table);
}

std::string to_string(TextbookMethod method, int n) {
  switch (method) {
    case TextbookMethod::kSnap:
      return fmt::format("snap to {} sub-pixels", n);
    case TextbookMethod::kMidpoint:
      return fmt::format("midpoint {}", n);
    case TextbookMethod::kGaussLegendre:
      return fmt::format("Gauss-Legendre {}", n);
    case TextbookMethod::kLinear:
      return fmt::format("{} phases linear", n);
    case TextbookMethod::kCubic:
      return fmt::format("{} phases cubic", n);
  }
  throw BugError("unknown method");
}

double textbook_bytes(TextbookMethod method, int n, int reach) {
  if (method == TextbookMethod::kMidpoint || method == TextbookMethod::kGaussLegendre) return 0.0;
  constexpr int kBorders = 5;  // the star's pixel, and two on either side
  const double side = 2.0 * reach + kBorders;
  return static_cast<double>(sizeof(double)) * n * n * side * side;
}

std::shared_ptr<const PixelPsf> make_textbook_psf(TextbookMethod method, int n, TextbookSource source) {
  const int most = method == TextbookMethod::kGaussLegendre ? 10 : 1000;
  if (n < 1 || n > most)
    throw InputError(Problem{.parameter = "n",
                             .value = fmt::format("{}", n),
                             .expected = fmt::format("1 to {}", most),
                             .message = "a star cannot be sampled like this"});
  const std::string name = to_string(method, n);
  switch (method) {
    case TextbookMethod::kSnap:
      return std::make_shared<const TabulatedPsf>(name, 1, n, std::move(source));
    case TextbookMethod::kLinear:
      return std::make_shared<const TabulatedPsf>(name, 2, n, std::move(source));
    case TextbookMethod::kCubic:
      return std::make_shared<const TabulatedPsf>(name, 4, n, std::move(source));
    case TextbookMethod::kMidpoint:
      return std::make_shared<const SampledPsf>(name, midpoints(n), std::move(source));
    case TextbookMethod::kGaussLegendre:
      return std::make_shared<const SampledPsf>(name, gauss_nodes(n), std::move(source));
  }
  throw BugError("unknown method");
}

}  // namespace astroid
