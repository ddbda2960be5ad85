#include "astroid/test/star_field.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"

namespace astroid::test {

StarField make_star_field(const StarFieldSettings& settings) {
  const RandomStream places = make_stream(settings.seed, StreamId{1}, 0, 0);
  std::uint64_t word = 0;
  const auto unit = [&] { return uniform_at_step(places, StepAddress{.step = word++}); };
  const auto width = static_cast<std::size_t>(settings.nx);
  StarField field;
  std::vector<double> light(width * static_cast<std::size_t>(settings.ny), settings.sky);
  const double sigma = settings.fwhm / 2.3548200450309493;
  const double k = 1.0 / (std::sqrt(2.0) * sigma);
  const auto share = [k](double u, int i) { return 0.5 * (std::erf((i + 0.5 - u) * k) - std::erf((i - 0.5 - u) * k)); };
  const double low = std::pow(10.0, settings.slope * settings.bright);
  const double high = std::pow(10.0, settings.slope * settings.faint);
  for (int n = 0; n < settings.stars; ++n) {
    const double mag = std::log10(low + unit() * (high - low)) / settings.slope;
    TrueStar star;
    star.x = unit() * settings.nx - 0.5;
    star.y = unit() * settings.ny - 0.5;
    star.flux = std::pow(10.0, 0.4 * (25.0 - mag));
    field.stars.push_back(star);
    const int reach = static_cast<int>(std::ceil(9.0 * sigma));
    const int x0 = static_cast<int>(std::lround(star.x));
    const int y0 = static_cast<int>(std::lround(star.y));
    std::vector<double> columns;
    for (int x = x0 - reach; x <= x0 + reach; ++x) columns.push_back(star.flux * share(star.x, x));
    for (int y = std::max(0, y0 - reach); y <= std::min(settings.ny - 1, y0 + reach); ++y) {
      const double line = share(star.y, y);
      for (int x = std::max(0, x0 - reach); x <= std::min(settings.nx - 1, x0 + reach); ++x)
        light[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] +=
            line * columns[static_cast<std::size_t>(x - x0 + reach)];
    }
  }
  const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, settings.nx, settings.ny}});
  field.frame.pixels = Plane<float, unit::Adu>(layout);
  field.frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  field.frame.header.readout_noise = Electrons(settings.read_noise);
  const RandomStream noise = make_stream(settings.seed, StreamId{2}, 0, 0);
  for (std::size_t i = 0; i < light.size(); ++i) {
    const std::uint64_t step = 2 * i;
    const double photons = poisson_at_step(noise, StepAddress{.step = step}, light[i]);
    const double readout = settings.read_noise * normal_at_step(noise, StepAddress{.step = step + 1});
    field.frame.pixels.pixels()[i] = static_cast<float>(photons + readout);
  }
  return field;
}

}  // namespace astroid::test
