#include "group/group_problem.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <utility>

namespace astroid::detail {

namespace {

// What a library of ours never does, it does: print. Its verdicts are returned.
void silence() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

// The stars' stamps at the parameters that Ceres asks for, made once for all pixels.
class Stamps final : public ceres::EvaluationCallback {
 public:
  Stamps(const PixelPsf& psf, const Rectangle& box, const GroupParameters& parameters)
      : psf_(psf), box_(box), parameters_(parameters), stamps_(parameters.flux.size()) {
    for (Stamp& s : stamps_)
      s = {std::vector<double>(box.size()), std::vector<double>(box.size()), std::vector<double>(box.size())};
  }

  void PrepareForEvaluation(bool /*jacobians*/, bool /*new_point*/) final {
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      const PixelPosition place{parameters_.place[i][0], parameters_.place[i][1]};
      psf_.integrate(place, box_, stamps_[i].p);
      psf_.integrate_gradient(place, box_, stamps_[i].px, stamps_[i].py);
    }
  }
  [[nodiscard]] double p(std::size_t star, std::size_t pixel) const { return stamps_[star].p[pixel]; }
  [[nodiscard]] double px(std::size_t star, std::size_t pixel) const { return stamps_[star].px[pixel]; }
  [[nodiscard]] double py(std::size_t star, std::size_t pixel) const { return stamps_[star].py[pixel]; }

 private:
  struct Stamp {
    std::vector<double> p, px, py;
  };
  const PixelPsf& psf_;
  Rectangle box_;
  const GroupParameters& parameters_;
  std::vector<Stamp> stamps_;
};

// Parameter blocks: the background, then flux and place of every star that reaches the pixel.
class PixelCost final : public ceres::CostFunction {
 public:
  PixelCost(const Stamps& stamps, std::size_t pixel, double electrons, double sigma, std::vector<std::size_t> stars)
      : stamps_(stamps), pixel_(pixel), electrons_(electrons), weight_(1.0 / sigma), stars_(std::move(stars)) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(1);
    for (std::size_t i = 0; i < stars_.size(); ++i) {
      mutable_parameter_block_sizes()->push_back(1);
      mutable_parameter_block_sizes()->push_back(2);
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final {
    double model = parameters[0][0];
    for (std::size_t i = 0; i < stars_.size(); ++i) model += parameters[1 + 2 * i][0] * stamps_.p(stars_[i], pixel_);
    residuals[0] = weight_ * (model - electrons_);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) jacobians[0][0] = weight_;
    for (std::size_t i = 0; i < stars_.size(); ++i) {
      const double flux = parameters[1 + 2 * i][0];
      if (double* j = jacobians[1 + 2 * i]) j[0] = weight_ * stamps_.p(stars_[i], pixel_);
      if (double* j = jacobians[2 + 2 * i]) {
        j[0] = weight_ * flux * stamps_.px(stars_[i], pixel_);
        j[1] = weight_ * flux * stamps_.py(stars_[i], pixel_);
      }
    }
    return true;
  }

 private:
  const Stamps& stamps_;
  std::size_t pixel_;
  double electrons_;
  double weight_;
  std::vector<std::size_t> stars_;
};

// The problem over `parameters`, which it reads and writes.
class GroupProblem {
 public:
  GroupProblem(const GroupPixels& pixels, std::span<const double> variance, std::span<const char> usable,
               const PixelPsf& psf, const GroupSolve& solve, GroupParameters& parameters)
      : stamps_(psf, pixels.box, parameters), loss_(solve.outlier), problem_(options(&stamps_)) {
    problem_.AddParameterBlock(&parameters.background, 1);
    if (!solve.background) problem_.SetParameterBlockConstant(&parameters.background);
    for (std::size_t i = 0; i < parameters.flux.size(); ++i) {
      double* place = parameters.place[i].data();
      problem_.AddParameterBlock(&parameters.flux[i], 1);
      problem_.AddParameterBlock(place, 2);
      if (!solve.positions) {
        problem_.SetParameterBlockConstant(place);
        continue;
      }
      for (int axis = 0; axis < 2; ++axis) {
        problem_.SetParameterLowerBound(place, axis, place[axis] - solve.most_shift);
        problem_.SetParameterUpperBound(place, axis, place[axis] + solve.most_shift);
      }
    }
    const double reach = std::ceil(psf.stamp_half_width(kLost)) + solve.most_shift + 1.0;
    std::size_t k = 0;
    for (int y = pixels.box.y0; y < pixels.box.y1(); ++y)
      for (int x = pixels.box.x0; x < pixels.box.x1(); ++x, ++k) {
        if (usable[k] == 0) continue;
        std::vector<std::size_t> stars;
        std::vector<double*> blocks{&parameters.background};
        for (std::size_t i = 0; i < parameters.flux.size(); ++i) {
          if (std::abs(parameters.place[i][0] - x) > reach || std::abs(parameters.place[i][1] - y) > reach) continue;
          stars.push_back(i);
          blocks.push_back(&parameters.flux[i]);
          blocks.push_back(parameters.place[i].data());
        }
        costs_.emplace_back(stamps_, k, pixels.electrons[k], std::sqrt(variance[k]), std::move(stars));
        problem_.AddResidualBlock(&costs_.back(), solve.robust ? &loss_ : nullptr, blocks);
      }
  }

  [[nodiscard]] ceres::Problem& problem() { return problem_; }

 private:
  static constexpr double kLost = 1e-6;  // of a star's light
  static ceres::Problem::Options options(Stamps* stamps) {
    ceres::Problem::Options o;
    o.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    o.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    o.evaluation_callback = stamps;
    return o;
  }
  Stamps stamps_;
  ceres::CauchyLoss loss_;
  std::deque<PixelCost> costs_;  // they stay where they are
  ceres::Problem problem_;
};

constexpr std::size_t kSmall = 60;  // parameters, of problems that dense decompositions suit

}  // namespace

bool solve_group(const GroupPixels& pixels, std::span<const double> variance, std::span<const char> usable,
                 const PixelPsf& psf, const GroupSolve& solve, GroupParameters& parameters) {
  silence();
  GroupProblem group(pixels, variance, usable, psf, solve, parameters);
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = solve.most_iterations;
  // Of Levenberg–Marquardt: far below the noise.
  options.function_tolerance = 1e-9;
  options.parameter_tolerance = 1e-9;
  options.gradient_tolerance = 1e-12;
  options.linear_solver_type = 3 * parameters.flux.size() < kSmall ? ceres::DENSE_QR : ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &group.problem(), &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

GroupCovariance group_covariance(const GroupPixels& pixels, std::span<const double> variance,
                                 std::span<const char> usable, const PixelPsf& psf, const GroupSolve& solve,
                                 GroupParameters& parameters) {
  silence();
  GroupProblem group(pixels, variance, usable, psf, solve, parameters);
  ceres::Covariance::Options options;
  options.num_threads = 1;
  options.algorithm_type = 3 * parameters.flux.size() < kSmall ? ceres::DENSE_SVD : ceres::SPARSE_QR;
  ceres::Covariance covariance(options);
  std::vector<std::pair<const double*, const double*>> blocks;
  if (solve.background) blocks.emplace_back(&parameters.background, &parameters.background);
  for (std::size_t i = 0; i < parameters.flux.size(); ++i) {
    blocks.emplace_back(&parameters.flux[i], &parameters.flux[i]);
    if (!solve.positions) continue;
    blocks.emplace_back(&parameters.flux[i], parameters.place[i].data());
    blocks.emplace_back(parameters.place[i].data(), parameters.place[i].data());
  }
  GroupCovariance result;
  result.known = covariance.Compute(blocks, &group.problem());
  result.stars.resize(parameters.flux.size());
  if (!result.known) return result;
  if (solve.background)
    covariance.GetCovarianceBlock(&parameters.background, &parameters.background, &result.background);
  for (std::size_t i = 0; i < parameters.flux.size(); ++i) {
    std::array<double, 6>& c = result.stars[i];
    covariance.GetCovarianceBlock(&parameters.flux[i], &parameters.flux[i], c.data());
    if (!solve.positions) continue;
    covariance.GetCovarianceBlock(&parameters.flux[i], parameters.place[i].data(), c.data() + 1);
    std::array<double, 4> place{};
    covariance.GetCovarianceBlock(parameters.place[i].data(), parameters.place[i].data(), place.data());
    c[3] = place[0];
    c[4] = place[1];
    c[5] = place[3];
  }
  return result;
}

}  // namespace astroid::detail
