#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/photometry/psf_measurement.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

namespace {

constexpr std::string_view kGaussian = "gaussian:";
constexpr std::string_view kMeasured = "measured";

/// gaussian:SIGMA_PX or a FITS file; nothing without --psf.
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

void set_background(const std::string& text, ImagePhotometrySettings& settings) {
  if (text == "local") {
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

/// Positions of any catalogue; magnitudes are not needed.
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

/// sources.csv for one image; sources_NAME.csv for each of several.
std::filesystem::path output_for(const PhotometryOptions& options, const std::string& image) {
  if (options.images.size() == 1) return options.output;
  const std::filesystem::path output = options.output;
  return output.parent_path() / fmt::format("{}_{}{}", output.stem().string(),
                                            std::filesystem::path(image).stem().string(), output.extension().string());
}

}  // namespace

int photometry(const PhotometryOptions& options) {
  std::vector<std::string> inputs = options.images;
  const bool blind = options.catalogue.empty();
  if (!blind) inputs.push_back(options.catalogue);
  if (blind && options.method != "psf")
    throw InputError(Problem{.parameter = "--method",
                             .value = options.method,
                             .expected = "--catalogue FILE, or --method psf with --psf",
                             .message = "without positions stars are found by their PSF"});
  const bool measured_psf = options.psf == kMeasured;
  if (!options.psf.empty() && !measured_psf && !options.psf.starts_with(kGaussian)) inputs.push_back(options.psf);
  require_files(inputs);
  ImagePhotometrySettings settings;
  settings.psf = read_psf(options.psf);
  if (options.method == "mask") settings.method = PhotometryMethod::kMask;
  if (options.method == "weighted") settings.method = PhotometryMethod::kWeighted;
  if (options.method == "psf") settings.method = PhotometryMethod::kPsf;
  if (settings.method != PhotometryMethod::kAperture && settings.psf == nullptr && !measured_psf)
    throw InputError(Problem{.parameter = "--method",
                             .value = options.method,
                             .expected = "--psf measured, --psf FILE or --psf gaussian:SIGMA_PX with it",
                             .message = "all but apertures need the PSF"});
  if (options.radius) settings.aperture_radius = Pixels(*options.radius);
  if (options.zero_point) settings.zero_point = Magnitude(*options.zero_point);
  set_background(options.background, settings);
  FrameReadOptions read;
  if (options.gain) read.gain = Gain(*options.gain);
  if (options.read_noise) read.readout_noise = Electrons(*options.read_noise);
  if (options.saturation) read.saturation = Adu(*options.saturation);
  read.use_overscan = !options.ignore_overscan;
  if (options.exposure_time) read.exposure_time = Seconds(*options.exposure_time);

  std::vector<SourceRequest> requests;
  if (!blind) requests = read_requests(options.catalogue);
  FieldPhotometrySettings field;
  field.zero_point = settings.zero_point;
  for (const std::string& image : options.images) {
    const std::filesystem::path output = output_for(options, image);
    if (std::filesystem::exists(output) && !options.overwrite)
      throw InputError(Problem{
          .file = output.string(), .expected = "another -o FILE, or --overwrite", .message = "the file exists"});
    const ImageFile file = read_frame(image, read);
    for (const std::string& note : file.notes) fmt::print(stderr, "{}: {}\n", image, note);
    const SkyProjection* sky = file.sky ? &*file.sky : nullptr;
    if (measured_psf) {
      const MeasuredPsf measured = measure_psf(file.frame);
      settings.psf = make_effective_psf(measured.psf);
      fmt::print(stderr, "{}: PSF measured from {} stars, chi2 {:.3f}: {}\n", image, measured.stars, measured.chi2,
                 settings.psf->description());
    }
    const std::vector<SourceMeasurement> sources = blind ? measure_field(file.frame, sky, *settings.psf, field)
                                                         : measure_image(file.frame, sky, requests, settings);
    write_sources(output, sources);
    std::size_t measured = 0;
    std::size_t flagged = 0;
    for (const SourceMeasurement& source : sources) {
      measured += source.flux == source.flux ? 1 : 0;
      flagged += source.flags != 0 ? 1 : 0;
    }
    fmt::print("{}: {} of {} sources measured, {} flagged: {}\n", image, measured, sources.size(), flagged,
               output.string());
  }
  return 0;
}

}  // namespace astroid::commands
