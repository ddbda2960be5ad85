#include "astroid/photometry/artificial_stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/statistics/robust.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr StreamId kPlaces{0xa57a0001};
constexpr StreamId kPhotons{0xa57a0002};

struct AddedStar {
  PixelPosition place{0.0, 0.0};
  double flux = 0.0;  // e-, expected
};

void check(const ArtificialStarSettings& s) {
  if (s.stars > 0 && s.faintest > 0.0 && s.brightest > s.faintest && s.bin > 0.0 && s.spacing >= 1.0 && s.match > 0.0)
    return;
  throw InputError(Problem{.parameter = "artificial stars",
                           .value = fmt::format("{} of {} to {} e-", s.stars, s.faintest, s.brightest),
                           .expected = "at least one, of fluxes 0 < faintest < brightest",
                           .message = "no stars can be added"});
}

// One star in each square of a grid that begins at a random place, as long as there are stars to place.
std::vector<AddedStar> place_stars(const Rectangle& area, const ArtificialStarSettings& s, std::uint64_t run,
                                   std::size_t most) {
  const RandomStream stream = make_stream(s.seed, kPlaces, static_cast<std::uint32_t>(run), 0);
  std::uint64_t word = 0;
  const auto unit = [&] { return uniform_at_step(stream, StepAddress{.step = word++}); };
  // Half a square is left free between two stars that come as near to each other as they can.
  const double side = 2.0 * s.spacing;
  const double x0 = area.x0 - side * unit();
  const double y0 = area.y0 - side * unit();
  std::vector<AddedStar> stars;
  const double range = det::log(s.brightest / s.faintest);
  for (double y = y0; y < area.y1(); y += side)
    for (double x = x0; x < area.x1(); x += side) {
      const PixelPosition place{x + s.spacing * unit(), y + s.spacing * unit()};
      const double flux = s.faintest * det::exp(range * unit());
      if (place.x < area.x0 || place.x > area.x1() - 1 || place.y < area.y0 || place.y > area.y1() - 1) continue;
      stars.push_back({place, flux});
    }
  // Not always those at the top, where they are more than are wanted.
  if (stars.size() > most) {
    for (std::size_t i = 0; i < most; ++i) {
      const auto left = static_cast<double>(stars.size() - i);
      const std::size_t j = i + std::min(stars.size() - i - 1, static_cast<std::size_t>(left * unit()));
      std::swap(stars[i], stars[j]);
    }
    stars.resize(most);
  }
  return stars;
}

Frame copy_of(const Frame& frame) {
  Frame copy;
  copy.header = frame.header;
  copy.pixels = Plane<float, unit::Adu>(frame.pixels.shared_layout());
  copy.flags = Plane<std::uint8_t, unit::Flags>(frame.flags.shared_layout());
  std::ranges::copy(frame.pixels.pixels(), copy.pixels.pixels().begin());
  std::ranges::copy(frame.flags.pixels(), copy.flags.pixels().begin());
  return copy;
}

void add(Frame& frame, const PixelPsf& psf, std::span<const AddedStar> stars, std::uint64_t seed, std::uint64_t run) {
  const Rectangle area = frame.pixels.layout().regions()[0];
  const auto pixels = frame.pixels.view(0);
  const RandomStream photons = make_stream(seed, kPhotons, static_cast<std::uint32_t>(run), 0);
  const double gain = frame.header.gain.value();
  constexpr double kLost = 1e-6;  // of a star's light
  std::vector<double> stamp;
  std::uint64_t step = 0;
  for (const AddedStar& star : stars) {
    const Rectangle box = intersect(stamp_box(star.place, psf.stamp_half_width(kLost)), area);
    stamp.resize(box.size());
    psf.integrate(star.place, box, stamp);
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x, ++k) {
        const double electrons =
            poisson_at_step(photons, StepAddress{.step = step++}, star.flux * std::max(0.0, stamp[k]));
        pixels.at(x, y) += static_cast<float>(electrons / gain);
      }
  }
}

struct Sums {
  std::vector<double> magnitude;
  std::vector<double> pull;
};

}  // namespace

double CompletenessBin::completeness() const {
  return added > 0 ? static_cast<double>(found) / static_cast<double>(added) : kNaN;
}

double CompletenessBin::completeness_error() const {
  const auto n = static_cast<double>(added);
  const double p = (static_cast<double>(found) + 1.0) / (n + 2.0);
  return std::sqrt(p * (1.0 - p) / (n + 3.0));
}

std::vector<CompletenessBin> add_artificial_stars(
    const Frame& frame, const PixelPsf& psf, const ArtificialStarSettings& settings,
    const std::function<std::vector<SourceMeasurement>(const Frame&)>& measure) {
  check(settings);
  ASTROID_CHECK_EQ(frame.pixels.layout().regions().size(), std::size_t{1});
  const Rectangle area = frame.pixels.layout().regions()[0];
  const double range = 2.5 * det::log10(settings.brightest / settings.faintest);
  const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(range / settings.bin + 0.5)));
  const double step = det::log(settings.brightest / settings.faintest) / static_cast<double>(count);
  std::vector<CompletenessBin> bins(count);
  for (std::size_t i = 0; i < count; ++i) {
    bins[i].brightest = settings.brightest * det::exp(-step * static_cast<double>(i));
    bins[i].faintest = settings.brightest * det::exp(-step * static_cast<double>(i + 1));
  }
  std::vector<Sums> sums(count);
  std::size_t placed = 0;
  constexpr std::uint64_t kMostRuns = 10000;
  for (std::uint64_t run = 0; placed < settings.stars && run < kMostRuns; ++run) {
    const std::vector<AddedStar> stars = place_stars(area, settings, run, settings.stars - placed);
    placed += stars.size();
    if (stars.empty()) continue;
    Frame copy = copy_of(frame);
    add(copy, psf, stars, settings.seed, run);
    const std::vector<SourceMeasurement> sources = measure(copy);
    for (const AddedStar& star : stars) {
      const auto i =
          std::min(count - 1, static_cast<std::size_t>(std::max(0.0, det::log(settings.brightest / star.flux) / step)));
      ++bins[i].added;
      const SourceMeasurement* nearest = nullptr;
      double distance = settings.match;
      for (const SourceMeasurement& s : sources) {
        const double d = std::hypot(s.x - star.place.x, s.y - star.place.y);
        if (d < distance && s.flux > 0.0) {
          distance = d;
          nearest = &s;
        }
      }
      if (nearest == nullptr) continue;
      const double error = -2.5 * det::log10(nearest->flux / star.flux);
      if (!(std::abs(error) < settings.match_magnitude)) continue;
      ++bins[i].found;
      sums[i].magnitude.push_back(error);
      if (nearest->flux_err > 0.0) sums[i].pull.push_back((nearest->flux - star.flux) / nearest->flux_err);
    }
  }
  constexpr std::size_t kFewest = 5;
  for (std::size_t i = 0; i < count; ++i) {
    if (sums[i].magnitude.size() < kFewest || sums[i].pull.size() < kFewest) continue;
    const RobustSpread magnitude = robust_spread(sums[i].magnitude);
    const RobustSpread pull = robust_spread(sums[i].pull);
    bins[i].magnitude_error = magnitude.centre;
    bins[i].magnitude_scatter = magnitude.value;
    bins[i].pull = pull.centre;
    bins[i].pull_width = pull.value;
  }
  return bins;
}

double completeness_limit(std::span<const CompletenessBin> bins, double share) {
  const auto middle = [](const CompletenessBin& bin) { return 0.5 * det::log(bin.brightest * bin.faintest); };
  // From the faint end: the last bin that is complete enough.
  const CompletenessBin* fainter = nullptr;
  for (std::size_t i = bins.size(); i-- > 0;) {
    const CompletenessBin& bin = bins[i];
    if (bin.added == 0) continue;
    if (bin.completeness() < share) {
      fainter = &bin;
      continue;
    }
    if (fainter == nullptr) return kNaN;
    const double t = (bin.completeness() - share) / (bin.completeness() - fainter->completeness());
    return det::exp(middle(bin) + t * (middle(*fainter) - middle(bin)));
  }
  return kNaN;
}

void write_completeness(const std::filesystem::path& file, std::span<const CompletenessBin> bins, Magnitude zero_point,
                        Seconds exposure) {
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : std::string(); };
  const auto magnitude = [&](double electrons) {
    return zero_point.value() - 2.5 * det::log10(electrons / exposure.value());
  };
  std::string text =
      "mag_bright,mag_faint,added,found,completeness,completeness_err,mag_error,mag_scatter,pull,pull_width\n";
  for (const CompletenessBin& bin : bins)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", number(magnitude(bin.brightest)),
                        number(magnitude(bin.faintest)), bin.added, bin.found, number(bin.completeness()),
                        number(bin.completeness_error()), number(bin.magnitude_error), number(bin.magnitude_scatter),
                        number(bin.pull), number(bin.pull_width));
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

}  // namespace astroid
