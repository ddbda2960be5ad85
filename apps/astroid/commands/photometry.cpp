#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/artificial_stars.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/found_stars.hpp"
#include "astroid/photometry/group_photometry.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/photometry/phase_errors.hpp"
#include "astroid/photometry/psf_measurement.hpp"
#include "astroid/photometry/residual_image.hpp"
#include "astroid/photometry/scene_choice.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/photometry_options.hpp"
#include "commands/photometry_record.hpp"

namespace astroid::commands {

namespace {

class PhotometryRun {
 public:
  explicit PhotometryRun(const PhotometryOptions& options) : options_(options), blind_(options.catalogue.empty()) {
    std::vector<std::string> inputs = options.images;
    if (!blind_) inputs.push_back(options.catalogue);
    if (names_a_file(options.psf)) inputs.push_back(options.psf);
    check_options(options);
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
    const std::filesystem::path output = output_for(options_.images.size(), options_.output, image);
    const auto optional = [&](const std::string& name) {
      return name.empty() ? std::filesystem::path() : output_for(options_.images.size(), name, image);
    };
    const std::filesystem::path residual = optional(options_.residual);
    const std::filesystem::path psf_output = optional(options_.psf_output);
    const std::filesystem::path phases = optional(options_.phase_errors);
    const std::filesystem::path completeness =
        options_.artificial_stars ? output.parent_path() / (output.stem().string() + "_completeness.csv")
                                  : std::filesystem::path();
    for (const std::filesystem::path& file : {output, residual, psf_output, phases, completeness})
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
    ImagePhotometrySettings settings = settings_;
    settings.map = map;
    std::optional<MeasuredPsf> measured;
    if (is_measured(options_.psf)) measured = use_measured_psf(file.frame, settings, record);
    const std::vector<SourceMeasurement> sources = measure_sources(file.frame, sky, settings, measured, record);
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
    if (!completeness.empty()) test_completeness(file.frame, *map, settings, completeness, record);
    for (const std::string& note : record.notes) fmt::print(stderr, "{}: {}\n", image, note);
    write_table(output, sources, record);
    if (!residual.empty() || !phases.empty()) {
      const std::shared_ptr<const PixelPsf> psf = settings.psf ? settings.psf : gaussian_of(record.fwhm);
      const Image<float, unit::Adu> left = residual_image(file.frame, *map, sources, *psf);
      if (!residual.empty()) write_residual(residual, left, record);
      if (!phases.empty())
        write_phase_errors(phases, phase_errors(left, file.frame.header.gain, record.background_rms, sources, *psf));
    }
    if (!psf_output.empty() && measured) write_effective_psf(psf_output, measured->psf);
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
                                                 ImagePhotometrySettings& settings,
                                                 std::optional<MeasuredPsf>& measured, PhotometryRecord& record) {
    record.why = "it was asked for";
    record.method = options_.method;
    std::optional<FoundStars> found;
    if (blind_ && options_.method != "psf") {
      FoundStarsSettings find = find_settings(settings);
      if (options_.method == "auto" && settings.psf) {
        // Only how crowded it is matters.
        find.correct = false;
        find.radius = settings.aperture_radius;
      }
      found = measure_found_stars(frame, sky, find);
    }
    record.fwhm = found && found->detection.fwhm_measured ? found->detection.fwhm : measure_fwhm(frame, *settings.map);
    if (options_.method == "auto") {
      MethodChoice choice = choose_method(summary(frame, sky, found, settings.psf != nullptr, record.fwhm));
      if (choice.measure_psf) try_to_measure_psf(frame, settings, choice, measured, record);
      settings.method = choice.method;
      record.why = choice.why;
      record.method = name_of(choice.method);
    } else {
      settings.method = method_of(options_.method);
    }
    if (options_.method == "fit") return fit_groups(frame, sky, settings, record);
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

  static MeasuredPsf use_measured_psf(const Frame& frame, ImagePhotometrySettings& settings, PhotometryRecord& record) {
    MeasuredPsf measured = measure_psf(frame);
    settings.psf_error = measured.flux_error;
    settings.psf = make_effective_psf(measured.psf);
    record.notes.push_back(fmt::format("The PSF was measured from {} stars: {}; its error makes {:.2g} % of a flux.",
                                       measured.stars, settings.psf->description(), 100.0 * measured.flux_error));
    return measured;
  }

  // Circles, where an image does not show enough stars.
  static void try_to_measure_psf(const Frame& frame, ImagePhotometrySettings& settings, MethodChoice& choice,
                                 std::optional<MeasuredPsf>& measured, PhotometryRecord& record) {
    try {
      measured = use_measured_psf(frame, settings, record);
    } catch (const InputError& error) {
      choice.method = PhotometryMethod::kAperture;
      choice.why = fmt::format("{}; but it could not be ({}), so circles", choice.why,
                               error.problems().empty() ? "unknown" : error.problems().front().value);
    }
  }

  // With the method and the PSF that the image itself was measured with.
  void test_completeness(const Frame& frame, const BackgroundMap& map, const ImagePhotometrySettings& settings,
                         const std::filesystem::path& file, PhotometryRecord& record) const {
    const std::shared_ptr<const PixelPsf> psf = settings.psf ? settings.psf : gaussian_of(record.fwhm);
    // The error of a lone faint star: a Gaussian of that width has 4 pi sigma² noise pixels.
    constexpr double kDefault = 2.0;  // px
    const double fwhm = std::isfinite(record.fwhm) && record.fwhm > 0.0 ? record.fwhm : kDefault;
    const double sigma = fwhm / kFwhmPerSigma;
    const double noise =
        frame.header.gain.value() * map.median_rms() * std::sqrt(4.0 * kPi * (sigma * sigma + 1.0 / 12.0));
    constexpr double kFaintest = 2.0;  // errors
    constexpr double kBrightest = 300.0;
    ArtificialStarSettings stars;
    stars.stars = *options_.artificial_stars;
    stars.faintest = kFaintest * std::max(1.0, noise);
    stars.brightest = kBrightest * std::max(1.0, noise);
    stars.spacing = std::max(12.0, 6.0 * fwhm);
    stars.match = std::max(1.0, 0.5 * fwhm);
    const std::vector<CompletenessBin> bins = add_artificial_stars(frame, *psf, stars, [&](const Frame& added) {
      if (settings.method == PhotometryMethod::kPsf) {
        PhotometryRecord silent;
        return fit_field(added, nullptr, settings, silent);
      }
      ImagePhotometrySettings again = settings;
      again.map = std::make_shared<const BackgroundMap>(added, 0, settings.mesh);
      return measure_found_stars(added, nullptr, find_settings(again)).sources;
    });
    write_completeness(file, bins, settings.zero_point, frame.header.exposure_time);
    const double limit = completeness_limit(bins, 0.5);
    const auto magnitude = std::isfinite(limit)
                               ? magnitude_of(Electrons(limit) / frame.header.exposure_time, settings.zero_point)
                               : std::nullopt;
    record.notes.push_back(magnitude ? fmt::format("Of added stars of magnitude {:.2f} half come back ({}).",
                                                   magnitude->value(), file.string())
                                     : fmt::format("Added stars do not say where half come back ({}).", file.string()));
  }

  FoundStarsSettings find_settings(const ImagePhotometrySettings& settings) const {
    FoundStarsSettings find;
    find.detection.psf = settings.psf.get();
    if (options_.threshold) find.detection.threshold = *options_.threshold;
    find.measure = settings;
    if (options_.radius) find.radius = Pixels(*options_.radius);
    if (options_.correct_to) find.correct_to = Pixels(*options_.correct_to);
    return find;
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
                     bool psf_known, double fwhm) const {
    ImageScene scene;
    scene.psf_given = psf_known;
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

  std::vector<SourceMeasurement> fit_groups(const Frame& frame, const SkyProjection* sky,
                                            const ImagePhotometrySettings& settings, PhotometryRecord& record) const {
    if (!options_.background.empty())
      record.notes.emplace_back("--background was ignored: a level is fitted under each group of stars.");
    if (options_.radius) record.notes.emplace_back("--radius was ignored: stars are fitted, in no circles.");
    GroupPhotometrySettings groups;
    groups.psf = settings.psf;
    groups.psf_error = settings.psf_error;
    groups.map = settings.map;
    groups.zero_point = settings.zero_point;
    return measure_groups(frame, sky, requests_, groups);
  }

  std::vector<SourceMeasurement> fit_field(const Frame& frame, const SkyProjection* sky,
                                           const ImagePhotometrySettings& settings, PhotometryRecord& record) const {
    FieldPhotometrySettings field;
    field.zero_point = settings.zero_point;
    field.psf_error = settings.psf_error;
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
