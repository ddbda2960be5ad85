#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> psf_parameters() {
  return {
      {.path = "PSF/Model",
       .kind = Kind::kChoice,
       .fallback = "gaussian",
       .choices = {"gaussian", "table"},
       .meaning = "Shape of the point-spread function: a circular Gaussian, or a table in a FITS file.",
       .example = "gaussian",
       .assign = [](Mission& m,
                    const Value& v) { m.psf.model = v.choice == 0 ? PsfModel::kGaussian : PsfModel::kTable; }},
      {.path = "PSF/Sigma",
       .unit = "px",
       .range = from_to(0.05, 100),
       .fallback = "0.6",
       .meaning = "Standard deviation of the Gaussian, before integration over the pixel.",
       .example = "0.6",
       .assign = [](Mission& m, const Value& v) { m.psf.sigma = Pixels(v.real); }},
      {.path = "PSF/File",
       .kind = Kind::kFile,
       .meaning = "FITS file of the table model.",
       .example = "psf.fits",
       .assign = [](Mission& m, const Value& v) { m.psf.file = v.text; }},
      {.path = "PSF/Phases",
       .kind = Kind::kInteger,
       .range = from_to(0, 1024),
       .fallback = "0",
       .meaning = "Sub-pixel phases per axis of the pixel-integrated PSF library; 0: as many as the accuracy needs.",
       .example = "16",
       .assign = [](Mission& m, const Value& v) { m.psf.phases = static_cast<int>(v.integer); }},
      {.path = "PSF/StampHalfWidth",
       .unit = "px",
       .range = from_to(0, 10000),
       .fallback = "0",
       .meaning = "Half the side of the square in which a star is rendered; 0: as far as the accuracy needs.",
       .example = "6",
       .assign = [](Mission& m, const Value& v) { m.psf.stamp_half_width = Pixels(v.real); }},
  };
}

}  // namespace astroid::configuration
