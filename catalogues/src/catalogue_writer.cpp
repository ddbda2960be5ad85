#include "astroid/catalogues/catalogue_writer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/csv.hpp"

namespace astroid {

namespace {

/// A comment of one line, whatever the text holds.
void write_comment(AtomicFile& file, std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
  file.write("# " + text + "\n");
}

std::string quoted(const std::string& id) {
  const bool plain = id.find_first_of(",\"# \t\n\r;") == std::string::npos && !id.empty();
  if (plain) return id;
  std::string out = "\"";
  for (const char c : id) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return out + "\"";
}

std::string_view column_of(const std::string& colour_index) {
  if (colour_index == "B-V") return "bv";
  if (colour_index == "B_T-V_T") return "bt_vt";
  return "bp_rp";
}

}  // namespace

void write_catalogue_csv(const std::filesystem::path& path, const StarCatalogue& catalogue) {
  const auto& stars = catalogue.stars;
  const bool sky = catalogue.positions == PositionKind::kSky;
  const bool magnitudes = catalogue.brightness == BrightnessKind::kMagnitude;
  const bool colours = !catalogue.colour_index.empty() &&
                       std::any_of(stars.begin(), stars.end(), [](const auto& s) { return std::isfinite(s.colour); });
  const bool temperatures =
      std::any_of(stars.begin(), stars.end(), [](const auto& s) { return std::isfinite(s.teff); });

  AtomicFile file(path);
  if (!catalogue.source.empty()) write_comment(file, "source: " + catalogue.source);
  if (magnitudes && !catalogue.passband.empty()) write_comment(file, "passband: " + catalogue.passband);
  for (const std::string& note : catalogue.notes) write_comment(file, note);
  std::string line = sky ? "id,ra,dec," : "id,x,y,";
  line += magnitudes ? "mag" : "electrons";
  if (colours) line += "," + std::string(column_of(catalogue.colour_index));
  if (temperatures) line += ",teff";
  file.write(line + "\n");
  for (const CatalogueStar& star : stars) {
    line = quoted(star.id);
    line += "," + shortest_text(sky ? star.sky.ra : star.pixel.x);
    line += "," + shortest_text(sky ? star.sky.dec : star.pixel.y);
    line += "," + shortest_text(magnitudes ? star.magnitude.value() : star.electrons);
    if (colours) line += "," + shortest_text(star.colour);
    if (temperatures) line += "," + shortest_text(star.teff);
    file.write(line + "\n");
  }
  file.commit();
}

}  // namespace astroid
