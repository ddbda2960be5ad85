#include "astroid/sim/renderer.hpp"

#include <algorithm>
#include <utility>

#include "astroid/core/math.hpp"
#include "astroid/sim/optics.hpp"

namespace astroid {

namespace {

constexpr double kSplineShare = 0.1;  ///< of that, for a Gaussian as a table

[[noreturn]] void refuse(const Mission& mission, const char* expected, const char* message) {
  throw InputError(Problem{.parameter = "Simulation/Renderer",
                           .value = std::string(to_string(mission.simulation.renderer)),
                           .expected = expected,
                           .message = message});
}

/// Of the Gaussian, charge diffusion included.
double gaussian_sigma(const Mission& mission) {
  return det::hypot(mission.psf.sigma.value(), mission.psf.diffusion.value());
}

PsfTable given_table(const Mission& mission) {
  PsfTable table = read_psf_table(mission.psf.file);
  return mission.psf.diffusion.value() > 0.0 ? diffuse_psf_table(table, mission.psf.diffusion) : std::move(table);
}

FieldSpectrum spectrum_of(const Mission& mission) {
  const PsfSettings& psf = mission.psf;
  const PsfWings wings{.reach = psf.reach, .diffusion = psf.diffusion.value()};
  const auto everywhere = [](std::shared_ptr<const PsfSpectrum> spectrum) {
    return FieldSpectrum{.members = {std::move(spectrum)}, .weights = {}};
  };
  switch (psf.model) {
    case PsfModel::kGaussian:
      return everywhere(make_gaussian_spectrum(gaussian_sigma(mission)));
    case PsfModel::kTable:
      return everywhere(make_table_spectrum(given_table(mission)));
    case PsfModel::kMoffat:
      return everywhere(make_moffat_spectrum(psf.fwhm.value(), psf.beta, wings));
    case PsfModel::kAiry:
      return everywhere(make_airy_spectrum(psf.lambda_over_d.value(), psf.obscuration, wings));
    case PsfModel::kField:
      return make_field_spectrum(read_field_psf(psf.file), psf.diffusion);
  }
  throw BugError("unknown PSF model");
}

}  // namespace

std::string_view to_string(Renderer renderer) {
  switch (renderer) {
    case Renderer::kAuto:
      return "auto";
    case Renderer::kAnalytic:
      return "analytic";
    case Renderer::kPrf:
      return "prf";
    case Renderer::kSubPixel:
      return "subpixel";
  }
  return "?";
}

bool has_intra_pixel_response(const Mission& mission) {
  const IntraPixelSettings& s = mission.psf.intra_pixel;
  return std::max(common_response(s).depth(), s.flat) > 1e-6 * mission.simulation.accuracy.value();
}

PixelResponse common_response(const IntraPixelSettings& settings) {
  switch (settings.profile) {
    case IntraPixelProfile::kEdge:
      return edge_response(settings.cells, settings.depth, settings.width.value());
    case IntraPixelProfile::kCosine:
      return cosine_response(settings.cells, settings.depth);
    case IntraPixelProfile::kGaussian:
      return gaussian_response(settings.cells, settings.depth);
  }
  return {};
}

RendererChoice choose_renderer(const Mission& mission) {
  const bool gaussian = mission.psf.model == PsfModel::kGaussian;
  const bool response = has_intra_pixel_response(mission);
  const bool differs = response && mission.psf.intra_pixel.flat > 0.0;
  switch (mission.simulation.renderer) {
    case Renderer::kAuto:
      if (differs) return {Renderer::kSubPixel, "sensitivity within the pixel differs from pixel to pixel"};
      if (response) return {Renderer::kPrf, "sensitivity within the pixel, the same in all, is part of the PSF"};
      if (gaussian) return {Renderer::kAnalytic, "a Gaussian is integrated over pixels exactly"};
      return {Renderer::kPrf, "the PSF is no Gaussian"};
    case Renderer::kAnalytic:
      if (!gaussian) refuse(mission, "auto, prf or subpixel", "only a Gaussian PSF has a closed form");
      if (response) refuse(mission, "auto, prf or subpixel", "sensitivity varies within the pixel");
      break;
    case Renderer::kPrf:
      if (differs) refuse(mission, "auto or subpixel", "sensitivity within the pixel differs from pixel to pixel");
      break;
    case Renderer::kSubPixel:
      break;
  }
  return {mission.simulation.renderer, "the configuration says so"};
}

std::shared_ptr<const PixelPsf> make_recorded_psf(const Mission& mission, const PsfAccuracy& accuracy,
                                                  std::shared_ptr<const PixelPsf> optical) {
  const bool response = has_intra_pixel_response(mission);
  const bool gaussian = mission.psf.model == PsfModel::kGaussian;
  if (!response && !(gaussian && choose_renderer(mission).renderer == Renderer::kPrf)) return optical;
  const PixelResponse common = response ? common_response(mission.psf.intra_pixel) : PixelResponse{};
  if (!gaussian) return make_psf(mission, accuracy, common);
  return make_prf_psf(
      make_gaussian_table(gaussian_sigma(mission), kSplineShare * accuracy.relative * accuracy.least_light), accuracy,
      mission.psf.phases, common);
}

std::shared_ptr<const SubPixelRenderer> make_sub_pixel_renderer(const Mission& mission, double accuracy, double tight) {
  const bool gaussian = mission.psf.model == PsfModel::kGaussian;
  const SubPixelSettings settings{.accuracy = gaussian ? std::min(accuracy, tight) : accuracy,
                                  .sub_pixels = mission.simulation.sub_pixels,
                                  .cells = has_intra_pixel_response(mission) ? mission.psf.intra_pixel.cells : 1};
  return std::make_shared<const SubPixelRenderer>(spectrum_of(mission),
                                                  Rectangle{0, 0, mission.ccd.columns, mission.ccd.rows}, settings);
}

}  // namespace astroid
