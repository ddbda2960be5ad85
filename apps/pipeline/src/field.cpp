#include "astroid/pipeline/field.hpp"

#include <fmt/format.h>

#include <cmath>
#include <unordered_set>
#include <utility>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/passbands.hpp"
#include "astroid/core/csv.hpp"

namespace astroid {

namespace {

StarCatalogue read_and_convert(const Mission& mission, const std::string& file) {
  const StellarFieldSettings& field = mission.field;
  StarCatalogue catalogue =
      read_catalogue(file, {.passband = field.catalogue_passband,
                            .unit = field.catalogue_unit == "rad" ? AngleUnit::kRadians : AngleUnit::kDegrees});
  convert_passband(catalogue, mission.telescope.zero_point_passband,
                   {.bv = field.assumed_bv, .teff = field.assumed_teff});
  return catalogue;
}

/// Flux of a star in an exposure, relative to its catalogued one.
double relative_flux(const Scene& scene, const SceneStar& star, std::int64_t exposure) {
  if (star.variability < 0) return 1.0;
  const double middle = scene.mission_time(exposure).value();
  const double half = 0.5 * scene.mission().simulation.exposure_time.value();
  return scene.variables()[static_cast<std::size_t>(star.variability)].variability.mean(middle - half, middle + half);
}

double mean_relative_flux(const Scene& scene, const SceneStar& star) {
  if (star.variability < 0) return 1.0;
  const std::int64_t exposures = scene.mission().simulation.exposures;
  double sum = 0.0;
  for (std::int64_t exposure = 0; exposure < exposures; ++exposure) sum += relative_flux(scene, star, exposure);
  return sum / static_cast<double>(exposures);
}

}  // namespace

StarCatalogue load_field(const Mission& mission) {
  StarCatalogue catalogue = read_and_convert(mission, mission.field.catalogue);
  if (mission.field.background_catalogue.empty()) return catalogue;
  StarCatalogue background = read_and_convert(mission, mission.field.background_catalogue);
  if (background.positions != catalogue.positions || background.brightness != catalogue.brightness)
    throw InputError(Problem{.file = background.source,
                             .parameter = "StellarField/BackgroundCatalogue",
                             .expected = "the same kind of positions and brightness as in the catalogue",
                             .message = "the two catalogues cannot be joined"});
  std::unordered_set<std::string> known;
  for (const CatalogueStar& star : catalogue.stars) known.insert(star.id);
  catalogue.notes.push_back(
      fmt::format("{} stars of the background catalogue {} were added", background.stars.size(), background.source));
  for (CatalogueStar& star : background.stars) {
    // The same id in both files names two stars; the second keeps it with a mark.
    while (!known.insert(star.id).second) star.id += "b";
    catalogue.stars.push_back(std::move(star));
  }
  catalogue.notes.insert(catalogue.notes.end(), background.notes.begin(), background.notes.end());
  return catalogue;
}

std::vector<TruthStar> truth_of(const Scene& scene) {
  std::vector<TruthStar> truth;
  truth.reserve(scene.stars().size());
  for (const SceneStar& star : scene.stars()) {
    const double flux = mean_relative_flux(scene, star);
    constexpr double kPogsonScale = 2.5;
    const double brighter = star.variability < 0 ? 0.0 : kPogsonScale * std::log10(flux);
    truth.push_back({.id = star.id,
                     .ra = star.sky.ra,
                     .dec = star.sky.dec,
                     .magnitude = star.magnitude.value() - brighter,
                     .x = star.position.x,
                     .y = star.position.y,
                     .electrons = star.electrons * flux});
  }
  return truth;
}

void write_truth(const std::filesystem::path& path, const Scene& scene) {
  CsvWriter csv(path, {"id", "ra", "dec", "mag", "x", "y", "electrons", "target"});
  for (const SceneStar& star : scene.stars())
    csv.row(star.id, star.sky.ra, star.sky.dec, star.magnitude.value(), star.position.x, star.position.y,
            star.electrons, star.is_target ? 1 : 0);
  csv.commit();
}

void write_variable_truth(const std::filesystem::path& folder, const Scene& scene, const std::string& suffix) {
  std::vector<const SceneStar*> stars;
  for (const SceneStar& star : scene.stars())
    if (star.variability >= 0) stars.push_back(&star);
  if (stars.empty()) return;
  std::vector<std::string> columns{"time"};
  for (const SceneStar* star : stars) columns.push_back(star->id);
  CsvWriter curves(folder / ("variability" + suffix + ".csv"), columns);
  for (std::int64_t exposure = 0; exposure < scene.mission().simulation.exposures; ++exposure) {
    curves.cell(scene.mid_time(exposure).value());
    for (const SceneStar* star : stars) curves.cell(relative_flux(scene, *star, exposure));
    curves.end_row();
  }
  curves.commit();
  CsvWriter table(folder / ("variables" + suffix + ".csv"), {"id", "x", "y", "electrons", "mean_flux", "model"});
  for (const SceneStar* star : stars)
    table.row(star->id, star->position.x, star->position.y, star->electrons, mean_relative_flux(scene, *star),
              scene.variables()[static_cast<std::size_t>(star->variability)].variability.description());
  table.commit();
}

std::vector<FieldStar> field_stars(const Scene& scene) {
  std::vector<FieldStar> stars;
  stars.reserve(scene.stars().size());
  for (const SceneStar& star : scene.stars())
    stars.push_back({.id = star.id, .position = star.position, .electrons = star.electrons});
  return stars;
}

}  // namespace astroid
