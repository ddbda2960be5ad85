// Time of a pixel in each kernel, by instruction set.
//
// The names are BM_PixelNoise/<kernel>/<instruction set> and BM_Plane/<kernel>/<instruction set>; "scalar" is the plain
// twin that the kernels are tested against. CPU times; a strip of 8192 pixels, which stays in the cache as it does in
// an exposure.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/pixel_noise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/vector_target.hpp"

namespace astroid {
namespace {

constexpr Rectangle kArea{0, 0, 1024, 8};
constexpr std::size_t kPixels = kArea.size();
constexpr std::string_view kScalar = "scalar";
constexpr RandomStream kStream{{0x51u, 0x7au}};

const PixelPlaces kPlaces{.areas = std::span(&kArea, 1)};

/// A kernel on one strip of an exposure.
using Kernel = std::function<void(const PixelPlaces&)>;

/// What the kernels read and write; one for all.
struct Buffers {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(kPixels);
  std::vector<std::uint32_t> found = std::vector<std::uint32_t>(kPixels);
  std::vector<std::uint8_t> flags = std::vector<std::uint8_t>(kPixels);
  std::vector<float> single = std::vector<float>(kPixels);
  std::vector<double> values = std::vector<double>(kPixels);
  std::vector<double> other = std::vector<double>(kPixels);
};
Buffers& buffers() {
  static Buffers all;
  return all;
}

/// Runs a kernel on the instruction set it is meant for, each time with the words of another exposure.
void time_kernel(benchmark::State& state, const std::string& target, const std::function<Kernel()>& prepare) {
  if (target != kScalar) force_vector_target(target);
  const Kernel kernel = prepare();
  PixelPlaces places = kPlaces;
  for (auto _ : state) {
    ++places.exposure;
    kernel(places);
    benchmark::ClobberMemory();
  }
  force_vector_target({});
  state.counters["time/pixel"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(kPixels),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);  // s
}

void add(const std::string& name, const std::string& target, const std::function<Kernel()>& prepare) {
  benchmark::RegisterBenchmark((name + "/" + target).c_str(), [target, prepare](benchmark::State& state) {
    time_kernel(state, target, prepare);
  })->Unit(benchmark::kMicrosecond);
}

/// A kernel or its plain twin.
template <class Function>
Function choose(const std::string& target, Function vector, Function scalar) {
  return target == kScalar ? scalar : vector;
}

void add_draws(const std::string& target) {
  add("BM_PixelNoise/words", target, [=]() -> Kernel {
    const auto draw = choose(target, &pixel_words, &reference::pixel_words);
    return [=](const PixelPlaces& places) { draw(kStream, places, buffers().words); };
  });
  add("BM_PixelNoise/uniforms", target, [=]() -> Kernel {
    const auto draw = choose(target, &pixel_uniforms, &reference::pixel_uniforms);
    return [=](const PixelPlaces& places) { draw(kStream, places, buffers().values); };
  });
  add("BM_PixelNoise/normals", target, [=]() -> Kernel {
    const auto draw = choose(target, &pixel_normals, &reference::pixel_normals);
    return [=](const PixelPlaces& places) { draw(kStream, places, buffers().single); };
  });
  add("BM_PixelNoise/added normals", target, [=]() -> Kernel {
    const auto draw = choose(target, &add_pixel_normals, &reference::add_pixel_normals);
    return [=](const PixelPlaces& places) { draw(kStream, places, 1.0, buffers().values); };
  });
  for (const char* mean : {"0.01", "1", "5", "12", "60", "945", "1e5", "1e8"})
    add("BM_PixelNoise/Poisson of mean " + std::string(mean), target, [=]() -> Kernel {
      const auto draw = choose(target, &pixel_poisson, &reference::pixel_poisson);
      buffers().other.assign(kPixels, std::stod(mean));
      return [=](const PixelPlaces& places) { draw(kStream, places, buffers().other, buffers().values); };
    });
}

void add_arithmetic(const std::string& target) {
  add("BM_Plane/digitise", target, [=]() -> Kernel {
    constexpr double kTop = 65535.0;
    const auto digitise = choose(target, &digitise_pixels, &reference::digitise_pixels);
    pixel_uniforms(kStream, kPlaces, buffers().values);
    for (double& value : buffers().values) value *= kTop;
    return [=](const PixelPlaces&) {
      benchmark::DoNotOptimize(digitise(buffers().values, kTop, buffers().single, buffers().flags));
    };
  });
  // Twelve maps of one strip are 400 KB: as in an exposure, they come from beyond the first cache.
  add("BM_Plane/sum of 12 maps", target, [=]() -> Kernel {
    constexpr std::size_t kMaps = 12;
    const auto combine = choose(target, &combine_maps, &reference::combine_maps);
    buffers().other.assign(kPixels, 1.0);
    return [=, all = std::vector<std::vector<float>>(kMaps, std::vector<float>(kPixels, 1.0F)),
            weights = std::vector<float>(kMaps, 0.5F)](const PixelPlaces&) {
      std::vector<const float*> maps;
      for (const std::vector<float>& map : all) maps.push_back(map.data());
      combine(buffers().other, maps, weights, buffers().values);
    };
  });
  add("BM_Plane/find full pixels", target, [=]() -> Kernel {
    const auto find = choose(target, &find_at_least, &reference::find_at_least);
    pixel_uniforms(kStream, kPlaces, buffers().values);
    constexpr double kRare = 0.999;
    return [=](const PixelPlaces&) { benchmark::DoNotOptimize(find(buffers().values, kRare, buffers().found)); };
  });
}

}  // namespace
}  // namespace astroid

int main(int argc, char** argv) {
  std::vector<std::string> targets = astroid::vector_targets();
  targets.emplace_back(astroid::kScalar);
  for (const std::string& target : targets) {
    astroid::add_draws(target);
    astroid::add_arithmetic(target);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
