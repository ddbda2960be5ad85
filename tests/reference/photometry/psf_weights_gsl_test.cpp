// Weights among doubted light against the definition: the whole covariance matrix, factorised by GSL.
#include <gsl/gsl_linalg.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "astroid/core/psf.hpp"
#include "astroid/test/ground_scene.hpp"
#include "psf_weights.hpp"

namespace astroid::detail {
namespace {

using Matrix = std::unique_ptr<gsl_matrix, decltype(&gsl_matrix_free)>;
using Vector = std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)>;

// w = C^-1 p / (p^T C^-1 p), C = V + sum d d^T.
std::vector<double> dense_weights(const PsfWindow& window) {
  const std::size_t n = window.fractions.size();
  const Matrix covariance(gsl_matrix_calloc(n, n), gsl_matrix_free);
  const Vector x(gsl_vector_alloc(n), gsl_vector_free);
  for (std::size_t i = 0; i < n; ++i) {
    gsl_vector_set(x.get(), i, window.fractions[i]);
    for (std::size_t j = 0; j < n; ++j) {
      double value = i == j ? window.variance[i] : 0.0;
      for (std::size_t from = 0; from < window.doubts.size(); from += n)
        value += window.doubts[from + i] * window.doubts[from + j];
      gsl_matrix_set(covariance.get(), i, j, value);
    }
  }
  gsl_linalg_cholesky_decomp1(covariance.get());
  gsl_linalg_cholesky_svx(covariance.get(), x.get());
  double information = 0.0;
  for (std::size_t i = 0; i < n; ++i) information += window.fractions[i] * gsl_vector_get(x.get(), i);
  std::vector<double> weights(n);
  for (std::size_t i = 0; i < n; ++i) weights[i] = gsl_vector_get(x.get(), i) / information;
  return weights;
}

TEST(PsfWeights, AreThoseOfTheDenseSolution) {
  constexpr Rectangle kBox{0, 0, 7, 6};
  const auto psf = make_gaussian_psf(0.7);
  const test::TestNoise random(8);
  PsfScratch scratch;
  for (std::uint32_t scene = 0; scene < 50; ++scene) {
    std::vector<double> fractions(kBox.size());
    psf->integrate({3.0 + random.uniform(scene, 0), 2.5 + random.uniform(scene, 1)}, kBox, fractions);
    std::vector<double> variance(kBox.size());
    for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = 3500.0 + 1e5 * fractions[i];
    std::vector<double> doubts;
    const std::uint32_t neighbours = scene % 30;
    std::vector<double> light(kBox.size());
    for (std::uint32_t k = 0; k < neighbours; ++k) {
      const double electrons = 2000.0 * std::exp(6.0 * random.uniform(scene, 10 + 3 * k));
      psf->integrate({7.0 * random.uniform(scene, 11 + 3 * k), 6.0 * random.uniform(scene, 12 + 3 * k)}, kBox, light);
      for (std::size_t i = 0; i < light.size(); ++i) {
        variance[i] += electrons * light[i];
        // Doubts too small to matter are put here so that none is left out.
        doubts.push_back(0.05 * electrons * light[i] + 0.2);
      }
    }
    const PsfWindow window{fractions, variance, doubts};
    std::vector<double> weights(kBox.size());
    psf_weights(window, weights, scratch);
    const std::vector<double> dense = dense_weights(window);
    double largest = 0.0;
    for (const double weight : dense) largest = std::max(largest, std::abs(weight));
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(weights[i] / largest, dense[i] / largest, 1e-9);
  }
}

}  // namespace
}  // namespace astroid::detail
