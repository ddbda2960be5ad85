// How stars become light on pixels.
#include <array>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> renderer_parameters() {
  return {
      {.path = "Simulation/Renderer",
       .kind = Kind::kChoice,
       .fallback = "auto",
       .choices = {"auto", "analytic", "prf", "subpixel"},
       .meaning =
           "How stars are made: integrated exactly (Gaussians), from a library of pixel-integrated PSFs, on a map "
           "of sub-pixels by Fourier transform, or what fits best.",
       .example = "auto",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr std::array kRenderers = {Renderer::kAuto, Renderer::kAnalytic, Renderer::kPrf,
                                                Renderer::kSubPixel};
             m.simulation.renderer = kRenderers[v.choice];
           }},
      {.path = "Simulation/SubPixels",
       .kind = Kind::kInteger,
       .range = from_to(0, 128),
       .fallback = "0",
       .meaning = "Sub-pixels per pixel and axis of the sub-pixel renderer's map; 0: as many as the accuracy needs.",
       .example = "8",
       .assign = [](Mission& m, const Value& v) { m.simulation.sub_pixels = static_cast<int>(v.integer); }},
  };
}

std::vector<Parameter> intra_pixel_parameters() {
  return {
      {.path = "PSF/IntraPixel/Profile",
       .kind = Kind::kChoice,
       .fallback = "edge",
       .choices = {"edge", "cosine", "gaussian"},
       .meaning =
           "How sensitivity falls from the centre of a pixel to its edge: in a step along the edge, or smoothly.",
       .example = "edge",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr std::array kProfiles = {IntraPixelProfile::kEdge, IntraPixelProfile::kCosine,
                                               IntraPixelProfile::kGaussian};
             m.psf.intra_pixel.profile = kProfiles[v.choice];
           }},
      {.path = "PSF/IntraPixel/Depth",
       .range = from_to(0, 0.99),
       .fallback = "0",
       .meaning = "Sensitivity lost at the edge of a pixel relative to its centre; 0: none.",
       .example = "0.05",
       .assign = [](Mission& m, const Value& v) { m.psf.intra_pixel.depth = v.real; }},
      {.path = "PSF/IntraPixel/Width",
       .unit = "px",
       .range = from_to(0, 0.49),
       .fallback = "0.1",
       .meaning = "Width of the zone along the edge in which the edge profile is lower.",
       .example = "0.1",
       .assign = [](Mission& m, const Value& v) { m.psf.intra_pixel.width = Pixels(v.real); }},
      {.path = "PSF/IntraPixel/Cells",
       .kind = Kind::kInteger,
       .range = from_to(1, 64),
       .fallback = "10",
       .meaning = "Cells per pixel and axis in each of which sensitivity is constant.",
       .example = "10",
       .assign = [](Mission& m, const Value& v) { m.psf.intra_pixel.cells = static_cast<int>(v.integer); }},
      {.path = "PSF/IntraPixel/Flat",
       .range = from_to(0, 0.5),
       .fallback = "0",
       .meaning = "Rms of the cells' own sensitivity, different in every pixel; 0: all pixels are alike.",
       .example = "0.01",
       .assign = [](Mission& m, const Value& v) { m.psf.intra_pixel.flat = v.real; }},
  };
}

}  // namespace astroid::configuration
