#include <fmt/format.h>

#include <filesystem>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/catalogue_writer.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/core/error.hpp"
#include "commands/commands.hpp"

namespace astroid::commands {

namespace {

SkyRegion region_of(const FieldOptions& options) {
  return {.centre = {options.ra, options.dec},
          .radius = Degrees(options.radius),
          .width = Degrees(options.width),
          .height = Degrees(options.height)};
}

StarCatalogue extended(const FieldOptions& options) {
  StarCatalogue catalogue = read_catalogue(options.extend, {.passband = options.passband});
  ExtensionRequest request{.region = region_of(options),
                           .complete_to = {},
                           .slope = options.slope,
                           .faint = Magnitude(options.faint),
                           .seed = options.seed};
  if (options.complete_to) request.complete_to = Magnitude(*options.complete_to);
  const ExtensionLaw law = extend_catalogue(catalogue, request);
  fmt::print("{} stars brighter than {:.2f}; counts grow as 10^({:.3f} m); {} stars added down to {:.2f}\n", law.stars,
             law.complete_to.value(), law.slope, law.added, options.faint);
  if (options.only_new)
    std::erase_if(catalogue.stars, [](const CatalogueStar& star) { return !star.id.starts_with("ext"); });
  return catalogue;
}

StarCatalogue synthetic(const FieldOptions& options) {
  FieldRequest request;
  request.region = region_of(options);
  request.passband = options.passband;
  request.bright = Magnitude(options.bright);
  request.faint = Magnitude(options.faint);
  if (options.slope) request.slope = *options.slope;
  request.stars = options.number;
  request.density = options.density;
  request.density_limit = Magnitude(options.density_limit.value_or(options.faint));
  request.seed = options.seed;
  return make_synthetic_field(request);
}

}  // namespace

int field(const FieldOptions& options) {
  if (std::filesystem::exists(options.output) && !options.overwrite)
    throw InputError(
        Problem{.file = options.output, .expected = "another -o FILE, or --overwrite", .message = "the file exists"});
  const StarCatalogue catalogue = options.extend.empty() ? synthetic(options) : extended(options);
  write_catalogue_csv(options.output, catalogue);
  for (const std::string& note : catalogue.notes) fmt::print("{}\n", note);
  fmt::print("{} stars: {}\n", catalogue.stars.size(), options.output);
  return 0;
}

}  // namespace astroid::commands
