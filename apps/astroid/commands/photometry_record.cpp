#include "commands/photometry_record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/fits_writer.hpp"

namespace astroid::commands {

namespace {

std::vector<FitsCard> cards_of(const PhotometryRecord& record) {
  return {{"IMAGE", std::filesystem::path(record.image).filename().string(), "that was measured"},
          {"METHOD", record.method, "of photometry"},
          {"GAIN", record.gain, "e-/ADU"},
          {"RDNOISE", record.readout_noise, "e-, 0: that of the sky stands for it"},
          {"BIAS", record.bias, "ADU"},
          {"SKYLEVEL", record.background, "ADU, median of the mesh"},
          {"SKYRMS", record.background_rms, "ADU, of a pixel"},
          {"FWHM", record.fwhm, "px, of stars in the image"},
          {"APRADIUS", record.radius, "px, of circles around found stars"}};
}

bool is_fits(const std::filesystem::path& file) {
  return file.extension() == ".fits" || file.extension() == ".fit";
}

}  // namespace

void write_table(const std::filesystem::path& output, std::span<const SourceMeasurement> sources,
                 const PhotometryRecord& record) {
  if (is_fits(output)) {
    std::vector<std::string> history{fmt::format("Method {}: {}", record.method, record.why)};
    history.insert(history.end(), record.notes.begin(), record.notes.end());
    write_sources_fits(output, sources, cards_of(record), history);
    return;
  }
  write_sources(output, sources);
  nlohmann::ordered_json json;
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  json["image"] = record.image;
  json["method"] = record.method;
  json["why"] = record.why;
  json["gain"] = number(record.gain);
  json["readout_noise"] = number(record.readout_noise);
  json["bias"] = number(record.bias);
  json["background"] = number(record.background);
  json["background_rms"] = number(record.background_rms);
  json["fwhm"] = number(record.fwhm);
  json["radius"] = number(record.radius);
  json["sources"] = record.sources;
  json["measured"] = record.measured;
  json["flagged"] = record.flagged;
  json["seconds"] = {{"reading", record.seconds_reading}, {"measuring", record.seconds_measuring}};
  json["notes"] = record.notes;
  AtomicFile text(output.string() + ".json");
  text.write(json.dump(2) + "\n");
  text.commit();
}

void write_residual(const std::filesystem::path& file, const Image<float, unit::Adu>& residual,
                    const PhotometryRecord& record) {
  FitsWriter fits(file);
  (void)fits.begin_image(FitsNumber::kFloat32, {residual.nx(), residual.ny()});
  fits.cards(cards_of(record));
  fits.card({"BUNIT", "ADU", "image less background less stars"});
  fits.history(fmt::format("Method {}: {}", record.method, record.why));
  fits.write_plane(residual);
  fits.commit();
}

}  // namespace astroid::commands
