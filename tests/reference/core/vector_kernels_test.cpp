// Every vector kernel against its plain scalar twin, bit for bit, on every instruction set of this processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/vector_target.hpp"
#include "astroid/test/psf_table.hpp"
#include "gaussian_profiles.hpp"
#include "vector/stamp_kernels.hpp"

namespace astroid {
namespace {

template <class T>
void expect_same_bits(const std::vector<T>& kernel, const std::vector<T>& plain, const std::string& what) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t,
                                  std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint8_t>>;
  ASSERT_EQ(kernel.size(), plain.size());
  for (std::size_t i = 0; i < kernel.size(); ++i)
    ASSERT_EQ(std::bit_cast<Bits>(kernel[i]), std::bit_cast<Bits>(plain[i])) << what << ", element " << i;
}

/// Runs on one instruction set; the widest one is in force again afterwards.
class OnTarget : public testing::TestWithParam<std::string> {
 protected:
  OnTarget() { force_vector_target(GetParam()); }
  ~OnTarget() override { force_vector_target({}); }
  OnTarget(const OnTarget&) = delete;
  OnTarget& operator=(const OnTarget&) = delete;
  OnTarget(OnTarget&&) = delete;
  OnTarget& operator=(OnTarget&&) = delete;
};

INSTANTIATE_TEST_SUITE_P(Targets, OnTarget, testing::ValuesIn(vector_targets()),
                         [](const auto& target) { return target.param; });

/// Pixels and how many they are.
struct Shape {
  std::vector<Rectangle> areas;
  std::size_t size = 0;
  [[nodiscard]] PixelPlaces places() const { return {.areas = areas, .exposure = 9, .read = 2, .draw = 1}; }
};

/// Rows and windows of awkward widths, columns before the first and counters that wrap; then many areas in a row,
/// narrow and wide ones and some without pixels.
std::vector<Shape> shapes() {
  std::vector<Shape> all;
  for (const int x0 : {0, 1, 2, 3, -1, -7, 4509, std::numeric_limits<int>::min() + 3})
    for (const int columns : {1, 2, 3, 5, 6, 15, 16, 17, 63, 96, 97, 255, 256, 257, 700})
      for (const int rows : {1, 2, 7, 45})
        all.push_back({{{x0, -3, columns, rows}}, static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)});
  Shape mixed;
  for (int i = 0; i < 120; ++i) {
    mixed.areas.push_back({7 * i - 50, 3 * i,
                           i % 11 == 4   ? 0
                           : i % 17 == 3 ? 300
                                         : 1 + i % 9,
                           i % 13 == 5 ? 0 : 1 + i % 7});
    mixed.size += mixed.areas.back().size();
  }
  all.push_back(mixed);
  all.push_back({});
  return all;
}

const RandomStream& stream() {
  static const RandomStream stream = make_stream(20260101, StreamId{7}, 1, 2);
  return stream;
}

/// From 0 to 1e15, whole and not, in an order without system, so vectors hold large and small ones together.
std::vector<double> any_means(std::size_t size) {
  std::vector<double> mean(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double u = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
    mean[i] = i % 13 == 0 ? 0.0 : std::pow(10.0, 22.0 * u - 7.0);
  }
  return mean;
}

TEST_P(OnTarget, WordsAreThoseOfPhilox) {
  for (const Shape& shape : shapes()) {
    const PixelPlaces pixels = shape.places();
    const std::size_t size = shape.size;
    std::vector<std::uint32_t> kernel(size);
    std::vector<std::uint32_t> plain(size);
    pixel_words(stream(), pixels, kernel);
    reference::pixel_words(stream(), pixels, plain);
    expect_same_bits(kernel, plain, "words");
  }
}

TEST_P(OnTarget, UniformsAreThoseOfTheirWords) {
  for (const Shape& shape : shapes()) {
    const PixelPlaces pixels = shape.places();
    const std::size_t size = shape.size;
    std::vector<double> kernel(size);
    std::vector<double> plain(size);
    pixel_uniforms(stream(), pixels, kernel);
    reference::pixel_uniforms(stream(), pixels, plain);
    expect_same_bits(kernel, plain, "uniforms");
  }
}

TEST_P(OnTarget, NormalsAreThoseOfTheirWords) {
  for (const Shape& shape : shapes()) {
    const PixelPlaces pixels = shape.places();
    const std::size_t size = shape.size;
    std::vector<float> kernel(size);
    std::vector<float> plain(size);
    pixel_normals(stream(), pixels, kernel);
    reference::pixel_normals(stream(), pixels, plain);
    expect_same_bits(kernel, plain, "normals");
    std::vector<double> sum = any_means(size);
    std::vector<double> plain_sum = sum;
    add_pixel_normals(stream(), pixels, 25.3, sum);
    reference::add_pixel_normals(stream(), pixels, 25.3, plain_sum);
    expect_same_bits(sum, plain_sum, "added normals");
  }
}

TEST_P(OnTarget, CountsAreThoseOfThePoissonQuantile) {
  for (const Shape& shape : shapes()) {
    const PixelPlaces pixels = shape.places();
    const std::size_t size = shape.size;
    std::vector<double> kernel(size);
    std::vector<double> plain(size);
    const std::vector<double> mean = any_means(size);
    pixel_poisson(stream(), pixels, mean, kernel);
    reference::pixel_poisson(stream(), pixels, mean, plain);
    expect_same_bits(kernel, plain, "counts");
  }
}

TEST_P(OnTarget, CountsOfOneMeanAreThoseOfThePoissonQuantile) {
  constexpr int kSize = 20000;
  for (const double mean : {0.0, 1e-300, 1e-9, 0.3, 5.0, 9.9999999, 10.0, 12.0, 60.0, 945.0, 1e5, 1e8, 1e12, 1e15}) {
    std::vector<double> kernel(kSize);
    std::vector<double> plain(kSize);
    const std::vector<Rectangle> row{{-5, 3, kSize, 1}};
    const PixelPlaces pixels{.areas = row, .exposure = 1};
    pixel_poisson(stream(), pixels, std::vector<double>(kSize, mean), kernel);
    reference::pixel_poisson(stream(), pixels, std::vector<double>(kSize, mean), plain);
    expect_same_bits(kernel, plain, "mean " + std::to_string(mean));
  }
}

TEST_P(OnTarget, PoissonRefusesWhatIsNoMean) {
  std::vector<double> counts(40);
  const std::vector<Rectangle> row{{0, 0, 40, 1}};
  for (const double bad : {-1.0, -1e-300, std::nan(""), -std::nan(""), 2e15, std::numeric_limits<double>::infinity()})
    for (const std::size_t place : {0U, 17U, 39U}) {
      std::vector<double> mean(counts.size(), 50.0);
      mean[place] = bad;
      EXPECT_THROW(pixel_poisson(stream(), {.areas = row}, mean, counts), BugError) << bad << " at " << place;
    }
}

TEST_P(OnTarget, DigitisesLikeOneByOne) {
  constexpr double kTop = 65535.0;
  const std::vector<double> special = {
      65534.4, 65534.5, 65534.6, 65535.4,      65536.0, 1e9,          1e300,
      -0.4,    -0.5,    -0.6,    -3.0,         0.5,     1.5,          2.5,
      -0.0,    0.0,     1e-320,  4294967296.0, -1e300,  std::nan(""), std::numeric_limits<double>::infinity()};
  for (const std::size_t size : {0U, 1U, 7U, 16U, 33U, 1000U}) {
    std::vector<double> counts(size);
    for (std::size_t i = 0; i < size; ++i)
      counts[i] = i % 37 == 5 ? special[i % special.size()] : 0.25 * static_cast<double>(i * i % 262140);
    for (std::size_t i = 0; i < std::min(size, special.size()) && size == 33U; ++i) counts[i] = special[i];
    std::vector<float> kernel(size);
    std::vector<float> plain(size);
    std::vector<std::uint8_t> kernel_flags(size, 1);
    std::vector<std::uint8_t> plain_flags(size, 1);
    EXPECT_EQ(digitise_pixels(counts, kTop, kernel, kernel_flags),
              reference::digitise_pixels(counts, kTop, plain, plain_flags));
    expect_same_bits(kernel, plain, "counts");
    expect_same_bits(kernel_flags, plain_flags, "flags");
  }
}

TEST_P(OnTarget, ArithmeticOnPlanesIsThatOfPlainLoops) {
  for (const std::size_t size : {0U, 1U, 3U, 8U, 15U, 16U, 17U, 100U, 1001U}) {
    const std::vector<double> start = any_means(size);
    std::vector<float> other(size);
    for (std::size_t i = 0; i < size; ++i) other[i] = 1.0F + 0.01F * std::sin(static_cast<float>(i));
    const auto check = [&](auto kernel, auto plain, const char* what) {
      std::vector<double> a = start;
      std::vector<double> b = start;
      kernel(a);
      plain(b);
      expect_same_bits(a, b, what);
    };
    check([](auto& v) { add_constant(v, 0.1); }, [](auto& v) { reference::add_constant(v, 0.1); }, "add_constant");
    check([&](auto& v) { add_values(v, other); }, [&](auto& v) { reference::add_values(v, other); }, "add_values");
    check([&](auto& v) { multiply_values(v, other); }, [&](auto& v) { reference::multiply_values(v, other); },
          "multiply_values");
    check([&](auto& v) { scale_values(start, 0.04, v); }, [&](auto& v) { reference::scale_values(start, 0.04, v); },
          "scale_values");
    const std::vector<const float*> maps(5, other.data());
    const std::vector<float> weights = {0.3F, -0.01F, 1e-5F, 0.7F, -0.2F};
    check([&](auto& v) { combine_maps(start, maps, weights, v); },
          [&](auto& v) { reference::combine_maps(start, maps, weights, v); }, "combine_maps");
    for (const double limit : {-1.0, 1.0, 1e14, 1e16}) {
      std::vector<std::uint32_t> found(size);
      std::vector<std::uint32_t> plain(size);
      found.resize(find_at_least(start, limit, found));
      plain.resize(reference::find_at_least(start, limit, plain));
      EXPECT_EQ(found, plain) << size << ' ' << limit;
    }
  }
}

TEST_P(OnTarget, FindsAValueWhereverItStands) {
  std::vector<std::uint32_t> found(70);
  for (std::size_t place = 0; place < 70; ++place) {
    std::vector<double> values(70, std::nan(""));
    EXPECT_EQ(find_at_least(values, 5.0, found), 0U);
    values[place] = 5.0;
    ASSERT_EQ(find_at_least(values, 5.0, found), 1U) << place;
    EXPECT_EQ(found[0], place);
  }
}

/// An image with a star stamp in every corner and one in the middle, by kernel and by plain loops.
template <class Stamp, class Kernel, class Plain>
void expect_same_stamps(const Stamp& stamp, std::size_t size, Kernel kernel, Plain plain) {
  constexpr std::size_t kWidth = 40;
  std::vector<double> a(kWidth * kWidth, 0.5);
  std::vector<double> b = a;
  for (const std::size_t nx : {std::size_t{1}, std::size_t{7}, size})
    for (const std::size_t place : {std::size_t{0}, kWidth - nx, kWidth * 17 + 11, kWidth * (kWidth - size),
                                    kWidth * (kWidth - size) + kWidth - nx}) {
      kernel(stamp, detail::StampPixels{a.data() + place, a.data() + a.size(), kWidth, nx, size});
      plain(stamp, detail::StampPixels{b.data() + place, b.data() + b.size(), kWidth, nx, size});
    }
  expect_same_bits(a, b, "image");
}

TEST_P(OnTarget, SeparableStampsAreThoseOfPlainLoops) {
  const detail::GaussianProfiles profiles(0.6);
  for (const double covariance : {0.0, 3e-4}) {
    detail::SeparableStamp stamp{.x = profiles.axis(3.21, 1e-4),
                                 .y = profiles.axis(-7.77, 2e-4),
                                 .x_slope = profiles.slope(3.21),
                                 .y_slope = profiles.slope(-7.77),
                                 .electrons = 12345.6,
                                 .covariance = covariance,
                                 .table_stride = profiles.stride()};
    expect_same_stamps(stamp, static_cast<std::size_t>(stamp.x.size), detail::add_separable_stamp,
                       detail::reference::add_separable_stamp);
  }
}

TEST_P(OnTarget, PrfStampsAreThoseOfPlainLoops) {
  constexpr std::size_t kSide = 13;
  std::vector<double> library(kSide * kSide * detail::kPrfTaps);
  for (std::size_t i = 0; i < library.size(); ++i) library[i] = std::sin(static_cast<double>(i));
  detail::PrfStamp stamp{.images = {}, .weights = {}, .image_stride = kSide, .electrons = 1e4};
  for (std::size_t k = 0; k < detail::kPrfTaps; ++k) {
    stamp.images[k] = library.data() + k * kSide * kSide;
    stamp.weights[k] = 0.01 * static_cast<double>(k) - 0.03;
  }
  expect_same_stamps(stamp, kSide, detail::add_prf_stamp, detail::reference::add_prf_stamp);
}

TEST(VectorTarget, RefusesInstructionsThatTheProcessorDoesNotHave) {
  const std::string before = vector_target();
  EXPECT_THROW(force_vector_target("NEON"), InputError);
  EXPECT_EQ(vector_target(), before);
  EXPECT_EQ(vector_target(), vector_targets().front());
}

}  // namespace
}  // namespace astroid
