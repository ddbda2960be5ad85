#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "star_estimator_builder.hpp"

namespace astroid {

namespace {

void check_settings(const PixelLayout& layout, const GroundModel& model, const PhotometrySettings& settings) {
  std::vector<Problem> problems;
  const auto complain = [&problems](std::string parameter, std::string value, std::string expected,
                                    std::string message) {
    Problem problem;
    problem.parameter = std::move(parameter);
    problem.value = std::move(value);
    problem.expected = std::move(expected);
    problem.message = std::move(message);
    problems.push_back(std::move(problem));
  };
  const double radius = settings.aperture_radius.value();
  const double inner = settings.annulus_inner.value();
  const double outer = settings.annulus_outer.value();
  if (settings.method == PhotometryMethod::kAperture && !(radius > 0.0 && std::isfinite(radius)))
    complain("Photometry/ApertureRadius", fmt::format("{}", radius), "a radius above 0 px",
             "an aperture needs an area");
  if (settings.method != PhotometryMethod::kAperture && settings.mask_window <= 0)
    complain("Photometry/MaskWindow", fmt::format("{}", settings.mask_window), "at least 1 px",
             "no pixel can be in the mask");
  if (settings.background == BackgroundMethod::kLocal && !(inner >= 0.0 && outer > inner && std::isfinite(outer)))
    complain("Photometry/Annulus", fmt::format("{} to {}", inner, outer), "0 <= inner radius < outer radius, px",
             "the annulus of the local background has no area");
  if (settings.background == BackgroundMethod::kMesh && layout.regions().size() != 1)
    complain("Photometry/Background", "mesh", "known or local",
             fmt::format("a mesh needs one contiguous image, not {} windows", layout.regions().size()));
  if (layout.size() > std::numeric_limits<std::uint32_t>::max())
    complain("CCD/Columns", fmt::format("{} pixels", layout.size()), "fewer than 2^32 pixels",
             "the frame is too large");
  if (!problems.empty()) throw InputError(std::move(problems));
  if (!model.backgrounds.empty()) ASTROID_CHECK_EQ(model.backgrounds.size(), model.targets.size());
  if (model.psf == nullptr) throw BugError("build_estimators: the ground model has no PSF");
}

}  // namespace

std::vector<StarEstimator> build_estimators(const PixelLayout& layout, const GroundModel& model,
                                            const PhotometrySettings& settings) {
  check_settings(layout, model, settings);
  detail::StarEstimatorBuilder builder(layout, model, settings);
  const std::vector<Rectangle> windows = detail::aperture_windows(model, settings);
  const detail::Overlaps overlaps = detail::stamps_on_windows(builder.stamps(), windows);
  std::vector<StarEstimator> estimators;
  estimators.reserve(model.targets.size());
  for (std::size_t i = 0; i < model.targets.size(); ++i) {
    const std::span<const std::size_t> neighbours(overlaps.star.data() + overlaps.first[i],
                                                  overlaps.first[i + 1] - overlaps.first[i]);
    if (!model.backgrounds.empty()) builder.set_background(model.backgrounds[i]);
    estimators.push_back(builder.build(model.targets[i], windows[i], neighbours));
  }
  return estimators;
}

}  // namespace astroid
