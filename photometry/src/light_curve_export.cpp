#include <cmath>

#include "astroid/core/fits.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "light_curve_cards.hpp"

namespace astroid {

void export_light_curve(const std::string& path, const LightCurve& curve, const LightCurveHeader& header) {
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned8, {});
  writer.cards(detail::time_cards());
  writer.card({"OBJECT", curve.star.id, "star"});
  writer.card({"SIMULAT", true, "no flight data"});
  for (const std::string& line : header.history) writer.history(line);

  const auto count = static_cast<std::int64_t>(curve.flux.size());
  writer.begin_table({{"TIME", FitsNumber::kFloat64, "d"},
                      {"FLUX", FitsNumber::kFloat64, "electron"},
                      {"FLUX_ERR", FitsNumber::kFloat64, "electron"},
                      {"QUALITY", FitsNumber::kInt32},
                      {"CADENCENO", FitsNumber::kInt64}},
                     "LIGHTCURVE", count);
  writer.cards(detail::time_cards());
  writer.card({"OBJECT", curve.star.id, "star"});
  writer.card({"MAG", curve.star.magnitude, "[mag] of the catalogue"});
  writer.card({"EXPTIME", header.exposure_time, "[s] exposure time"});
  writer.card({"CYCLE", header.cycle, "[s] from exposure to exposure"});
  const double later = header.line_time * curve.star.y / kSecondsPerDay;  // of its row
  std::vector<double> time;
  std::vector<double> error;
  std::vector<std::int32_t> quality;
  std::vector<std::int64_t> cadence;
  for (std::int64_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    time.push_back(mid_exposure_bjd(header, k) + later);
    error.push_back(std::isfinite(curve.flux[i]) ? curve.star.nsr_exposure * curve.star.reference : curve.flux[i]);
    quality.push_back(static_cast<std::int32_t>(curve.flags[i]));
    cadence.push_back(k);
  }
  if (count > 0) {
    writer.write_column(0, 0, time);
    writer.write_column(1, 0, curve.flux);
    writer.write_column(2, 0, error);
    writer.write_column(3, 0, quality);
    writer.write_column(4, 0, cadence);
  }
  writer.commit();
}

}  // namespace astroid
