#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "read_reference_pixels.hpp"

namespace astroid {

namespace {

struct Keyword {
  std::string name;
  double value = 0.0;
};

// The first of the keywords that holds a finite number. In extensions, what holds for all of them is in the primary.
std::optional<Keyword> first_number(const FitsReader& reader, int unit, std::initializer_list<const char*> keys) {
  constexpr int kPrimary = 1;
  for (const int where : {unit, kPrimary}) {
    for (const char* key : keys) {
      std::optional<double> value;
      try {
        value = reader.number(where, key);
      } catch (const InputError&) {
        continue;  // somebody keeps a text there
      }
      if (value && std::isfinite(*value)) return Keyword{key, *value};
    }
  }
  return std::nullopt;
}

std::string lower_case_unit(const FitsReader& reader, int unit) {
  std::string text;
  try {
    text = reader.text(unit, "BUNIT").value_or("");
  } catch (const InputError&) {
    return {};
  }
  std::string squeezed;
  for (const char c : text)
    if (c != ' ') squeezed += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return squeezed;
}

bool is_one_of(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&text](const char* word) { return text == word; });
}

class FrameReader {
 public:
  FrameReader(const std::filesystem::path& path, const FrameReadOptions& options)
      : options_(options), reader_(path), unit_(options.unit > 0 ? options.unit : reader_.first_image()) {}

  ImageFile read() {
    read_pixels();
    read_exposure();
    read_gain();
    read_saturation();
    read_bias();
    set_flags();
    if (options_.use_overscan && !is_cube_) detail::subtract_overscan(reader_, unit_, file_.frame, file_.notes);
    try {
      file_.sky = SkyProjection::from_header(reader_.header_text(unit_), reader_.file());
    } catch (const InputError& error) {
      file_.notes.push_back(fmt::format("The celestial coordinates of the header were not used: {}", error.what()));
    }
    return std::move(file_);
  }

 private:
  void read_pixels() {
    if (static_cast<std::size_t>(unit_) > reader_.units().size()) {
      Problem problem;
      problem.file = reader_.file();
      problem.parameter = "unit";
      problem.value = fmt::format("{}", unit_);
      problem.expected = fmt::format("1 to {}", reader_.units().size());
      problem.message = "the file has no such header-data unit";
      throw InputError(std::move(problem));
    }
    const auto& axes = reader_.units().at(static_cast<std::size_t>(unit_ - 1)).axes;
    const bool cube = axes.size() > 2 && axes[2] > 1;
    is_cube_ = cube;
    const auto image = cube ? reader_.read_plane<float, unit::Adu>(unit_, options_.plane)
                            : reader_.read_image<float, unit::Adu>(unit_);
    if (cube)
      file_.notes.push_back(
          fmt::format("The image is a cube of {} planes; only plane {} was read.", axes[2], options_.plane));
    const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, image.nx(), image.ny()}});
    file_.frame.pixels = Plane<float, unit::Adu>(layout);
    file_.frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
    std::copy(image.pixels().begin(), image.pixels().end(), file_.frame.pixels.pixels().begin());
  }

  void read_exposure() {
    FrameHeader& header = file_.frame.header;
    const auto time = first_number(reader_, unit_, {"EXPTIME", "EXPOSURE", "ITIME", "INT_TIME"});
    if (options_.exposure_time) {
      header.exposure_time = *options_.exposure_time;
    } else if (time && time->value > 0.0) {
      header.exposure_time = Seconds(time->value);
    } else {
      file_.notes.emplace_back("The header gives no exposure time: 1 s assumed.");
    }
    const auto noise = first_number(reader_, unit_, {"RDNOISE", "READNOIS", "RON", "READNOISE", "RDNOISE1", "RDNOIS1"});
    if (options_.readout_noise) {
      header.readout_noise = *options_.readout_noise;
    } else if (noise && noise->value >= 0.0) {
      header.readout_noise = Electrons(noise->value);
    } else {
      file_.notes.emplace_back("The header gives no readout noise: the scatter of the background stands for it.");
    }
  }

  void read_gain() {
    FrameHeader& header = file_.frame.header;
    const std::string pixel_unit = lower_case_unit(reader_, unit_);
    const auto gain = first_number(reader_, unit_, {"EGAIN", "GAIN", "CCDGAIN", "ATODGAIN", "GAINEFF", "GAIN1"});
    if (options_.gain) {
      header.gain = *options_.gain;
    } else if (is_one_of(pixel_unit, {"e-", "e", "electron", "electrons"})) {
      header.gain = Gain(1.0);
    } else if (is_one_of(pixel_unit, {"e-/s", "e/s", "electron/s", "electrons/s", "electrons-1", "e-s-1"})) {
      header.gain = Gain(header.exposure_time.value());
    } else if (gain && gain->value > 0.0) {
      header.gain = Gain(gain->value);
    } else {
      file_.gain_assumed = true;
      file_.notes.emplace_back("The header gives no gain: 1 e-/ADU assumed, so errors are only as good as that.");
    }
  }

  void read_saturation() {
    FrameHeader& header = file_.frame.header;
    const auto level = first_number(reader_, unit_, {"SATURATE", "SATLEVEL"});
    if (options_.saturation) {
      header.saturation = *options_.saturation;
    } else if (level && level->value > 0.0) {
      header.saturation = Adu(level->value);
    } else {
      header.saturation = Adu(largest_number());
    }
  }

  // Only light brings photon noise, so a bias that nobody knows of makes every error too large.
  void read_bias() {
    FrameHeader& header = file_.frame.header;
    const auto prescan = is_cube_ ? std::nullopt : detail::prescan_level(reader_, unit_, header);
    if (options_.bias) {
      header.bias = *options_.bias;
    } else if (prescan) {
      header.bias = *prescan;
    } else if (const auto level = first_number(reader_, unit_, {"BIAS"});
               level && reader_.unit_of(unit_, "BIAS") == "adu") {
      // Others keep voltages under this name.
      header.bias = Adu(level->value);
    }
  }

  // The largest pixel value that the image can hold; infinite for one of floating-point numbers.
  double largest_number() const {
    const auto bits = reader_.integer(unit_, "BITPIX");
    if (!bits || *bits <= 0 || *bits > 32) return std::numeric_limits<double>::infinity();
    const bool is_signed = *bits > 8;
    const double largest = std::ldexp(1.0, static_cast<int>(*bits) - (is_signed ? 1 : 0)) - 1.0;
    const auto scale = first_number(reader_, unit_, {"BSCALE"});
    const auto zero = first_number(reader_, unit_, {"BZERO"});
    return largest * (scale ? scale->value : 1.0) + (zero ? zero->value : 0.0);
  }

  void set_flags() {
    const auto pixels = file_.frame.pixels.pixels();
    const auto flags = file_.frame.flags.pixels();
    const double saturation = file_.frame.header.saturation.value();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!std::isfinite(pixels[i])) {
        flags[i] = pixel_flag::kBad;
      } else if (static_cast<double>(pixels[i]) >= saturation) {
        flags[i] = pixel_flag::kAdcSaturated;
      }
    }
  }

  const FrameReadOptions& options_;
  FitsReader reader_;
  int unit_;
  bool is_cube_ = false;
  ImageFile file_;
};

void check(const FrameReadOptions& options, const std::filesystem::path& path) {
  std::vector<Problem> problems;
  const auto need = [&](bool good, const char* parameter, double value, const char* expected) {
    if (good) return;
    Problem problem;
    problem.file = path.string();
    problem.parameter = parameter;
    problem.value = fmt::format("{}", value);
    problem.expected = expected;
    problem.message = "the image cannot be calibrated with it";
    problems.push_back(std::move(problem));
  };
  if (options.gain) need(options.gain->value() > 0.0, "gain", options.gain->value(), "more than 0 e-/ADU");
  if (options.readout_noise)
    need(options.readout_noise->value() >= 0.0, "readout noise", options.readout_noise->value(), "0 e- or more");
  if (options.exposure_time)
    need(options.exposure_time->value() > 0.0, "exposure time", options.exposure_time->value(), "more than 0 s");
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

ImageFile read_frame(const std::filesystem::path& path, const FrameReadOptions& options) {
  check(options, path);
  return FrameReader(path, options).read();
}

}  // namespace astroid
