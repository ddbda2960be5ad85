#include "astroid/core/distortion.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "astroid/core/error.hpp"
#include "plane_map.hpp"

namespace astroid {

namespace {

detail::MapPoint evaluate(const RadialTangential& c, double focal_length, PixelShift ideal) {
  const double x = ideal.dx / focal_length;
  const double y = ideal.dy / focal_length;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double slope = 2.0 * (c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3));  // d radial / d r2, doubled
  // Tangential terms as quadratic forms.
  const double qx = 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x) + c.s1 * r2;
  const double qy = c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y + c.s2 * r2;
  detail::MapPoint p;
  p.value = {focal_length * (x * radial + qx), focal_length * (y * radial + qy)};
  p.xx = radial + slope * x * x + 2.0 * c.p1 * y + 6.0 * c.p2 * x + 2.0 * c.s1 * x;
  p.xy = slope * x * y + 2.0 * c.p1 * x + 2.0 * c.p2 * y + 2.0 * c.s1 * y;
  p.yx = slope * x * y + 2.0 * c.p1 * x + 2.0 * c.p2 * y + 2.0 * c.s2 * x;
  p.yy = radial + slope * y * y + 6.0 * c.p1 * y + 2.0 * c.p2 * x + 2.0 * c.s2 * y;
  return p;
}

detail::MapPoint evaluate(const SipPolynomial& sip, PixelShift real) {
  // Horner's rule in v for each power of u, with derivatives; then in u.
  struct Sum {
    double value = 0.0, du = 0.0, dv = 0.0;
  };
  const double u = real.dx;
  const double v = real.dy;
  const auto sum = [&](const std::vector<double>& coefficients) {
    Sum s;
    for (int i = sip.order; i >= 0; --i) {
      double row = 0.0;
      double slope = 0.0;
      for (int j = sip.order - i; j >= 0; --j) {
        slope = slope * v + row;
        row = row * v + coefficients[sip.index(i, j)];
      }
      s.du = s.du * u + s.value;
      s.dv = s.dv * u + slope;
      s.value = s.value * u + row;
    }
    return s;
  };
  const Sum a = sum(sip.a);
  const Sum b = sum(sip.b);
  return {{u + a.value, v + b.value}, 1.0 + a.du, a.dv, b.du, 1.0 + b.dv};
}

/// Explicit from the ideal place to the real one.
class RadialDistortion final : public Distortion {
 public:
  RadialDistortion(const RadialTangential& coefficients, double focal_length)
      : coefficients_(coefficients),
        map_([coefficients, focal_length](PixelShift ideal) { return evaluate(coefficients, focal_length, ideal); }) {}
  [[nodiscard]] std::optional<PixelShift> distort(PixelShift ideal) const override { return map_.value(ideal); }
  [[nodiscard]] std::optional<PixelShift> undistort(PixelShift real) const override { return map_.solve(real); }
  [[nodiscard]] std::string description() const override {
    const RadialTangential& c = coefficients_;
    return fmt::format("radial and tangential, k1 {} k2 {} k3 {} p1 {} p2 {} s1 {} s2 {}", c.k1, c.k2, c.k3, c.p1, c.p2,
                       c.s1, c.s2);
  }

 private:
  RadialTangential coefficients_;
  detail::PlaneMap map_;
};

/// Explicit from the real place to the ideal one.
class SipDistortion final : public Distortion {
 public:
  explicit SipDistortion(SipPolynomial polynomial)
      : sip_(std::move(polynomial)), map_([this](PixelShift real) { return evaluate(sip_, real); }) {}
  [[nodiscard]] std::optional<PixelShift> distort(PixelShift ideal) const override { return map_.solve(ideal); }
  [[nodiscard]] std::optional<PixelShift> undistort(PixelShift real) const override { return map_.value(real); }
  [[nodiscard]] const SipPolynomial* sip() const override { return &sip_; }
  [[nodiscard]] std::string description() const override { return fmt::format("SIP of order {}", sip_.order); }

 private:
  SipPolynomial sip_;
  detail::PlaneMap map_;
};

Problem unusable(const char* parameter, double value, const char* expected) {
  return {.parameter = parameter,
          .value = fmt::format("{}", value),
          .expected = expected,
          .message = "the distortion cannot be used"};
}

}  // namespace

std::shared_ptr<const Distortion> make_radial_distortion(const RadialTangential& coefficients, Pixels focal_length) {
  std::vector<Problem> problems;
  const double f = focal_length.value();
  if (!(f > 0.0) || !std::isfinite(f)) problems.push_back(unusable("focal length", f, "a positive number of pixels"));
  const RadialTangential& c = coefficients;
  for (const double value : {c.k1, c.k2, c.k3, c.p1, c.p2, c.s1, c.s2})
    if (!std::isfinite(value)) problems.push_back(unusable("Telescope/Distortion", value, "finite coefficients"));
  if (!problems.empty()) throw InputError(std::move(problems));
  return std::make_shared<const RadialDistortion>(coefficients, f);
}

std::shared_ptr<const Distortion> make_sip_distortion(SipPolynomial polynomial) {
  std::vector<Problem> problems;
  if (polynomial.order < 2 || polynomial.order > SipPolynomial::kHighestOrder)
    problems.push_back(unusable("SIP order", polynomial.order, "2 .. 9"));
  for (const std::vector<double>* side : {&polynomial.a, &polynomial.b})
    for (const double value : *side)
      if (!std::isfinite(value)) problems.push_back(unusable("SIP coefficient", value, "finite coefficients"));
  if (!problems.empty()) throw InputError(std::move(problems));
  const SipPolynomial shape(polynomial.order);
  ASTROID_CHECK_EQ(polynomial.a.size(), shape.a.size());
  ASTROID_CHECK_EQ(polynomial.b.size(), shape.b.size());
  return std::make_shared<const SipDistortion>(std::move(polynomial));
}

}  // namespace astroid
