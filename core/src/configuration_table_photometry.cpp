#include "astroid/core/units.hpp"
#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> photometry_parameters() {
  return {
      {.path = "Photometry/Method",
       .kind = Kind::kChoice,
       .fallback = "mask",
       .choices = {"aperture", "mask", "weighted", "psf"},
       .meaning = "How a flux is extracted: circular aperture, optimal binary mask, weighted mask, or PSF weights that "
                  "fit the neighbours too.",
       .example = "mask",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr PhotometryMethod kMethods[] = {PhotometryMethod::kAperture, PhotometryMethod::kMask,
                                                      PhotometryMethod::kWeighted, PhotometryMethod::kPsf};
             m.photometry.method = kMethods[v.choice];
           }},
      {.path = "Photometry/ApertureRadius",
       .unit = "px",
       .range = from_to(0.1, 1000),
       .fallback = "3",
       .meaning = "Radius of the circular aperture.",
       .example = "3",
       .assign = [](Mission& m, const Value& v) { m.photometry.aperture_radius = Pixels(v.real); }},
      {.path = "Photometry/MaskWindow",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(1, 1000),
       .fallback = "6",
       .meaning = "Side of the square window in which a mask may choose pixels and PSF weights are.",
       .example = "6",
       .assign = [](Mission& m, const Value& v) { m.photometry.mask_window = static_cast<int>(v.integer); }},
      {.path = "Photometry/MaskRefresh",
       .unit = "d",
       .range = from_to(0, 10000),
       .fallback = "0",
       .meaning = "Apertures, masks and weights are made anew so often, for the places that drift and aberration lead "
                  "the stars "
                  "to in the middle of each stretch; 0: once, for the nominal pointing.",
       .example = "90",
       .assign = [](Mission& m, const Value& v) { m.photometry.mask_refresh = Seconds(v.real * kSecondsPerDay); }},
      {.path = "Photometry/MaskReach",
       .unit = "px",
       .range = from_to(0, 10000),
       .fallback = "0",
       .meaning =
           "Neighbours farther from the target than this are ignored when its weights are made; 0: as far as the "
           "accuracy needs.",
       .example = "12",
       .assign = [](Mission& m, const Value& v) { m.photometry.mask_reach = Pixels(v.real); }},
      {.path = "Photometry/Background",
       .kind = Kind::kChoice,
       .fallback = "local",
       .choices = {"known", "local", "mesh"},
       .meaning = "How the sky is subtracted: by its true value, by a ring around each star, or by a mesh over the "
                  "image.",
       .example = "local",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr BackgroundMethod kMethods[] = {BackgroundMethod::kKnown, BackgroundMethod::kLocal,
                                                      BackgroundMethod::kMesh};
             m.photometry.background = kMethods[v.choice];
           }},
      {.path = "Photometry/Annulus/Inner",
       .unit = "px",
       .range = from_to(0, 10000),
       .fallback = "5",
       .meaning = "Inner radius of the ring of the local background.",
       .example = "5",
       .assign = [](Mission& m, const Value& v) { m.photometry.annulus_inner = Pixels(v.real); }},
      {.path = "Photometry/Annulus/Outer",
       .unit = "px",
       .range = from_to(0, 10000),
       .fallback = "8",
       .meaning = "Outer radius of the ring of the local background.",
       .example = "8",
       .assign = [](Mission& m, const Value& v) { m.photometry.annulus_outer = Pixels(v.real); }},
      {.path = "Photometry/Mesh",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(4, 10000),
       .fallback = "64",
       .meaning = "Side of a cell of the background mesh.",
       .example = "64",
       .assign = [](Mission& m, const Value& v) { m.photometry.mesh = static_cast<int>(v.integer); }},
      {.path = "Photometry/Calibration/Bias",
       .kind = Kind::kChoice,
       .fallback = "known",
       .choices = {"known", "prescan"},
       .meaning = "Where the bias is taken from: the value of the detector, or the prescan columns of each exposure.",
       .example = "prescan",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr BiasSource kSources[] = {BiasSource::kKnown, BiasSource::kPrescan};
             m.photometry.calibration.bias = kSources[v.choice];
           }},
      {.path = "Photometry/Calibration/Smearing",
       .kind = Kind::kBoolean,
       .fallback = "off",
       .meaning = "Whether the mean of the overscan rows is subtracted from each column.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.photometry.calibration.smearing = v.flag; }},
      {.path = "Photometry/Calibration/NonLinearity",
       .kind = Kind::kBoolean,
       .fallback = "off",
       .meaning = "Whether the response of the electronics is straightened.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.photometry.calibration.nonlinearity = v.flag; }},
      {.path = "Photometry/Calibration/NonLinearityCoefficients",
       .kind = Kind::kRealList,
       .fallback = "",
       .meaning = "Coefficients a0 a1 a2 of the response that the ground believes; none: those of the detector.",
       .example = "0 -0.0043 2.4e-7",
       .assign = [](Mission& m, const Value& v) { m.photometry.calibration.nonlinearity_coefficients = v.reals; }},
      {.path = "Photometry/Calibration/Gain",
       .kind = Kind::kBoolean,
       .fallback = "on",
       .meaning = "Whether each node has its own gain, or all of them the mean one.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.photometry.calibration.gain = v.flag; }},
      {.path = "Photometry/JitterCorrection",
       .kind = Kind::kChoice,
       .fallback = "none",
       .choices = {"none", "known", "centroids"},
       .meaning = "Whether the motion of stars is taken out of light curves, to first order: with the attitude of each "
                  "exposure that the spacecraft tells, or with that measured in its image by how bright stars moved.",
       .example = "centroids",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr JitterCorrection kCorrections[] = {JitterCorrection::kNone, JitterCorrection::kKnown,
                                                          JitterCorrection::kCentroids};
             m.photometry.jitter_correction = kCorrections[v.choice];
           }},
      {.path = "Photometry/Cotrending",
       .kind = Kind::kInteger,
       .range = from_to(0, 16),
       .fallback = "0",
       .meaning =
           "So many trends that light curves have in common are taken out of their bin means, at most: those that "
           "noise alone does not explain; 0: none. Light curves themselves keep them.",
       .example = "4",
       .assign = [](Mission& m, const Value& v) { m.photometry.cotrending = static_cast<int>(v.integer); }},
      {.path = "Photometry/Knowledge/Attitude",
       .unit = "arcsec",
       .range = from_to(0, 3600),
       .fallback = "0",
       .meaning =
           "Rms error of the attitude of an exposure that the spacecraft tells, about each axis (JitterCorrection "
           "known).",
       .example = "0.01",
       .assign = [](Mission& m, const Value& v) { m.photometry.knowledge.attitude = Arcseconds(v.real); }},
      {.path = "Photometry/TargetLimit",
       .unit = "mag",
       .range = from_to(-30, 99),
       .fallback = "99",
       .meaning = "Stars brighter than this, in the zero point's passband, are targets.",
       .example = "13",
       .assign = [](Mission& m, const Value& v) { m.photometry.target_limit = Magnitude(v.real); }},
  };
}

}  // namespace astroid::configuration
