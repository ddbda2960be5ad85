#include "astroid/test/quadrature.hpp"

#include <array>
#include <cmath>

namespace astroid::test {

namespace {

constexpr long double kPiLong = 3.14159265358979323846264338327950288L;

// Nodes and weights of QUADPACK's QK15 (Piessens et al. 1983); every second node belongs to the 7-point Gauss rule.
constexpr std::array<long double, 8> kNodes = {
    0.991455371120812639206854697526328517L, 0.949107912342758524526189684047851262L,
    0.864864423359769072789712788640926201L, 0.741531185599394439863864773280788407L,
    0.586087235467691130294144171693137352L, 0.405845151377397166906606412076961463L,
    0.207784955007898467600689403773244913L, 0.0L};
constexpr std::array<long double, 8> kKronrod = {
    0.022935322010529224963732008058969592L, 0.063092092629978553290700663189204287L,
    0.104790010322250183839876322541518017L, 0.140653259715525918745189590510237920L,
    0.169004726639267902826583426598550284L, 0.190350578064785409913256402421013683L,
    0.204432940075298892414161999234649085L, 0.209482141084727828012999174891714264L};
constexpr std::array<long double, 4> kGauss = {
    0.129484966168869693270611432679082018L, 0.279705391489276667901467771423779582L,
    0.381830050505118944950369775488975134L, 0.417959183673469387755102040816326531L};

struct Estimate {
  long double value;
  long double absolute;  // integral of |f|
  long double error;
};

Estimate kronrod(const std::function<long double(long double)>& f, long double from, long double to) {
  const long double middle = 0.5L * (from + to);
  const long double half = 0.5L * (to - from);
  const long double centre = f(middle);
  long double value = kKronrod[7] * centre;
  long double absolute = kKronrod[7] * std::abs(centre);
  long double gauss = kGauss[3] * centre;
  for (std::size_t i = 0; i < 7; ++i) {
    const long double left = f(middle - half * kNodes[i]);
    const long double right = f(middle + half * kNodes[i]);
    value += kKronrod[i] * (left + right);
    absolute += kKronrod[i] * (std::abs(left) + std::abs(right));
    if (i % 2 == 1) gauss += kGauss[i / 2] * (left + right);
  }
  return {value * half, absolute * half, std::abs(value - gauss) * half};
}

long double refine(const std::function<long double(long double)>& f, long double from, long double to,
                   long double relative, int depth) {
  const Estimate whole = kronrod(f, from, to);
  if (depth == 0 || whole.error <= relative * whole.absolute) return whole.value;
  const long double middle = 0.5L * (from + to);
  return refine(f, from, middle, relative, depth - 1) + refine(f, middle, to, relative, depth - 1);
}

// The 7-point Kronrod rule about the 3-point Gauss rule: enough for the pieces of a spline.
Integral small_rule(const std::function<long double(long double)>& f, long double from, long double to) {
  constexpr std::array<long double, 3> kSmallNodes = {
      0.960491268708020283423507092629080L, 0.774596669241483377035853079956480L, 0.434243749346802558002071502844628L};
  constexpr std::array<long double, 4> kSmallKronrod = {
      0.104656226026467265193823857192073L, 0.268488089868333440728569280666710L, 0.401397414775962222905051818618432L,
      0.450916538658474142345110087045571L};
  const long double middle = 0.5L * (from + to);
  const long double half = 0.5L * (to - from);
  const long double centre = f(middle);
  long double value = kSmallKronrod[3] * centre;
  long double gauss = 8.0L / 9.0L * centre;
  for (std::size_t i = 0; i < 3; ++i) {
    const long double both = f(middle - half * kSmallNodes[i]) + f(middle + half * kSmallNodes[i]);
    value += kSmallKronrod[i] * both;
    if (i == 1) gauss += 5.0L / 9.0L * both;
  }
  return {value * half, std::abs(value - gauss) * half};
}

Integral refine_absolute(const std::function<long double(long double)>& f, long double from, long double to,
                         long double absolute, int depth) {
  constexpr long double kRounding = 1e-18L;
  const Estimate whole = kronrod(f, from, to);
  if (depth == 0 || whole.error <= absolute || whole.error <= kRounding * whole.absolute)
    return {whole.value, whole.error};
  const long double middle = 0.5L * (from + to);
  Integral sum = refine_absolute(f, from, middle, 0.5L * absolute, depth - 1);
  sum += refine_absolute(f, middle, to, 0.5L * absolute, depth - 1);
  return sum;
}

constexpr int kDeepest = 24;

}  // namespace

Integral integrate_absolute(const std::function<long double(long double)>& f, long double from, long double to,
                            long double absolute) {
  const Integral small = small_rule(f, from, to);
  if (small.error <= absolute) return small;
  return refine_absolute(f, from, to, absolute, kDeepest);
}

long double integrate(const std::function<long double(long double)>& f, long double from, long double to,
                      long double relative) {
  return refine(f, from, to, relative, kDeepest);
}

long double integrate_pixel(const Density& density, PixelPosition star, int x, int y, long double relative) {
  const auto left = static_cast<long double>(x) - 0.5L - static_cast<long double>(star.x);
  const auto bottom = static_cast<long double>(y) - 0.5L - static_cast<long double>(star.y);
  return integrate(
      [&](long double dy) {
        return integrate([&](long double dx) { return density(dx, dy); }, left, left + 1.0L, relative);
      },
      bottom, bottom + 1.0L, relative);
}

Density gaussian_density(long double sigma) {
  return [sigma](long double dx, long double dy) {
    return std::exp(-(dx * dx + dy * dy) / (2.0L * sigma * sigma)) / (2.0L * kPiLong * sigma * sigma);
  };
}

Density moffat_density(long double fwhm, long double beta) {
  const long double alpha = fwhm / (2.0L * std::sqrt(std::pow(2.0L, 1.0L / beta) - 1.0L));
  const long double peak = (beta - 1.0L) / (kPiLong * alpha * alpha);
  return [=](long double x, long double y) { return peak * std::pow(1.0L + (x * x + y * y) / (alpha * alpha), -beta); };
}

Density airy_density(long double lambda_over_d, long double obscuration) {
  const long double e2 = obscuration * obscuration;
  const long double peak = kPiLong / 4.0L * (1.0L - e2) / (lambda_over_d * lambda_over_d);
  const auto disc = [](long double v) { return v > 0.0L ? 2.0L * std::cyl_bessel_j(1.0L, v) / v : 1.0L; };
  return [=](long double x, long double y) {
    const long double v = kPiLong * std::sqrt(x * x + y * y) / lambda_over_d;
    const long double amplitude = (disc(v) - e2 * disc(obscuration * v)) / (1.0L - e2);
    return peak * amplitude * amplitude;
  };
}

}  // namespace astroid::test
