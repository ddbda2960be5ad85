#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/found_stars.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/photometry/residual_image.hpp"
#include "astroid/photometry/scene_choice.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/photometry_record.hpp"

namespace astroid::commands {

namespace {

constexpr std::string_view kGaussian = "gaussian:";

/// gaussian:SIGMA_PX or a FITS file; nothing without --psf.
std::shared_ptr<const PixelPsf> read_psf(const std::string& text) {
  if (text.empty()) return nullptr;
  if (text.starts_with(kGaussian)) {
    const std::optional<double> sigma = parse_number(text.substr(kGaussian.size()));
    if (!sigma)
      throw InputError(Problem{.parameter = "--psf",
                               .value = text,
                               .expected = "gaussian:SIGMA_PX, such as gaussian:0.8",
                               .message = "the width is not a number"});
    return make_gaussian_psf(*sigma);
  }
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

/// FILE for one image; FILE_IMAGE for each of several.
std::filesystem::path output_for(const PhotometryOptions& options, const std::string& file, const std::string& image) {
  if (options.images.size() == 1) return file;
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

void check_options(const PhotometryOptions& options, bool blind) {
  std::vector<Problem> problems;
  const auto complain = [&problems](const char* parameter, std::string value, const char* expected,
                                    const char* message) {
    problems.push_back(
        Problem{.parameter = parameter, .value = std::move(value), .expected = expected, .message = message});
  };
  const bool psf = !options.psf.empty();
  if (blind && (options.method == "mask" || options.method == "weighted"))
    complain("--method", options.method, "--catalogue FILE, or --method auto, aperture or psf",
             "masks are for positions that are given");
  if (options.method != "auto" && options.method != "aperture" && !psf)
    complain("--method", options.method, "--psf FILE or --psf gaussian:SIGMA_PX with it",
             "all but apertures need the PSF");
  const bool local = options.background == "local" || (options.background.empty() && !blind);
  if (!local && (!options.annulus.empty() || options.clip))
    complain("--annulus, --clip", "", "--background local with it",
             "there is no annulus around stars that are found on a mesh");
  if (options.threshold && !(*options.threshold > 0.0))
    complain("--threshold", fmt::format("{}", *options.threshold), "more than 0", "everything would be a star");
  if (options.threshold && !blind)
    complain("--threshold", fmt::format("{}", *options.threshold), "no --catalogue with it",
             "positions are given, and nothing is looked for");
  if (!problems.empty()) throw InputError(std::move(problems));
}

class PhotometryRun {
 public:
  explicit PhotometryRun(const PhotometryOptions& options) : options_(options), blind_(options.catalogue.empty()) {
    std::vector<std::string> inputs = options.images;
    if (!blind_) inputs.push_back(options.catalogue);
    if (!options.psf.empty() && !options.psf.starts_with(kGaussian)) inputs.push_back(options.psf);
    check_options(options, blind_);
    require_files(inputs);
    settings_.psf = read_psf(options.psf);
    if (options.radius) settings_.aperture_radius = Pixels(*options.radius);
    if (options.zero_point) settings_.zero_point = Magnitude(*options.zero_point);
    set_background(options.background, blind_, settings_);
    if (!options.annulus.empty()) {
      settings_.annulus_inner = Pixels(options.annulus.front());
      settings_.annulus_outer = Pixels(options.annulus.back());
    }
    if (options.clip)
      settings_.annulus_clip = *options.clip == 0.0 ? std::numeric_limits<double>::infinity() : *options.clip;
    if (options.gain) read_.gain = Gain(*options.gain);
    if (options.read_noise) read_.readout_noise = Electrons(*options.read_noise);
    if (options.bias) read_.bias = Adu(*options.bias);
    if (options.saturation) read_.saturation = Adu(*options.saturation);
    read_.use_overscan = !options.ignore_overscan;
    if (options.exposure_time) read_.exposure_time = Seconds(*options.exposure_time);
    if (!blind_) requests_ = read_requests(options.catalogue);
  }

  void measure(const std::string& image) {
    const std::filesystem::path output = output_for(options_, options_.output, image);
    const std::filesystem::path residual =
        options_.residual.empty() ? std::filesystem::path() : output_for(options_, options_.residual, image);
    for (const std::filesystem::path& file : {output, residual})
      if (!file.empty() && std::filesystem::exists(file) && !options_.overwrite)
        throw InputError(
            Problem{.file = file.string(), .expected = "another FILE, or --overwrite", .message = "the file exists"});
    PhotometryRecord record;
    record.image = image;
    const auto start = std::chrono::steady_clock::now();
    ImageFile file = read_frame(image, read_);
    const auto was_read = std::chrono::steady_clock::now();
    record.seconds_reading = std::chrono::duration<double>(was_read - start).count();
    const SkyProjection* sky = file.sky ? &*file.sky : nullptr;
    const auto map = std::make_shared<const BackgroundMap>(file.frame, 0, settings_.mesh);
    if (file.gain_assumed) measure_missing_gain(*map, file);
    record.notes = std::move(file.notes);
    const std::vector<SourceMeasurement> sources = measure_sources(file.frame, sky, map, record);
    record.seconds_measuring = std::chrono::duration<double>(std::chrono::steady_clock::now() - was_read).count();
    record.gain = file.frame.header.gain.value();
    record.readout_noise = file.frame.header.readout_noise.value();
    record.bias = file.frame.header.bias.value();
    record.background = map->median_level();
    record.background_rms = map->median_rms();
    for (const SourceMeasurement& source : sources) {
      record.measured += std::isfinite(source.flux) ? 1 : 0;
      record.flagged += source.flags != 0 ? 1 : 0;
    }
    record.sources = sources.size();
    for (const std::string& note : record.notes) fmt::print(stderr, "{}: {}\n", image, note);
    write_table(output, sources, record);
    if (!residual.empty()) {
      const std::shared_ptr<const PixelPsf> psf = settings_.psf ? settings_.psf : gaussian_of(record.fwhm);
      write_residual(residual, residual_image(file.frame, *map, sources, *psf), record);
    }
    if (options_.method == "auto") fmt::print("{}: method {}: {}\n", image, record.method, record.why);
    fmt::print("{}: {} of {} sources measured, {} flagged: {}\n", image, record.measured, record.sources,
               record.flagged, output.string());
  }

 private:
  static std::shared_ptr<const PixelPsf> gaussian_of(double fwhm) {
    constexpr double kDefault = 2.0;  // px
    return make_gaussian_psf((std::isfinite(fwhm) && fwhm > 0.0 ? fwhm : kDefault) / kFwhmPerSigma);
  }

  // From the noise of the sky, where the header does not say it and the sky is uneven enough to tell.
  static void measure_missing_gain(const BackgroundMap& map, ImageFile& file) {
    const std::optional<MeasuredGain> measured = measure_gain(map);
    if (!measured) return;
    file.frame.header.gain = Gain(measured->gain);
    file.notes.back() = fmt::format(
        "The header gives no gain: {:.3g} ± {:.1g} e-/ADU measured from the noise of the sky against its level.",
        measured->gain, measured->error);
  }

  std::vector<SourceMeasurement> measure_sources(const Frame& frame, const SkyProjection* sky,
                                                 const std::shared_ptr<const BackgroundMap>& map,
                                                 PhotometryRecord& record) {
    ImagePhotometrySettings settings = settings_;
    settings.map = map;
    record.why = "it was asked for";
    record.method = options_.method;
    std::optional<FoundStars> found;
    if (blind_ && options_.method != "psf") {
      FoundStarsSettings find;
      find.detection.psf = settings.psf.get();
      if (options_.threshold) find.detection.threshold = *options_.threshold;
      find.measure = settings;
      if (options_.radius) find.radius = Pixels(*options_.radius);
      if (options_.correct_to) find.correct_to = Pixels(*options_.correct_to);
      if (options_.method == "auto" && settings.psf) {
        // Only how crowded it is matters.
        find.correct = false;
        find.radius = settings.aperture_radius;
      }
      found = measure_found_stars(frame, sky, find);
    }
    record.fwhm = found && found->detection.fwhm_measured ? found->detection.fwhm : measure_fwhm(frame, *map);
    if (options_.method == "auto") {
      const MethodChoice choice = choose_method(summary(frame, sky, found, record.fwhm));
      settings.method = choice.method;
      record.why = choice.why;
      record.method = name_of(choice.method);
    } else {
      settings.method = method_of(options_.method);
    }
    if (!blind_) {
      if (options_.correct_to)
        record.notes.emplace_back("--correct-to was ignored: it is for stars that are found without a catalogue.");
      return measure_image(frame, sky, requests_, settings);
    }
    if (settings.method == PhotometryMethod::kPsf) return fit_field(frame, sky, settings, record);
    record.fwhm = found->detection.fwhm;
    record.radius = found->radius;
    record.notes.push_back(text_of(*found));
    return std::move(found->sources);
  }

  static std::string text_of(const FoundStars& found) {
    const std::string circles = fmt::format("circles of {:.2f} px around stars of FWHM {:.2f} px{}", found.radius,
                                            found.detection.fwhm, found.detection.fwhm_measured ? ", measured" : "");
    if (found.reference > 0.0)
      return fmt::format("{}; fluxes are corrected to {:.1f} px by a factor of {:.4f} ± {:.4f} from {} stars.", circles,
                         found.reference, found.correction, found.correction_error, found.correction_stars);
    return circles + "; fluxes are those in the circles.";
  }

  ImageScene summary(const Frame& frame, const SkyProjection* sky, const std::optional<FoundStars>& found,
                     double fwhm) const {
    ImageScene scene;
    scene.psf_given = settings_.psf != nullptr;
    scene.catalogue = !blind_;
    scene.fwhm = fwhm;
    if (found) {
      scene.stars = found->sources.size();
      scene.neighbours = found->neighbours;
      return scene;
    }
    std::vector<PixelPosition> places;
    const Rectangle area = frame.pixels.layout().regions()[0];
    for (const SourceRequest& request : requests_) {
      std::optional<PixelPosition> place = request.pixel;
      if (!place && request.sky && sky != nullptr) place = sky->to_pixel(*request.sky);
      if (place && place->x > area.x0 && place->x < area.x1() && place->y > area.y0 && place->y < area.y1())
        places.push_back(*place);
    }
    scene.stars = places.size();
    constexpr double kDefault = 2.0;  // px
    scene.neighbours = share_with_neighbours(places, kCrowdedDistance * (std::isfinite(fwhm) ? fwhm : kDefault));
    return scene;
  }

  std::vector<SourceMeasurement> fit_field(const Frame& frame, const SkyProjection* sky,
                                           const ImagePhotometrySettings& settings, PhotometryRecord& record) const {
    FieldPhotometrySettings field;
    field.zero_point = settings.zero_point;
    if (options_.threshold) field.threshold = *options_.threshold;
    const auto ignored = [&record](const char* option, const char* instead) {
      record.notes.push_back(
          fmt::format("{} was ignored: stars without a catalogue are fitted together with {}.", option, instead));
    };
    if (!options_.background.empty()) ignored("--background", "the sky");
    if (options_.radius) ignored("--radius", "their PSF, in no circles");
    if (options_.correct_to) ignored("--correct-to", "the whole of their PSF");
    return measure_field(frame, sky, *settings.psf, field);
  }

  const PhotometryOptions& options_;
  bool blind_;
  ImagePhotometrySettings settings_;
  FrameReadOptions read_;
  std::vector<SourceRequest> requests_;
};

}  // namespace

int photometry(const PhotometryOptions& options) {
  PhotometryRun run(options);
  for (const std::string& image : options.images) run.measure(image);
  return 0;
}

}  // namespace astroid::commands
