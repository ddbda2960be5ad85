#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/psf.hpp"
#include "field_weights.hpp"

namespace astroid {

namespace {

class FieldPsf final : public PixelPsf {
 public:
  FieldPsf(std::vector<PixelPosition> nodes, std::vector<std::shared_ptr<const PixelPsf>> members)
      : weights_(std::move(nodes)), members_(std::move(members)) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    blend(centre, fractions,
          [&](const PixelPsf& member, std::span<double> part) { member.integrate(centre, box, part); });
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    const double start = is_finite(centre) ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    std::ranges::fill(dpdx, start);
    std::ranges::fill(dpdy, start);
    if (!is_finite(centre)) return;
    const std::size_t n = members_.size();
    std::vector<double> weight(n), along_x(n), along_y(n);
    weights_.at(centre, weight);
    weights_.gradient(centre, along_x, along_y);
    std::vector<double> p(box.size()), px(box.size()), py(box.size());
    for (std::size_t k = 0; k < n; ++k) {
      members_[k]->integrate(centre, box, p);
      members_[k]->integrate_gradient(centre, box, px, py);
      for (std::size_t i = 0; i < p.size(); ++i) {
        dpdx[i] += weight[k] * px[i] + along_x[k] * p[i];
        dpdy[i] += weight[k] * py[i] + along_y[k] * p[i];
      }
    }
  }

  void integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                           std::span<double> fractions, std::vector<double>& scratch) const override {
    blend(centre, fractions, [&](const PixelPsf& member, std::span<double> part) {
      member.integrate_broadened(centre, motion, box, part, scratch);
    });
  }

  void add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                std::vector<double>& scratch) const override {
    if (!is_finite(star.centre) || intersect(stamp_box(star.centre, star.half_width), image.area()).empty()) return;
    std::vector<double> weight(members_.size());
    weights_.at(star.centre, weight);
    StarLight part = star;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      part.electrons = star.electrons * weight[k];
      if (part.electrons != 0.0) members_[k]->add_star(part, image, scratch);
    }
  }

  [[nodiscard]] double stamp_half_width(double lost) const override {
    double widest = 0.0;
    for (const auto& member : members_) widest = std::max(widest, member->stamp_half_width(lost));
    return widest;
  }

  [[nodiscard]] double approximation_error() const override {
    double worst = 0.0;
    for (const auto& member : members_) worst = std::max(worst, member->approximation_error());
    return worst;
  }

  [[nodiscard]] std::vector<PixelPosition> places() const override { return weights_.nodes(); }

  [[nodiscard]] std::string description() const override {
    return fmt::format("{} tables over the field; the first: {}", members_.size(), members_.front()->description());
  }

 private:
  static bool is_finite(PixelPosition p) { return std::isfinite(p.x) && std::isfinite(p.y); }

  /// The weighted sum over the tables of what `make(member, values)` makes.
  template <class Make>
  void blend(PixelPosition centre, std::span<double> values, Make&& make) const {
    if (!is_finite(centre)) {
      std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    std::ranges::fill(values, 0.0);
    std::vector<double> weight(members_.size());
    weights_.at(centre, weight);
    std::vector<double> part(values.size());
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (weight[k] == 0.0) continue;
      make(*members_[k], std::span(part));
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight[k] * part[i];
    }
  }

  detail::FieldWeights weights_;
  std::vector<std::shared_ptr<const PixelPsf>> members_;
};

}  // namespace

std::shared_ptr<const PixelPsf> make_field_psf(std::span<const FieldPsfTable> tables, Pixels diffusion,
                                               const PsfAccuracy& accuracy, int phases, const PixelResponse& response) {
  detail::require_field(tables);
  std::vector<PixelPosition> nodes;
  std::vector<std::shared_ptr<const PixelPsf>> members;
  for (const FieldPsfTable& table : tables) {
    nodes.push_back(table.position);
    members.push_back(make_prf_psf(diffuse_psf_table(table.table, diffusion), accuracy, phases, response));
  }
  return std::make_shared<const FieldPsf>(std::move(nodes), std::move(members));
}

}  // namespace astroid
