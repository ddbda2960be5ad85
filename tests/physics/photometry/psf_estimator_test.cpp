// PSF weights with neighbours against bounds and closed forms: Cramér-Rao (F41), blends (F42, N17), and what is
// unbiased.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/core/math.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr double kFwhm = 2.3548200450309493;  // in sigma
constexpr double kUnlimitedDoubt = 1e6;

PhotometrySettings psf_settings(int window, BackgroundMethod background = BackgroundMethod::kKnown) {
  PhotometrySettings settings;
  settings.method = PhotometryMethod::kPsf;
  settings.background = background;
  settings.mask_window = window;
  return settings;
}

std::vector<StarEstimator> build(const test::GroundScene& scene, int side, const PhotometrySettings& settings,
                                 double doubt) {
  GroundModel model = scene.model();
  model.flux_doubt = doubt;
  return build_estimators(*test::full_frame(side, side), model, settings);
}

double sigma_of(const StarEstimator& star) {
  return std::sqrt(star.budget.variance());
}

// 1 / sqrt(sum p² / (F p + B)).
double cramer_rao(const PixelPsf& psf, const FieldStar& star, const Rectangle& box, double background) {
  std::vector<double> p(box.size());
  psf.integrate(star.position, box, p);
  double information = 0.0;
  for (const double fraction : p) information += fraction * fraction / (star.electrons * fraction + background);
  return 1.0 / std::sqrt(information);
}

TEST(PsfEstimator, ReachesTheCramerRaoBound) {
  // F41: 41 × 41 px, star in the centre of a pixel.
  struct Row {
    double electrons, background, sigma, bound;
  };
  for (const Row& row : {Row{1e5, 0.0, 1.0, 316.227766}, Row{1e4, 100.0, 1.0, 110.924282},
                         Row{1e4, 1e4, 1.0, 386.583511}, Row{177100.0, 3531.0, 0.6, 459.533503}}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(row.sigma);
    scene.noise = {row.background, 0.0, 0.0};
    scene.add_target({20.0, 20.0}, row.electrons);
    const StarEstimator star = build(scene, 41, psf_settings(41), 0.05)[0];
    std::printf("F %.0f B %.0f: sigma %.6f, bound %.6f\n", row.electrons, row.background, sigma_of(star), row.bound);
    EXPECT_NEAR(sigma_of(star) / row.bound, 1.0, 1e-7);  // weights are floats
    EXPECT_NEAR(star.nsr_exposure * row.electrons / row.bound, 1.0, 1e-7);
    EXPECT_NEAR(star.enclosed_fraction, 1.0, 1e-6);
    EXPECT_EQ(star.flags, 0U);
  }
}

TEST(PsfEstimator, LosesNothingToTheSmallWindow) {
  // PLATO's noise: the bound over all pixels against the 6 × 6 px of the default.
  for (const double electrons : {4000.0, 59000.0, 372000.0}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(0.6);
    scene.noise = {945.0, 50.2, 7.2};
    scene.add_target({20.3, 19.8}, electrons);
    const StarEstimator star = build(scene, 41, psf_settings(6), 0.05)[0];
    const double bound = cramer_rao(*scene.psf, scene.stars[0], {0, 0, 41, 41}, scene.noise.variance());
    EXPECT_GE(sigma_of(star) / bound, 1.0 - 1e-7);
    EXPECT_LT(sigma_of(star) / bound, 1.0 + 1e-3);
  }
}

TEST(PsfEstimator, InflatesTheErrorsOfABlendAsKnown) {
  // F42 is of continuous Gaussians: a wide one whose pixels add 1/12 px² per axis.
  const double sigma = std::sqrt(16.0 - 1.0 / 12.0);
  struct Row {
    double q, inflation;
    bool blended;
  };
  for (const Row& row : {Row{0.05, 12.032, true}, Row{0.1, 6.0473, true}, Row{0.25, 2.5070, true},
                         Row{0.5, std::sqrt(2.0), false}, Row{1.0, 1.03280, false}}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(sigma);
    scene.noise = {1e10, 0.0, 0.0};
    scene.add_target({40.0, 40.0}, 1e4);
    const double alone = sigma_of(build(scene, 81, psf_settings(65), kUnlimitedDoubt)[0]);
    scene.add_target({40.0 + row.q * kFwhm * 4.0, 40.0}, 1e4);
    const auto stars = build(scene, 81, psf_settings(65), kUnlimitedDoubt);
    std::printf("q %.2f: inflation %.5f (%.5f)\n", row.q, sigma_of(stars[0]) / alone, row.inflation);
    // The values are rounded to five digits; PSFs are integrated over pixels, of which F42 knows the width alone.
    EXPECT_NEAR(sigma_of(stars[0]) / alone / row.inflation, 1.0, 3e-4);
    if (row.q != 0.5) {
      EXPECT_EQ((stars[0].flags & measurement_flag::kBlended) != 0, row.blended);
    }
    // The sum of both stays well determined: sqrt(2 / (1 + rho)).
    double variance = 0.0;
    std::vector<double> weights(81 * 81);
    for (const StarEstimator& star : stars)
      for (const EstimatorTerm& term : star.terms) weights[term.pixel] += static_cast<double>(term.weight);
    for (const double weight : weights) variance += weight * weight * 1e10;
    const double rho = det::exp(-2.0 * row.q * row.q * std::log(2.0));
    EXPECT_NEAR(std::sqrt(variance) / alone / std::sqrt(2.0 / (1.0 + rho)), 1.0, 1e-3);
  }
}

// Scatter of the fluxes of a scene over noisy exposures, and their means.
struct Scatter {
  std::vector<double> mean, deviation;
};

Scatter scatter_of(const test::GroundScene& scene, int side, std::span<const StarEstimator> estimators,
                   std::uint32_t exposures) {
  const auto layout = test::full_frame(side, side);
  const std::vector<double> expected = test::expected_electrons(*layout, scene);
  const EstimatorSet set(estimators, scene.gain, scene.bias);
  const test::TestNoise noise(21);
  std::vector<double> flux(set.size());
  std::vector<std::uint32_t> flags(set.size());
  // Sums for both stars and, last, of their sum.
  std::vector<double> sum(set.size() + 1);
  std::vector<double> squares(set.size() + 1);
  for (std::uint32_t k = 0; k < exposures; ++k) {
    set.apply(test::noisy_frame(layout, scene, expected, noise, k), flux, flags);
    double all = 0.0;
    for (std::size_t i = 0; i <= set.size(); ++i) {
      const double deviation = i < set.size() ? flux[i] - scene.stars[i].electrons : all;
      all += deviation;
      sum[i] += deviation;
      squares[i] += deviation * deviation;
    }
  }
  Scatter scatter;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    scatter.mean.push_back(sum[i] / exposures);
    scatter.deviation.push_back(std::sqrt(squares[i] / exposures - scatter.mean[i] * scatter.mean[i]));
  }
  return scatter;
}

TEST(PsfEstimator, ScattersByTheBoundOverExposures) {
  constexpr std::uint32_t kExposures = 20000;  // a deviation to 0.5 %
  for (const double electrons : {4000.0, 148000.0}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(0.6);
    scene.noise = {945.0, 50.2, 0.0};
    scene.add_target({6.3, 5.8}, electrons);
    const auto stars = build(scene, 13, psf_settings(11), 0.05);
    const double bound = cramer_rao(*scene.psf, scene.stars[0], {0, 0, 13, 13}, scene.noise.variance());
    EXPECT_NEAR(stars[0].nsr_exposure * electrons / bound, 1.0, 1e-3);
    const Scatter scatter = scatter_of(scene, 13, stars, kExposures);
    std::printf("F %.0f: scatter / bound %.4f, mean %+.2f sigma of the mean\n", electrons, scatter.deviation[0] / bound,
                scatter.mean[0] / bound * std::sqrt(kExposures));
    EXPECT_NEAR(scatter.deviation[0] / bound, 1.0, 0.02);
    EXPECT_NEAR(scatter.mean[0] / bound, 0.0, 4.0 / std::sqrt(kExposures));
  }
}

TEST(PsfEstimator, ScattersByTheInflatedBoundInABlend) {
  // N17: blends of bright stars, fluxes free; scatter / bound = 1.00 ± 0.03, and the sum has its own bound.
  constexpr std::uint32_t kExposures = 10000;  // a deviation to 0.7 %
  for (const double q : {0.1, 0.5}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(0.9);
    scene.noise = {1e6, 0.0, 0.0};
    scene.add_target({9.7, 9.1}, 2e4);
    scene.add_target({9.7 + q * kFwhm * 0.9, 9.1}, 2e4);
    const auto stars = build(scene, 19, psf_settings(13), kUnlimitedDoubt);
    const Scatter scatter = scatter_of(scene, 19, stars, kExposures);
    for (std::size_t i = 0; i < 2; ++i) {
      std::printf("q %.1f star %zu: scatter / predicted %.4f\n", q, i, scatter.deviation[i] / sigma_of(stars[i]));
      EXPECT_NEAR(scatter.deviation[i] / sigma_of(stars[i]), 1.0, 0.03);
      EXPECT_NEAR(scatter.mean[i] / scatter.deviation[i], 0.0, 4.0 / std::sqrt(kExposures));
    }
    EXPECT_NEAR(scatter.mean[2] / scatter.deviation[2], 0.0, 4.0 / std::sqrt(kExposures));
    if (q < 0.5) {
      EXPECT_LT(scatter.deviation[2], 0.3 * scatter.deviation[0]) << "the sum stays well determined";
    }
  }
}

// Twelve stars around a target, of its brightness and fainter.
test::GroundScene crowd(double scale) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.7);
  scene.noise = {945.0, 50.2, 7.2};
  const test::TestNoise random(5);
  scene.add_target({15.2, 14.9}, 1e5 * scale);
  for (std::uint32_t i = 0; i < 12; ++i)
    scene.add_target({15.2 + 9.0 * (random.uniform(0, i) - 0.5), 14.9 + 9.0 * (random.uniform(1, i) - 0.5)},
                     1e5 * scale * random.uniform(2, i));
  return scene;
}

std::vector<double> measure(const test::GroundScene& truth, int side, std::span<const StarEstimator> estimators) {
  const auto layout = test::full_frame(side, side);
  const EstimatorSet set(estimators, truth.gain, truth.bias);
  std::vector<double> flux(set.size());
  std::vector<std::uint32_t> flags(set.size());
  set.apply(test::frame_of(layout, truth, test::expected_electrons(*layout, truth)), flux, flags);
  return flux;
}

TEST(PsfEstimator, IsUnbiasedInACrowd) {
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    for (const double scale : {0.01, 1.0, 30.0}) {
      const test::GroundScene scene = crowd(scale);
      const auto stars = build(scene, 31, psf_settings(6, background), 0.05);
      const std::vector<double> flux = measure(scene, 31, stars);
      for (std::size_t i = 0; i < stars.size(); ++i) {
        EXPECT_NEAR(flux[i], scene.stars[i].electrons, 1e-5 * scene.stars[0].electrons + 0.01) << i;
        EXPECT_EQ(stars[i].budget.contaminants, 0.0);
        EXPECT_EQ(stars[i].spr_total, 0.0);
        EXPECT_NEAR(stars[i].budget.target / scene.stars[i].electrons, 1.0, 1e-6);
      }
    }
  }
}

TEST(PsfEstimator, IsUnbiasedWhateverTheTargetGives) {
  const test::GroundScene believed = crowd(1.0);
  const auto stars = build(believed, 31, psf_settings(6), 0.05);
  for (const double factor : {0.0, 0.5, 4.0}) {
    test::GroundScene truth = believed;
    truth.stars[0].electrons *= factor;
    EXPECT_NEAR(measure(truth, 31, stars)[0], truth.stars[0].electrons, 1.0) << factor;
  }
}

TEST(PsfEstimator, SuppressesTheErrorOfAWrongNeighbour) {
  // The neighbour is 20 % brighter than believed. A mask takes all that it collects of the difference.
  for (const double distance : {1.0, 1.5, 2.0, 3.0}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(0.6);
    scene.noise = {945.0, 50.2, 7.2};
    scene.add_target({15.2, 14.9}, 2e5);
    scene.add_star({15.2 + distance, 15.1}, 2e5);
    test::GroundScene truth = scene;
    truth.stars[1].electrons *= 1.2;
    const auto psf = build(scene, 31, psf_settings(6), 0.05);
    PhotometrySettings mask_settings = psf_settings(6);
    mask_settings.method = PhotometryMethod::kMask;
    const auto mask = build(scene, 31, mask_settings, 0.05);
    const double psf_error = (measure(truth, 31, psf)[0] - psf[0].budget.target) / psf[0].budget.target;
    const double mask_error =
        (measure(truth, 31, mask)[0] - mask[0].budget.target - mask[0].budget.contaminants) / mask[0].budget.target;
    std::printf("neighbour at %.1f px: PSF %+.2e, mask %+.2e\n", distance, psf_error, mask_error);
    EXPECT_LT(std::abs(psf_error), 0.1 * std::abs(mask_error)) << distance;
    // What is left is what the doubt says: 20 % are four sigma of 5 %.
    EXPECT_NEAR(std::abs(psf_error) * psf[0].budget.target, 4.0 * std::sqrt(psf[0].budget.var_neighbour_doubt),
                1e-6 * psf[0].budget.target);
  }
}

TEST(PsfEstimator, FlagsStarsInTheSamePlace) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({15.2, 14.9}, 1e5);
  scene.add_target({15.2, 14.9}, 1e5);
  scene.add_target({15.2, 14.9}, 2e2);  // far fainter: it cannot harm the others, they spoil it
  scene.add_target({24.0, 24.0}, 1e5);
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    const auto stars = build(scene, 31, psf_settings(6, background), 0.05);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NE(stars[i].flags & measurement_flag::kBlended, 0U) << i;
      EXPECT_TRUE(std::isfinite(stars[i].nsr_exposure));
    }
    EXPECT_EQ(stars[3].flags, 0U);
    // Whatever the weights: the coincident star's 5 % are in the flux.
    EXPECT_NEAR(std::sqrt(stars[0].budget.var_neighbour_doubt), 5000.0, 1.0);
    EXPECT_NEAR(measure(scene, 31, stars)[1], 1e5, 1.0);
    EXPECT_EQ(stars[0].budget.variance(), stars[1].budget.variance());
  }
}

TEST(PsfEstimator, BudgetsEveryCause) {
  const test::GroundScene scene = crowd(1.0);
  const auto layout = test::full_frame(31, 31);
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    for (const StarEstimator& star : build(scene, 31, psf_settings(7, background), 0.05)) {
      test::GroundScene dark = scene;
      dark.noise.background = 0.0;
      const std::vector<double> light = test::expected_electrons(*layout, dark);
      double photons = 0.0;
      double squares = 0.0;
      double annulus = 0.0;
      for (std::size_t i = 0; i < star.terms.size(); ++i) {
        const double w = static_cast<double>(star.terms[i].weight);
        const double l = light[star.terms[i].pixel];
        if (i < star.aperture_terms) {
          photons += w * w * l;
          squares += w * w;
        } else {
          annulus += w * w * (l + scene.noise.variance());
        }
      }
      const EstimatorBudget& budget = star.budget;
      EXPECT_NEAR((budget.var_target + budget.var_contaminants) / photons, 1.0, 1e-6);
      EXPECT_NEAR(budget.var_background / squares, 945.0, 1e-6);
      EXPECT_NEAR(budget.var_readout / squares, 50.2 * 50.2, 1e-6);
      EXPECT_NEAR(budget.var_quantisation / squares, 7.2 * 7.2, 1e-6);
      EXPECT_NEAR(budget.var_background_estimate, annulus, 1e-5 * budget.variance());
      EXPECT_DOUBLE_EQ(star.nsr_exposure, std::sqrt(budget.variance()) / budget.target);
      EXPECT_EQ(static_cast<std::size_t>(star.mask_pixels), star.aperture_terms);
    }
  }
}

TEST(PsfEstimator, RespondsToMotionAsItsGradientSays) {
  const test::GroundScene scene = crowd(1.0);
  const auto stars = build(scene, 31, psf_settings(6), 0.05);
  constexpr double kStep = 1e-2;
  const auto flux_at = [&](double dx, double dy) {
    test::GroundScene moved = scene;
    for (FieldStar& star : moved.stars) star.position = {star.position.x + dx, star.position.y + dy};
    return measure(moved, 31, stars);
  };
  const std::vector<double> right = flux_at(kStep, 0.0);
  const std::vector<double> left = flux_at(-kStep, 0.0);
  const std::vector<double> up = flux_at(0.0, kStep);
  const std::vector<double> down = flux_at(0.0, -kStep);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const double two_steps = 2.0 * kStep * scene.stars[i].electrons;
    EXPECT_NEAR(stars[i].gradient_x, (right[i] - left[i]) / two_steps, 1e-3 + 1e-3 * std::abs(stars[i].gradient_x));
    EXPECT_NEAR(stars[i].gradient_y, (up[i] - down[i]) / two_steps, 1e-3 + 1e-3 * std::abs(stars[i].gradient_y));
  }
}

TEST(PsfEstimator, GuardsABlendAgainstMotion) {
  // The variance that counts is that of pixels and motion together; weights for stars at rest, or for a wrong
  // covariance, have more of it.
  const test::GroundScene scene = crowd(1.0);
  const MotionCovariance motion{4e-4, 1e-4, 9e-4};
  const auto variances = [&](const MotionCovariance& believed) {
    GroundModel model = scene.model();
    model.motion = believed;
    std::vector<double> result;
    for (const StarEstimator& star : build_estimators(*test::full_frame(31, 31), model, psf_settings(6))) {
      const double flux = star.budget.target;
      result.push_back(star.budget.variance() + star.budget.var_neighbour_doubt +
                       flux * flux * motion.along(star.gradient_x, star.gradient_y));
    }
    return result;
  };
  const std::vector<double> guarded = variances(motion);
  for (const MotionCovariance& wrong :
       {MotionCovariance{}, {4e-4, 0.0, 9e-4}, {4e-4, -1e-4, 9e-4}, {9e-4, 1e-4, 4e-4}, {8e-4, 2e-4, 18e-4}}) {
    const std::vector<double> other = variances(wrong);
    for (std::size_t i = 0; i < guarded.size(); ++i) EXPECT_LE(guarded[i], other[i] * (1.0 + 1e-6)) << i;
  }
  EXPECT_LT(guarded[0], 0.5 * variances({})[0]);
}

TEST(PsfEstimator, CountsThePixelGainsUnderNeighboursToo) {
  // F28 with the light of all stars: pixel gains of 1 + e change the flux by sum w e I.
  const test::GroundScene scene = crowd(1.0);
  const StarEstimator star = build(scene, 31, psf_settings(6), 0.05)[0];
  test::GroundScene dark = scene;
  dark.noise.background = 0.0;
  const std::vector<double> light = test::expected_electrons(*test::full_frame(31, 31), dark);
  double squares = 0.0;
  for (const EstimatorTerm& term : star.terms) {
    const double part = static_cast<double>(term.weight) * light[term.pixel];
    squares += part * part;
  }
  EXPECT_NEAR(star.prnu_static, std::sqrt(squares) / star.budget.target, 1e-6);
}

TEST(PsfEstimator, MeasuresTheStarCutByTheEdgeWithAllItsFlux) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({-0.3, 10.0}, 1e5);
  scene.add_target({1.2, 10.4}, 5e4);
  scene.add_star({-1.4, 11.0}, 1e5);
  scene.add_target({12.0, 12.0}, 1e5);
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    const auto stars = build(scene, 21, psf_settings(6, background), 0.05);
    const std::vector<double> flux = measure(scene, 21, stars);
    EXPECT_NEAR(flux[0], 1e5, 1.0);
    EXPECT_NEAR(flux[1], 5e4, 1.0);
    EXPECT_NE(stars[0].flags & measurement_flag::kEdge, 0U);
    EXPECT_GT(stars[0].nsr_exposure, stars[2].nsr_exposure);
    EXPECT_EQ(stars[2].flags, 0U);
  }
}

}  // namespace
}  // namespace astroid
