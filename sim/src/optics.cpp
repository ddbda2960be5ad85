#include "astroid/sim/optics.hpp"

#include <cstddef>
#include <vector>

#include "astroid/core/camera_groups.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

double coefficient(const std::vector<double>& list, std::size_t i) {
  return i < list.size() ? list[i] : 0.0;
}

}  // namespace

std::shared_ptr<const Distortion> make_distortion(const Mission& mission) {
  const DistortionSettings& d = mission.telescope.distortion;
  switch (d.model) {
    case DistortionModel::kNone:
      return nullptr;
    case DistortionModel::kRadial: {
      const double radians_per_pixel = to_radians(to_degrees(Pixels(1.0) * mission.ccd.pixel_scale)).value();
      return make_radial_distortion({.k1 = coefficient(d.radial, 0),
                                     .k2 = coefficient(d.radial, 1),
                                     .k3 = coefficient(d.radial, 2),
                                     .p1 = coefficient(d.tangential, 0),
                                     .p2 = coefficient(d.tangential, 1),
                                     .s1 = coefficient(d.prism, 0),
                                     .s2 = coefficient(d.prism, 1)},
                                    Pixels(1.0 / radians_per_pixel));
    }
    case DistortionModel::kSip:
      return make_sip_distortion(read_sip_polynomial(d.file));
  }
  return nullptr;
}

CameraPointing make_pointing(const Mission& mission) {
  const CcdSettings& ccd = mission.ccd;
  const Boresight camera = camera_boresight(mission);
  return {.axis = camera.axis,
          .roll = camera.roll,
          .scale = ccd.pixel_scale,
          .axis_pixel = {ccd.axis_x, ccd.axis_y},
          .projection = ccd.projection,
          .distortion = make_distortion(mission),
          .detector = {0, 0, ccd.columns, ccd.rows},
          .spacecraft = spacecraft_boresight(mission)};
}

SkyProjection make_projection(const Mission& mission) {
  return SkyProjection(make_pointing(mission));
}

std::shared_ptr<const PixelPsf> make_psf(const Mission& mission, const PsfAccuracy& accuracy,
                                         const PixelResponse& response) {
  const PsfSettings& psf = mission.psf;
  const PsfWings wings{.reach = psf.reach, .diffusion = psf.diffusion.value()};
  switch (psf.model) {
    case PsfModel::kGaussian:
      return make_gaussian_psf(psf.diffusion.value() > 0.0 ? det::hypot(psf.sigma.value(), psf.diffusion.value())
                                                           : psf.sigma.value());
    case PsfModel::kTable:
      return make_prf_psf(psf.diffusion.value() > 0.0 ? diffuse_psf_table(read_psf_table(psf.file), psf.diffusion)
                                                      : read_psf_table(psf.file),
                          accuracy, psf.phases, response);
    case PsfModel::kMoffat:
      return make_moffat_psf(psf.fwhm.value(), psf.beta, wings, accuracy, psf.phases, response);
    case PsfModel::kAiry:
      return make_airy_psf(psf.lambda_over_d.value(), psf.obscuration, wings, accuracy, psf.phases, response);
    case PsfModel::kField:
      return make_field_psf(read_field_psf(psf.file), psf.diffusion, accuracy, psf.phases, response);
  }
  throw BugError("unknown PSF model");
}

double psf_reach(const Mission& mission, double lost) {
  if (mission.psf.model == PsfModel::kMoffat || mission.psf.model == PsfModel::kAiry) return mission.psf.reach;
  // What a table reaches does not depend on the phases of its library.
  Mission sketch = mission;
  sketch.psf.phases = 1;
  return make_psf(sketch, 1.0)->stamp_half_width(lost);
}

}  // namespace astroid
