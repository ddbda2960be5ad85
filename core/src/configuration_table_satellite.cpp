#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr Range kJitterRange = from_to(0, 3600);  // rms, arcsec

}  // namespace

std::vector<Parameter> satellite_parameters() {
  return {
      {.path = "Satellite/Pointing/RA",
       .is_required = true,
       .unit = "deg",
       .range = from_to(0, 360),
       .meaning = "Right ascension of the optical axis.",
       .example = "95.3104",
       .assign = [](Mission& m, const Value& v) { m.satellite.ra = Degrees(v.real); }},
      {.path = "Satellite/Pointing/Dec",
       .is_required = true,
       .unit = "deg",
       .range = from_to(-90, 90),
       .meaning = "Declination of the optical axis.",
       .example = "-47.8869",
       .assign = [](Mission& m, const Value& v) { m.satellite.dec = Degrees(v.real); }},
      {.path = "Satellite/Pointing/Roll",
       .unit = "deg",
       .range = from_to(-360, 360),
       .fallback = "0",
       .meaning = "Rotation of the detector about the optical axis, from north through east.",
       .example = "0",
       .assign = [](Mission& m, const Value& v) { m.satellite.roll = Degrees(v.real); }},
      {.path = "Satellite/Jitter/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "none",
       .choices = {"none", "red-noise", "file", "psd"},
       .meaning = "Where the attitude noise comes from: nothing, an Ornstein-Uhlenbeck process with the rms and time "
                  "scale given, a file of angles, or noise with the power spectral density in a file.",
       .example = "red-noise",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr JitterModel kModels[] = {JitterModel::kNone, JitterModel::kRedNoise, JitterModel::kFile,
                                                JitterModel::kSpectrum};
             m.satellite.jitter.model = kModels[v.choice];
           }},
      {.path = "Satellite/Jitter/Yaw",
       .unit = "arcsec",
       .range = kJitterRange,
       .fallback = "0",
       .meaning = "Rms of the yaw angle (red-noise model).",
       .example = "0.038",
       .assign = [](Mission& m, const Value& v) { m.satellite.jitter.yaw = Arcseconds(v.real); }},
      {.path = "Satellite/Jitter/Pitch",
       .unit = "arcsec",
       .range = kJitterRange,
       .fallback = "0",
       .meaning = "Rms of the pitch angle (red-noise model).",
       .example = "0.038",
       .assign = [](Mission& m, const Value& v) { m.satellite.jitter.pitch = Arcseconds(v.real); }},
      {.path = "Satellite/Jitter/Roll",
       .unit = "arcsec",
       .range = kJitterRange,
       .fallback = "0",
       .meaning = "Rms of the roll angle about the optical axis (red-noise model).",
       .example = "0.040",
       .assign = [](Mission& m, const Value& v) { m.satellite.jitter.roll = Arcseconds(v.real); }},
      {.path = "Satellite/Jitter/Timescale",
       .unit = "s",
       .range = above_up_to(0, 1e7),
       .fallback = "250",
       .meaning = "Correlation time of the attitude (red-noise model).",
       .example = "250",
       .assign = [](Mission& m, const Value& v) { m.satellite.jitter.timescale = Seconds(v.real); }},
      {.path = "Satellite/Jitter/File",
       .kind = Kind::kFile,
       .meaning =
           "Attitude against time (file model): columns time_s, yaw, pitch, roll, angles in arcsec. Or its one-sided "
           "power spectral density (psd model): columns frequency_hz, yaw, pitch, roll, in arcsec^2/Hz.",
       .example = "jitter.csv",
       .assign = [](Mission& m, const Value& v) { m.satellite.jitter.file = v.text; }},
  };
}

}  // namespace astroid::configuration
