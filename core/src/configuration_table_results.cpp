#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> analysis_parameters() {
  constexpr double kPpm = 1e6;  // parts per million in one
  return {
      {.path = "Analysis/Bin",
       .unit = "s",
       .range = above_up_to(0, 1e8),
       .fallback = "3600",
       .meaning = "Duration to which fluxes are averaged when noise is reported, at least the cycle.",
       .example = "3600",
       .assign = [](Mission& m, const Value& v) { m.analysis.bin = Seconds(v.real); }},
      {.path = "Analysis/UncontaminatedSPR",
       .unit = "ppm",
       .range = from_to(0, kPpm),
       .fallback = "1000",
       .meaning = "Stars with less flux of others in their mask than this (total stellar pollution ratio) judge the "
                  "recovery of magnitudes.",
       .example = "1000",
       .assign = [](Mission& m, const Value& v) { m.analysis.uncontaminated_spr = v.real / kPpm; }},
  };
}

std::vector<Parameter> output_parameters() {
  return {
      {.path = "Output/Images",
       .kind = Kind::kChoice,
       .fallback = "first",
       .choices = {"none", "first", "every N", "all"},
       .meaning = "Which exposures are written as FITS images.",
       .example = "every 144",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr ImageOutput kOutputs[] = {ImageOutput::kNone, ImageOutput::kFirst, ImageOutput::kEvery,
                                                 ImageOutput::kAll};
             m.output.images = kOutputs[v.choice];
             m.output.images_every = m.output.images == ImageOutput::kEvery ? static_cast<int>(v.integer) : 1;
           }},
      {.path = "Output/Lightcurves",
       .kind = Kind::kChoice,
       .fallback = "targets",
       .choices = {"none", "targets", "all"},
       .meaning = "Of which stars the light curves are written.",
       .example = "targets",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr LightCurveOutput kOutputs[] = {LightCurveOutput::kNone, LightCurveOutput::kTargets,
                                                      LightCurveOutput::kAll};
             m.output.light_curves = kOutputs[v.choice];
           }},
      {.path = "Output/DumpSteps",
       .kind = Kind::kIntegerList,
       .range = from_to(0, 1e9),
       .meaning = "Exposures, counted from 0 and separated by blanks, whose map after each step is written.",
       .example = "0 1",
       .assign = [](Mission& m, const Value& v) { m.output.dump_steps = v.integers; }},
  };
}

}  // namespace astroid::configuration
