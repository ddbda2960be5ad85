#include <array>
#include <utility>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr double kPercentInOne = 100.0;  // a percentage as a fraction
constexpr double kMostReads = 254;       // increments are counted in a byte
constexpr double kLargestNoise = 1e5;    // e-
constexpr double kLongestStay = 1e9;     // s

std::vector<Parameter> read_parameters() {
  return {
      {.path = "CMOS/Reads",
       .kind = Kind::kInteger,
       .range = from_to(1, kMostReads),
       .fallback = "1",
       .meaning =
           "Reads of an exposure: 1 at its end, or several from its beginning to its end without a reset between.",
       .example = "16",
       .assign = [](Mission& m, const Value& v) { m.cmos.reads = static_cast<int>(v.integer); }},
      {.path = "CMOS/RampFit",
       .kind = Kind::kChoice,
       .fallback = "optimal",
       .choices = {"difference", "least-squares", "optimal"},
       .meaning =
           "How several reads become one number: the last minus the first, a straight line, or a line weighted for "
           "the charge that a pixel is expected to hold.",
       .example = "optimal",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr std::array kFits{RampFit::kDifference, RampFit::kLeastSquares, RampFit::kOptimal};
             m.cmos.ramp_fit = kFits.at(v.choice);
           }},
      {.path = "CMOS/ResetNoise",
       .unit = "e-",
       .range = from_to(0, kLargestNoise),
       .fallback = "0",
       .meaning = "Rms charge that a reset leaves on a pixel (kTC noise), the same in all reads of an exposure.",
       .example = "44",
       .assign = [](Mission& m, const Value& v) { m.cmos.reset_noise = Electrons(v.real); }},
      {.path = "CMOS/ColumnNoise",
       .unit = "e-",
       .range = from_to(0, kLargestNoise),
       .fallback = "0",
       .meaning = "Rms noise of one read that all pixels of a column share.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.cmos.column_noise = Electrons(v.real); }},
      {.path = "CMOS/RowNoise",
       .unit = "e-",
       .range = from_to(0, kLargestNoise),
       .fallback = "0",
       .meaning = "Rms noise of one read that all pixels of a row share.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.cmos.row_noise = Electrons(v.real); }},
  };
}

std::vector<Parameter> memory_parameters() {
  return {
      {.path = "CMOS/Persistence/Fraction",
       .kind = Kind::kRealList,
       .unit = "%",
       .range = from_to(0, 20),
       .meaning =
           "Share of the charge of an exposure that each kind of trap holds at its end and releases later; unset "
           "or 0: none.",
       .example = "0.3 0.1",
       .assign =
           [](Mission& m, const Value& v) {
             m.cmos.persistence.fraction = v.reals;
             for (double& share : m.cmos.persistence.fraction) share /= kPercentInOne;
           }},
      {.path = "CMOS/Persistence/Time",
       .kind = Kind::kRealList,
       .unit = "s",
       .range = above_up_to(0, 1e6),
       .meaning = "Mean time after which each kind of trap releases its charge.",
       .example = "60 900",
       .assign = [](Mission& m, const Value& v) { m.cmos.persistence.time = v.reals; }},
      {.path = "CMOS/LineTime",
       .unit = "s",
       .range = from_to(0, 1e4),
       .fallback = "0",
       .meaning = "Time by which each row begins and ends its exposure later than the row below it (rolling shutter); "
                  "0: all rows at once.",
       .example = "0.002",
       .assign = [](Mission& m, const Value& v) { m.cmos.line_time = Seconds(v.real); }},
  };
}

std::vector<Parameter> pixel_parameters() {
  return {
      {.path = "CMOS/GainSpread",
       .unit = "%",
       .range = from_to(0, 50),
       .fallback = "0",
       .meaning = "Rms over pixels of the gain of their amplifiers, relative; fixed.",
       .example = "0.5",
       .assign = [](Mission& m, const Value& v) { m.cmos.gain_rms = v.real / kPercentInOne; }},
      {.path = "CMOS/OffsetSpread",
       .unit = "ADU",
       .range = from_to(0, 1e6),
       .fallback = "0",
       .meaning = "Rms over pixels of the offset of their amplifiers; fixed.",
       .example = "20",
       .assign = [](Mission& m, const Value& v) { m.cmos.offset_rms = Adu(v.real); }},
      {.path = "CMOS/ReadoutNoiseSpread",
       .range = from_to(0, 1),
       .fallback = "0",
       .meaning =
           "Rms over pixels of the natural logarithm of their readout noise; CCD/ReadoutNoise is the rms of all.",
       .example = "0.2",
       .assign = [](Mission& m, const Value& v) { m.cmos.noise_rms = v.real; }},
      {.path = "CMOS/Coupling/Side",
       .unit = "%",
       .range = from_to(0, 15),
       .fallback = "0",
       .meaning = "Share of a pixel's signal that appears in each of the four neighbours at its sides.",
       .example = "0.8",
       .assign = [](Mission& m, const Value& v) { m.cmos.coupling = v.real / kPercentInOne; }},
      {.path = "CMOS/Coupling/Corner",
       .unit = "%",
       .range = from_to(0, 5),
       .fallback = "0",
       .meaning = "Share of a pixel's signal that appears in each of the four neighbours at its corners.",
       .example = "0.1",
       .assign = [](Mission& m, const Value& v) { m.cmos.corner_coupling = v.real / kPercentInOne; }},
      {.path = "CMOS/Telegraph/Fraction",
       .unit = "%",
       .range = from_to(0, 100),
       .fallback = "0",
       .meaning = "Pixels whose dark current jumps between two states.",
       .example = "0.1",
       .assign = [](Mission& m, const Value& v) { m.cmos.telegraph_fraction = v.real / kPercentInOne; }},
      {.path = "CMOS/Telegraph/Current",
       .unit = "e-/px/s",
       .range = from_to(0, 1e7),
       .fallback = "0",
       .meaning = "Dark current that the high state of such a pixel has more than its low one.",
       .example = "20",
       .assign = [](Mission& m, const Value& v) { m.cmos.telegraph_current = ElectronsPerSecond(v.real); }},
      {.path = "CMOS/Telegraph/LowTime",
       .unit = "s",
       .range = above_up_to(0, kLongestStay),
       .fallback = "1000",
       .meaning = "Mean time that such a pixel stays in its low state.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.cmos.telegraph_low = Seconds(v.real); }},
      {.path = "CMOS/Telegraph/HighTime",
       .unit = "s",
       .range = above_up_to(0, kLongestStay),
       .fallback = "1000",
       .meaning = "Mean time that such a pixel stays in its high state.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.cmos.telegraph_high = Seconds(v.real); }},
  };
}

}  // namespace

std::vector<Parameter> cmos_parameters() {
  std::vector<Parameter> parameters = read_parameters();
  for (Parameter& parameter : pixel_parameters()) parameters.push_back(std::move(parameter));
  for (Parameter& parameter : memory_parameters()) parameters.push_back(std::move(parameter));
  return parameters;
}

}  // namespace astroid::configuration
