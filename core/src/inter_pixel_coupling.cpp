#include "astroid/core/inter_pixel_coupling.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace astroid {

namespace {

class CoupledPsf final : public PixelPsf {
 public:
  CoupledPsf(std::shared_ptr<const PixelPsf> psf, const InterPixelCoupling& coupling)
      : psf_(std::move(psf)), coupling_(coupling) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    const Rectangle around = grown(box);
    std::vector<double> before(around.size());
    psf_->integrate(centre, around, before);
    spread(before, box, fractions);
  }
  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    const Rectangle around = grown(box);
    std::vector<double> along_x(around.size());
    std::vector<double> along_y(around.size());
    psf_->integrate_gradient(centre, around, along_x, along_y);
    spread(along_x, box, dpdx);
    spread(along_y, box, dpdy);
  }
  void integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                           std::span<double> fractions, std::vector<double>& scratch) const override {
    const Rectangle around = grown(box);
    std::vector<double> before(around.size());
    psf_->integrate_broadened(centre, motion, around, before, scratch);
    spread(before, box, fractions);
  }
  [[nodiscard]] double stamp_half_width(double lost) const override { return psf_->stamp_half_width(lost) + 1.0; }
  [[nodiscard]] double approximation_error() const override { return psf_->approximation_error(); }
  [[nodiscard]] std::string description() const override {
    return psf_->description() + ", spread by inter-pixel capacitance";
  }

 private:
  static Rectangle grown(const Rectangle& box) { return {box.x0 - 1, box.y0 - 1, box.nx + 2, box.ny + 2}; }

  void spread(std::span<const double> before, const Rectangle& box, std::span<double> after) const {
    const auto width = static_cast<std::size_t>(box.nx);
    const std::size_t stride = width + 2;
    const double own = coupling_.own();
    for (std::size_t y = 0; y < static_cast<std::size_t>(box.ny); ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const double* p = before.data() + (y + 1) * stride + x + 1;
        const double sides = (p[-1] + p[1]) + (*(p - stride) + p[stride]);
        const double corners = (*(p - stride - 1) + *(p - stride + 1)) + (p[stride - 1] + p[stride + 1]);
        after[y * width + x] = own * p[0] + coupling_.side * sides + coupling_.corner * corners;
      }
    }
  }

  std::shared_ptr<const PixelPsf> psf_;
  InterPixelCoupling coupling_;
};

}  // namespace

std::shared_ptr<const PixelPsf> make_coupled_psf(std::shared_ptr<const PixelPsf> psf,
                                                 const InterPixelCoupling& coupling) {
  return std::make_shared<const CoupledPsf>(std::move(psf), coupling);
}

}  // namespace astroid
