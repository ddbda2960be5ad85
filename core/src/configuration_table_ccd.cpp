#include <utility>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr double kPercentInOne = 100.0;      // a percentage as a fraction
constexpr double kLargestDetector = 100000;  // columns or rows: a few times any detector made
constexpr Range kSide = from_to(1, kLargestDetector);
constexpr Range kPixelIndex = from_to(0, kLargestDetector - 1);
constexpr Range kAxisRange = from_to(-1e7, 1e7);  // px; the axis may lie far outside one of several detectors

std::vector<Parameter> geometry_parameters() {
  return {
      {.path = "CCD/Columns",
       .kind = Kind::kInteger,
       .is_required = true,
       .range = kSide,
       .meaning = "Number of columns of the detector.",
       .example = "4510",
       .assign = [](Mission& m, const Value& v) { m.ccd.columns = static_cast<int>(v.integer); }},
      {.path = "CCD/Rows",
       .kind = Kind::kInteger,
       .is_required = true,
       .range = kSide,
       .meaning = "Number of rows of the detector.",
       .example = "4510",
       .assign = [](Mission& m, const Value& v) { m.ccd.rows = static_cast<int>(v.integer); }},
      {.path = "CCD/PixelScale",
       .unit = "arcsec/px",
       .range = from_to(1e-4, 3600),
       .fallback = "15",
       .meaning = "Angle on the sky that one pixel spans at the optical axis.",
       .example = "15",
       .assign = [](Mission& m, const Value& v) { m.ccd.pixel_scale = PixelScale(v.real); }},
      {.path = "CCD/Projection",
       .kind = Kind::kChoice,
       .fallback = "TAN",
       .choices = {"TAN", "SIN", "ARC", "STG", "ZEA"},
       .meaning = "Zenithal projection of the optics, by its FITS WCS code.",
       .example = "TAN",
       .assign = [](Mission& m, const Value& v) { m.ccd.projection = v.text; }},
      {.path = "CCD/OpticalAxis/X",
       .unit = "px",
       .range = kAxisRange,
       .fallback = "centre",
       .keyword = "centre",
       .meaning = "Column where the optical axis meets the detector; centre: (Columns - 1) / 2.",
       .example = "2254.5",
       .assign = [](Mission& m, const Value& v) { m.ccd.axis_x = v.is_keyword ? 0.5 * (m.ccd.columns - 1) : v.real; }},
      {.path = "CCD/OpticalAxis/Y",
       .unit = "px",
       .range = kAxisRange,
       .fallback = "centre",
       .keyword = "centre",
       .meaning = "Row where the optical axis meets the detector; centre: (Rows - 1) / 2.",
       .example = "2254.5",
       .assign = [](Mission& m, const Value& v) { m.ccd.axis_y = v.is_keyword ? 0.5 * (m.ccd.rows - 1) : v.real; }},
      {.path = "CCD/SubField/x",
       .kind = Kind::kInteger,
       .is_attribute = true,
       .is_required_in_parent = true,
       .range = kPixelIndex,
       .meaning = "First column of the sub-field.",
       .example = "1755",
       .assign =
           [](Mission& m, const Value& v) {
             m.ccd.has_sub_field = true;
             m.ccd.sub_x0 = static_cast<int>(v.integer);
           }},
      {.path = "CCD/SubField/y",
       .kind = Kind::kInteger,
       .is_attribute = true,
       .is_required_in_parent = true,
       .range = kPixelIndex,
       .meaning = "First row of the sub-field.",
       .example = "1755",
       .assign = [](Mission& m, const Value& v) { m.ccd.sub_y0 = static_cast<int>(v.integer); }},
      {.path = "CCD/SubField/columns",
       .kind = Kind::kInteger,
       .is_attribute = true,
       .is_required_in_parent = true,
       .range = kSide,
       .meaning = "Number of columns of the sub-field.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.ccd.sub_columns = static_cast<int>(v.integer); }},
      {.path = "CCD/SubField/rows",
       .kind = Kind::kInteger,
       .is_attribute = true,
       .is_required_in_parent = true,
       .range = kSide,
       .meaning = "Number of rows of the sub-field.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.ccd.sub_rows = static_cast<int>(v.integer); }},
      {.path = "CCD/Window",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(0, 10000),
       .fallback = "0",
       .meaning = "Side of the square window around each target; 0: the whole field instead of windows.",
       .example = "12",
       .assign = [](Mission& m, const Value& v) { m.ccd.window = static_cast<int>(v.integer); }},
  };
}

std::vector<Parameter> response_parameters() {
  return {
      {.path = "CCD/FullWell",
       .unit = "e-",
       .range = from_to(1, 1e9),
       .fallback = "900000",
       .meaning = "Charge that a pixel holds at most.",
       .example = "900000",
       .assign = [](Mission& m, const Value& v) { m.ccd.full_well = Electrons(v.real); }},
      {.path = "CCD/Blooming",
       .kind = Kind::kBoolean,
       .fallback = "on",
       .meaning = "Whether charge beyond the full well spills along the column, or is lost.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.ccd.blooming = v.flag; }},
      {.path = "CCD/DarkCurrent",
       .unit = "e-/px/s",
       .range = from_to(0, 1e7),
       .fallback = "0",
       .meaning = "Mean dark current of a pixel.",
       .example = "1.2",
       .assign = [](Mission& m, const Value& v) { m.ccd.dark_current = ElectronsPerSecond(v.real); }},
      {.path = "CCD/DSNU",
       .unit = "%",
       .range = from_to(0, 100),
       .fallback = "0",
       .meaning = "Dark-signal non-uniformity: rms over pixels, relative to the dark current.",
       .example = "15",
       .assign = [](Mission& m, const Value& v) { m.ccd.dsnu = v.real / kPercentInOne; }},
      {.path = "CCD/PRNU",
       .unit = "%",
       .range = from_to(0, 50),
       .fallback = "0",
       .meaning = "Photo-response non-uniformity: rms of the pixels' sensitivity.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.ccd.prnu = v.real / kPercentInOne; }},
      {.path = "CCD/ReadoutNoise",
       .unit = "e-",
       .range = from_to(0, 1e5),
       .fallback = "0",
       .meaning = "Rms noise of reading a pixel once, detector and electronics together.",
       .example = "50.2",
       .assign = [](Mission& m, const Value& v) { m.ccd.readout_noise = Electrons(v.real); }},
      {.path = "CCD/Gain",
       .unit = "e-/ADU",
       .range = from_to(1e-4, 1e6),
       .fallback = "1",
       .meaning = "Electrons per unit of the analogue-to-digital converter.",
       .example = "25",
       .assign = [](Mission& m, const Value& v) { m.ccd.gain = Gain(v.real); }},
      {.path = "CCD/Bias",
       .unit = "ADU",
       .range = from_to(0, 4294967295.0),
       .fallback = "0",
       .meaning = "Level added to every pixel before digitising.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.ccd.bias = Adu(v.real); }},
      {.path = "CCD/ADCBits",
       .kind = Kind::kInteger,
       .range = from_to(4, 32),
       .fallback = "16",
       .meaning = "Bits of the analogue-to-digital converter: pixels saturate at 2^bits - 1 ADU.",
       .example = "16",
       .assign = [](Mission& m, const Value& v) { m.ccd.adc_bits = static_cast<int>(v.integer); }},
  };
}

}  // namespace

std::vector<Parameter> ccd_parameters() {
  std::vector<Parameter> parameters = geometry_parameters();
  for (Parameter& parameter : response_parameters()) parameters.push_back(std::move(parameter));
  return parameters;
}

}  // namespace astroid::configuration
