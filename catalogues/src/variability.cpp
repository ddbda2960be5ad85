#include "astroid/catalogues/variability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// sin(x) / x.
double sinc(double x) {
  return std::fabs(x) < 1e-8 ? 1.0 : det::sin(x) / x;
}

double mean_of(const SinusoidalVariation& s, double begin, double end) {
  const double turns = 0.5 * (begin + end) / s.period + s.phase;
  const double sine = det::sin(2.0 * kPi * (turns - std::floor(turns)));
  return s.amplitude * sine * sinc(kPi * (end - begin) / s.period);
}

/// Integral of a trapezoid of unit height from its begin to `t` after it.
double trapezoid(const PeriodicDips& d, double t) {
  const double inside = std::clamp(t, 0.0, d.duration);
  const double rising = std::min(inside, d.ingress);
  const double falling = std::max(0.0, inside - (d.duration - d.ingress));
  double area = inside - rising - falling;
  if (d.ingress > 0.0) area += 0.5 * rising * rising / d.ingress + falling * (1.0 - 0.5 * falling / d.ingress);
  return area;
}

double mean_of(const PeriodicDips& d, double begin, double end) {
  // Whole periods are counted apart from the parts, which would lose digits among them.
  const double first = d.epoch - 0.5 * d.duration;
  const auto split = [&](double time) {
    const double number = std::floor((time - first) / d.period);
    return std::pair(number, trapezoid(d, time - first - number * d.period));
  };
  const auto [begin_number, begin_area] = split(begin);
  const auto [end_number, end_area] = split(end);
  const double area = (end_number - begin_number) * (d.duration - d.ingress) + end_area - begin_area;
  return -d.depth * area / (end - begin);
}

double mean_of(const SampledVariation& s, double begin, double end) {
  const auto integral = [&s](double time) {
    const auto above = std::upper_bound(s.time.begin() + 1, s.time.end() - 1, time);
    const auto i = static_cast<std::size_t>(above - s.time.begin()) - 1;
    const double t = time - s.time[i];
    const double slope = (s.flux[i + 1] - s.flux[i]) / (s.time[i + 1] - s.time[i]);
    return s.integral[i] + t * (s.flux[i] + 0.5 * slope * t);
  };
  return (integral(end) - integral(begin)) / (end - begin) - 1.0;
}

/// Smallest and largest difference from 1.
struct Extent {
  double low, high;
};
Extent extent_of(const VariationComponent& component) {
  return std::visit(Overloaded{[](const SinusoidalVariation& s) {
                                 return Extent{-s.amplitude, s.amplitude};
                               },
                               [](const PeriodicDips& d) {
                                 return Extent{-d.depth, 0.0};
                               },
                               [](const std::shared_ptr<const SampledVariation>& s) {
                                 const auto [low, high] = std::ranges::minmax(s->flux);
                                 return Extent{low - 1.0, high - 1.0};
                               }},
                    component);
}

}  // namespace

double Variability::mean(double begin, double end) const {
  double flux = 1.0;
  for (const VariationComponent& component : components_)
    flux +=
        std::visit(Overloaded{[&](const std::shared_ptr<const SampledVariation>& s) { return mean_of(*s, begin, end); },
                              [&](const auto& c) { return mean_of(c, begin, end); }},
                   component);
  return std::max(0.0, flux);  // rounding
}

double Variability::largest_change() const {
  double low = 0.0;
  double high = 0.0;
  for (const VariationComponent& component : components_) {
    const Extent extent = extent_of(component);
    low += extent.low;
    high += extent.high;
  }
  return std::max(-low, high);
}

double Variability::least() const {
  double flux = 1.0;
  for (const VariationComponent& component : components_) flux += extent_of(component).low;
  return flux;
}

std::string Variability::description() const {
  constexpr double kPpm = 1e6;
  std::string text;
  for (const VariationComponent& component : components_) {
    if (!text.empty()) text += " + ";
    text += std::visit(
        Overloaded{
            [](const SinusoidalVariation& s) {
              return fmt::format("sinusoid of {:.10g} ppm, period {:.12g} s, phase {:.12g} turns", kPpm * s.amplitude,
                                 s.period, s.phase);
            },
            [](const PeriodicDips& d) {
              return fmt::format(
                  "dips of {:.10g} ppm, duration {:.12g} s, ingress {:.12g} s, period {:.12g} s, epoch {:.12g} s",
                  kPpm * d.depth, d.duration, d.ingress, d.period, d.epoch);
            },
            [](const std::shared_ptr<const SampledVariation>& s) {
              return fmt::format("light curve {} of {} samples", s->file, s->time.size());
            }},
        component);
  }
  return text;
}

}  // namespace astroid
