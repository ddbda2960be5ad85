#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/catalogue_writer.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/core/error.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

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

/// Fields of a request, as problems name them, and the options that set them.
constexpr std::array<std::array<const char*, 2>, 9> kOptions = {{{"region", "--radius, or --width and --height"},
                                                                 {"radius", "--radius"},
                                                                 {"width", "--width"},
                                                                 {"height", "--height"},
                                                                 {"slope", "--slope"},
                                                                 {"faint", "--faint"},
                                                                 {"complete_to", "--complete-to"},
                                                                 {"stars", "--number"},
                                                                 {"density", "--density"}}};

/// Problems of a request name its fields; here they are options.
StarCatalogue made(const FieldOptions& options) {
  try {
    return options.extend.empty() ? synthetic(options) : extended(options);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems)
      for (const auto& [field, option] : kOptions)
        if (problem.parameter == field) problem.parameter = option;
    throw InputError(std::move(problems));
  }
}

}  // namespace

int field(const FieldOptions& options) {
  if (std::filesystem::exists(options.output) && !options.overwrite)
    throw InputError(
        Problem{.file = options.output, .expected = "another -o FILE, or --overwrite", .message = "the file exists"});
  if (!options.extend.empty()) require_files({options.extend});
  const bool has_region = options.radius != 0.0 || (options.width != 0.0 && options.height != 0.0);
  if (options.extend.empty() && !has_region)
    throw InputError(Problem{.parameter = "--radius",
                             .expected = "--radius DEG, or --width DEG and --height DEG",
                             .message = "the size of the region is not clear"});
  if (options.extend.empty() && options.number.has_value() == options.density.has_value())
    throw InputError(Problem{.parameter = "--number",
                             .expected = "either --number N or --density N/DEG2",
                             .message = "how many stars is not clear"});
  const StarCatalogue catalogue = made(options);
  write_catalogue_csv(options.output, catalogue);
  for (const std::string& note : catalogue.notes) fmt::print("{}\n", note);
  fmt::print("{} stars: {}\n", catalogue.stars.size(), options.output);
  return 0;
}

}  // namespace astroid::commands
