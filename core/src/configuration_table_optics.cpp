#include <array>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr Range kCoefficients = from_to(-1e6, 1e6);

}  // namespace

std::vector<Parameter> optics_parameters() {
  return {
      {.path = "Telescope/Throughput",
       .range = above_up_to(0, 1),
       .fallback = "1",
       .meaning = "Light that the optics pass at the beginning of life, relative to what the zero point and the sky "
                  "background already include.",
       .example = "0.92",
       .assign = [](Mission& m, const Value& v) { m.telescope.throughput.beginning_of_life = v.real; }},
      {.path = "Telescope/Ageing/EndOfLife",
       .range = above_up_to(0, 1),
       .fallback = "1",
       .meaning = "Throughput at the end of life relative to the beginning; it falls linearly in between and after.",
       .example = "0.977",
       .assign = [](Mission& m, const Value& v) { m.telescope.throughput.end_of_life = v.real; }},
      {.path = "Telescope/Ageing/Lifetime",
       .unit = "yr",
       .range = from_to(0.01, 100),
       .fallback = "6.5",
       .meaning = "Time from the beginning to the end of life.",
       .example = "6.5",
       .assign = [](Mission& m, const Value& v) { m.telescope.throughput.lifetime_years = v.real; }},
      {.path = "Telescope/Ageing/Age",
       .unit = "yr",
       .range = from_to(0, 100),
       .fallback = "0",
       .meaning = "Age of the optics at the start of the run.",
       .example = "2",
       .assign = [](Mission& m, const Value& v) { m.telescope.throughput.age_years = v.real; }},
      {.path = "Telescope/Distortion/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "none",
       .choices = {"none", "radial", "sip"},
       .meaning = "Distortion of the field: none, radial and tangential polynomials, or SIP coefficients of a FITS "
                  "header.",
       .example = "radial",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr std::array kModels = {DistortionModel::kNone, DistortionModel::kRadial, DistortionModel::kSip};
             m.telescope.distortion.model = kModels[v.choice];
           }},
      {.path = "Telescope/Distortion/Radial",
       .kind = Kind::kRealList,
       .range = kCoefficients,
       .meaning =
           "Radial coefficients k1, k2 and k3: x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) where the focal length is 1.",
       .example = "0.32419 0.0232909 0.407979",
       .assign = [](Mission& m, const Value& v) { m.telescope.distortion.radial = v.reals; }},
      {.path = "Telescope/Distortion/Tangential",
       .kind = Kind::kRealList,
       .range = kCoefficients,
       .meaning = "Decentring coefficients p1 and p2, which add 2 p1 x y + p2 (r^2 + 2 x^2) to x' and "
                  "p1 (r^2 + 2 y^2) + 2 p2 x y to y'.",
       .example = "4.8e-4 1.9e-4",
       .assign = [](Mission& m, const Value& v) { m.telescope.distortion.tangential = v.reals; }},
      {.path = "Telescope/Distortion/Prism",
       .kind = Kind::kRealList,
       .range = kCoefficients,
       .meaning = "Thin-prism coefficients s1 and s2, which add s1 r^2 to x' and s2 r^2 to y'.",
       .example = "3.4e-5 -2.6e-4",
       .assign = [](Mission& m, const Value& v) { m.telescope.distortion.prism = v.reals; }},
      {.path = "Telescope/Distortion/File",
       .kind = Kind::kFile,
       .meaning = "FITS file whose primary header holds A_ORDER, B_ORDER, A_i_j and B_i_j of the sip model, in pixels "
                  "from the optical axis.",
       .example = "distortion.fits",
       .assign = [](Mission& m, const Value& v) { m.telescope.distortion.file = v.text; }},
      {.path = "Telescope/Vignetting/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "none",
       .choices = {"none", "cos2", "polynomial"},
       .meaning =
           "How the light falls off with the field angle: not at all, as its squared cosine, or as a polynomial.",
       .example = "polynomial",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr std::array kModels = {VignettingModel::kNone, VignettingModel::kCosineSquared,
                                             VignettingModel::kPolynomial};
             m.telescope.vignetting.model = kModels[v.choice];
           }},
      {.path = "Telescope/Vignetting/Polynomial",
       .kind = Kind::kRealList,
       .range = from_to(-100, 100),
       .meaning = "Percent lost at x degrees from the optical axis: coefficients of x^2, x^4, x^6 and so on.",
       .example = "4.18e-2 -5.65e-5 2.37e-7",
       .assign = [](Mission& m, const Value& v) { m.telescope.vignetting.polynomial = v.reals; }},
      {.path = "Telescope/Ghosts/Fraction",
       .range = from_to(0, 0.1),
       .fallback = "0",
       .meaning = "Light of a star's ghost relative to the star; 0: no ghosts.",
       .example = "1e-4",
       .assign = [](Mission& m, const Value& v) { m.telescope.ghosts.fraction = v.real; }},
      {.path = "Telescope/Ghosts/Radius",
       .unit = "px",
       .range = from_to(0.5, 10000),
       .fallback = "50",
       .meaning = "Radius of the uniform disc that is a ghost, mirrored through the optical axis.",
       .example = "50",
       .assign = [](Mission& m, const Value& v) { m.telescope.ghosts.radius = Pixels(v.real); }},
      {.path = "Telescope/Ghosts/BrighterThan",
       .unit = "mag",
       .range = from_to(-30, 40),
       .fallback = "8",
       .meaning = "Stars brighter than this have a ghost.",
       .example = "8",
       .assign = [](Mission& m, const Value& v) { m.telescope.ghosts.brighter_than = Magnitude(v.real); }},
  };
}

}  // namespace astroid::configuration
