#include "commands/photometry_options.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"

namespace astroid::commands {

namespace {

constexpr std::string_view kGaussian = "gaussian:";
constexpr std::string_view kMeasured = "measured";

}  // namespace

bool is_measured(const std::string& psf) {
  return psf == kMeasured;
}

bool names_a_file(const std::string& psf) {
  return !psf.empty() && psf != kMeasured && !psf.starts_with(kGaussian);
}

std::shared_ptr<const PixelPsf> read_psf(const std::string& text) {
  if (text.empty() || text == kMeasured) return nullptr;
  if (text.starts_with(kGaussian)) {
    const std::optional<double> sigma = parse_number(text.substr(kGaussian.size()));
    if (!sigma)
      throw InputError(Problem{.parameter = "--psf",
                               .value = text,
                               .expected = "gaussian:SIGMA_PX, such as gaussian:0.8",
                               .message = "the width is not a number"});
    return make_gaussian_psf(*sigma);
  }
  if (is_effective_psf(text)) return make_effective_psf(read_effective_psf(text));
  constexpr double kPpm = 1e-6;
  return make_prf_psf(read_psf_table(text), kPpm);
}

void set_background(const std::string& text, bool blind, ImagePhotometrySettings& settings) {
  if (text.empty()) {
    settings.background = blind ? BackgroundMethod::kMesh : BackgroundMethod::kLocal;
  } else if (text == "local") {
    settings.background = BackgroundMethod::kLocal;
  } else if (text == "mesh") {
    settings.background = BackgroundMethod::kMesh;
  } else if (const std::optional<double> level = parse_number(text)) {
    settings.background = BackgroundMethod::kKnown;
    settings.known_background = Adu(*level);
  } else {
    throw InputError(Problem{.parameter = "--background",
                             .value = text,
                             .expected = "local, mesh, or a number",
                             .message = "is none of them"});
  }
}

std::vector<SourceRequest> read_requests(const std::string& file) {
  const StarCatalogue catalogue = read_catalogue(file, {.positions_only = true, .check_unit = false});
  std::vector<SourceRequest> requests;
  for (const CatalogueStar& star : catalogue.stars) {
    SourceRequest request{.id = star.id, .pixel = {}, .sky = {}};
    if (catalogue.positions == PositionKind::kPixel) {
      request.pixel = star.pixel;
    } else {
      request.sky = star.sky;
    }
    requests.push_back(std::move(request));
  }
  return requests;
}

std::filesystem::path output_for(std::size_t images, const std::string& file, const std::string& image) {
  if (images == 1) return file;
  const std::filesystem::path output = file;
  return output.parent_path() / fmt::format("{}_{}{}", output.stem().string(),
                                            std::filesystem::path(image).stem().string(), output.extension().string());
}

PhotometryMethod method_of(const std::string& name) {
  if (name == "mask") return PhotometryMethod::kMask;
  if (name == "weighted") return PhotometryMethod::kWeighted;
  return name == "psf" ? PhotometryMethod::kPsf : PhotometryMethod::kAperture;
}

std::string name_of(PhotometryMethod method) {
  switch (method) {
    case PhotometryMethod::kMask:
      return "mask";
    case PhotometryMethod::kWeighted:
      return "weighted";
    case PhotometryMethod::kPsf:
      return "psf";
    default:
      return "aperture";
  }
}

void check_options(const PhotometryOptions& options) {
  const bool blind = options.catalogue.empty();
  std::vector<Problem> problems;
  const auto complain = [&problems](const char* parameter, std::string value, const char* expected,
                                    const char* message) {
    problems.push_back(
        Problem{.parameter = parameter, .value = std::move(value), .expected = expected, .message = message});
  };
  const bool psf = !options.psf.empty();
  if (blind && (options.method == "mask" || options.method == "weighted" || options.method == "fit"))
    complain("--method", options.method, "--catalogue FILE, or --method auto, aperture or psf",
             "it is for positions that are given");
  if (options.method != "auto" && options.method != "aperture" && !psf)
    complain("--method", options.method, "--psf measured, --psf FILE or --psf gaussian:SIGMA_PX with it",
             "all but apertures need the PSF");
  const bool local = options.background == "local" || (options.background.empty() && !blind);
  if (!local && (!options.annulus.empty() || options.clip))
    complain("--annulus, --clip", "", "--background local with it",
             "there is no annulus around stars that are found on a mesh");
  if (!options.psf_output.empty() && psf && options.psf != kMeasured)
    complain("--psf-output", options.psf_output, "--psf measured with it", "the PSF is given, and none is measured");
  if (options.artificial_stars && !blind)
    complain("--artificial-stars", fmt::format("{}", *options.artificial_stars), "no --catalogue with it",
             "positions are given, and nothing is looked for");
  if (options.threshold && !(*options.threshold > 0.0))
    complain("--threshold", fmt::format("{}", *options.threshold), "more than 0", "everything would be a star");
  if (options.threshold && !blind)
    complain("--threshold", fmt::format("{}", *options.threshold), "no --catalogue with it",
             "positions are given, and nothing is looked for");
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace astroid::commands
