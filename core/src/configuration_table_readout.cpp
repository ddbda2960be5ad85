// Parameters of how a CCD is read: reference pixels, smearing, nodes, electronics, bad pixels.
#include <utility>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr double kPercentInOne = 100.0;
constexpr double kMostReferencePixels = 10000;  // columns or rows: as many as a large detector has of sensitive ones

void append(std::vector<Parameter>& table, std::vector<Parameter> more) {
  for (Parameter& parameter : more) table.push_back(std::move(parameter));
}

std::vector<Parameter> reference_parameters() {
  return {
      {.path = "CCD/ReferencePixels/Prescan",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(0, kMostReferencePixels),
       .fallback = "0",
       .meaning = "Columns that are read before the first one and show the bias.",
       .example = "25",
       .assign = [](Mission& m, const Value& v) { m.ccd.reference.prescan = static_cast<int>(v.integer); }},
      {.path = "CCD/ReferencePixels/SerialOverscan",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(0, kMostReferencePixels),
       .fallback = "0",
       .meaning = "Columns that are read after the last one; with two nodes or more, the prescan of the right half.",
       .example = "15",
       .assign = [](Mission& m, const Value& v) { m.ccd.reference.serial_overscan = static_cast<int>(v.integer); }},
      {.path = "CCD/ReferencePixels/Overscan",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(0, kMostReferencePixels),
       .fallback = "0",
       .meaning =
           "Rows that are read after the last one and show what is smeared into each column; with four nodes, as many "
           "behind each half: they lie below the first row for the lower half.",
       .example = "30",
       .assign = [](Mission& m, const Value& v) { m.ccd.reference.parallel_overscan = static_cast<int>(v.integer); }},
  };
}

std::vector<Parameter> smearing_parameters() {
  constexpr Range kDuration = above_up_to(0, 1e6);
  return {
      {.path = "CCD/Smearing/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "none",
       .choices = {"none", "open-shutter", "frame-transfer"},
       .meaning =
           "Whether light falls on charge while it is moved: never (a shutter), while the frame is read, or while "
           "it is moved into a dark store.",
       .example = "open-shutter",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr SmearingModel kModels[] = {SmearingModel::kNone, SmearingModel::kOpenShutter,
                                                  SmearingModel::kFrameTransfer};
             m.ccd.smearing.model = kModels[v.choice];
           }},
      {.path = "CCD/Smearing/Time",
       .unit = "s",
       .range = kDuration,
       .fallback = "4.019",
       .meaning =
           "Time in which all rows of the detector, with four nodes those of either half, are moved past the light: of "
           "reading the frame, or of moving it into the store.",
       .example = "4.019",
       .assign = [](Mission& m, const Value& v) { m.ccd.smearing.time = Seconds(v.real); }},
      {.path = "CCD/Smearing/ClearTime",
       .unit = "s",
       .range = from_to(0, 1e6),
       .fallback = "same",
       .keyword = "same",
       .meaning =
           "The same of the transfer before the exposure, with frame transfer; 0: the charge is dumped where it is; "
           "same: as Time.",
       .example = "0",
       .assign =
           [](Mission& m, const Value& v) {
             m.ccd.smearing.clear_time = v.is_keyword ? m.ccd.smearing.time : Seconds(v.real);
           }},
  };
}

std::vector<Parameter> node_parameters() {
  return {
      {.path = "CCD/Nodes/Count",
       .kind = Kind::kChoice,
       .fallback = "1",
       .choices = {"1", "2", "4"},
       .meaning =
           "Nodes that read the detector at the same time: one, one for each half of the columns, or one for each "
           "quadrant.",
       .example = "2",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr int kCounts[] = {1, 2, 4};
             m.ccd.nodes.count = kCounts[v.choice];
           }},
      {.path = "CCD/Nodes/GainFactors",
       .kind = Kind::kRealList,
       .range = from_to(0.01, 100),
       .fallback = "",
       .meaning =
           "Gain of each node relative to CCD/Gain: left, right, upper left, upper right; none: all have that gain.",
       .example = "1 1.03",
       .assign = [](Mission& m, const Value& v) { m.ccd.nodes.gain_factor = v.reals; }},
      {.path = "CCD/Nodes/NoiseFactors",
       .kind = Kind::kRealList,
       .range = from_to(0, 100),
       .fallback = "",
       .meaning = "Readout noise of each node relative to CCD/ReadoutNoise; none: all have that noise.",
       .example = "1 1.2",
       .assign = [](Mission& m, const Value& v) { m.ccd.nodes.noise_factor = v.reals; }},
      {.path = "CCD/Nodes/CrossTalk",
       .range = from_to(-1, 1),
       .fallback = "0",
       .meaning = "Share of the signal of each node that appears in the pixels the others read at the same time.",
       .example = "1e-4",
       .assign = [](Mission& m, const Value& v) { m.ccd.nodes.cross_talk = v.real; }},
  };
}

std::vector<Parameter> electronics_parameters() {
  return {
      {.path = "CCD/Electronics/NonLinearity",
       .kind = Kind::kRealList,
       .fallback = "",
       .meaning =
           "Coefficients a0 a1 a2 of the response: a signal of I ADU becomes I + a0 + a1 I + a2 I²; none: linear.",
       .example = "0 -0.0042789409 2.365e-7",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.nonlinearity = v.reals; }},
      {.path = "CCD/Electronics/GainDrift",
       .unit = "%",
       .range = from_to(0, 50),
       .fallback = "0",
       .meaning = "Amplitude of a slow sinusoidal change of the gain, as with the temperature of the electronics.",
       .example = "0.01",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.gain_drift = v.real / kPercentInOne; }},
      {.path = "CCD/Electronics/BiasDrift",
       .unit = "ADU",
       .range = from_to(0, 1e6),
       .fallback = "0",
       .meaning = "Amplitude of a slow sinusoidal change of the bias.",
       .example = "2",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.bias_drift = v.real; }},
      {.path = "CCD/Electronics/DriftPeriod",
       .unit = "s",
       .range = above_up_to(0, 1e9),
       .fallback = "86400",
       .meaning = "Period of the changes of gain and bias.",
       .example = "86400",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.drift_period = Seconds(v.real); }},
      {.path = "CCD/Electronics/RowOffset",
       .unit = "ADU",
       .range = from_to(0, 1e6),
       .fallback = "0",
       .meaning = "Rms of a random offset that all pixels of a row share, of each node, new in each exposure.",
       .example = "0.1",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.row_offset = v.real; }},
      {.path = "CCD/Electronics/PickUpAmplitude",
       .unit = "ADU",
       .range = from_to(0, 1e6),
       .fallback = "0",
       .meaning =
           "Amplitude of a sinusoid that interference adds along the readout, with a random phase in each exposure.",
       .example = "2",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.pick_up.amplitude = v.real; }},
      {.path = "CCD/Electronics/PickUpColumnFrequency",
       .range = from_to(-0.5, 0.5),
       .fallback = "0",
       .meaning = "Cycles of that sinusoid per pixel from column to column.",
       .example = "0.21",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.pick_up.column_frequency = v.real; }},
      {.path = "CCD/Electronics/PickUpRowFrequency",
       .range = from_to(-0.5, 0.5),
       .fallback = "0",
       .meaning = "Cycles of that sinusoid per pixel from row to row.",
       .example = "0.03",
       .assign = [](Mission& m, const Value& v) { m.ccd.electronics.pick_up.row_frequency = v.real; }},
  };
}

std::vector<Parameter> bad_pixel_parameters() {
  return {
      {.path = "CCD/BadPixels/Dead",
       .unit = "%",
       .range = from_to(0, 100),
       .fallback = "0",
       .meaning = "Fraction of the pixels that see no light.",
       .example = "0.01",
       .assign = [](Mission& m, const Value& v) { m.ccd.bad_pixels.dead = v.real / kPercentInOne; }},
      {.path = "CCD/BadPixels/Hot",
       .unit = "%",
       .range = from_to(0, 100),
       .fallback = "0",
       .meaning = "Fraction of the pixels that have a large dark current.",
       .example = "0.01",
       .assign = [](Mission& m, const Value& v) { m.ccd.bad_pixels.hot = v.real / kPercentInOne; }},
      {.path = "CCD/BadPixels/HotCurrent",
       .unit = "e-/px/s",
       .range = from_to(0, 1e9),
       .fallback = "1000",
       .meaning = "Dark current of a hot pixel, beyond that of the others.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.ccd.bad_pixels.hot_current = ElectronsPerSecond(v.real); }},
      {.path = "CCD/BadPixels/File",
       .kind = Kind::kFile,
       .meaning = "Bad pixels beside those drawn: a table with columns x, y (0-based) and perhaps kind (dead, hot, "
                  "column) and "
                  "rate_e_per_s of hot ones, or a FITS image of the whole detector with 0 good, 1 dead, 2 hot.",
       .example = "bad_pixels.csv",
       .assign = [](Mission& m, const Value& v) { m.ccd.bad_pixels.file = v.text; }},
  };
}

}  // namespace

std::vector<Parameter> readout_parameters() {
  std::vector<Parameter> parameters = reference_parameters();
  append(parameters, smearing_parameters());
  append(parameters, node_parameters());
  append(parameters, electronics_parameters());
  append(parameters, bad_pixel_parameters());
  return parameters;
}

}  // namespace astroid::configuration
