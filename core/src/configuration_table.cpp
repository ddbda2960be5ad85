#include <algorithm>
#include <array>
#include <utility>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

struct Section {
  std::string_view path;
  std::string_view meaning;
};

constexpr std::array kSections = {
    Section{"Simulation", "What is simulated, for how long and how accurately."},
    Section{"Satellite", "Where the spacecraft looks and how well it holds still."},
    Section{"Satellite/Pointing", "Direction of the optical axis, ICRS."},
    Section{"Satellite/Jitter", "Attitude noise, shared by all cameras."},
    Section{"Satellite/Drift", "Slow motion of the line of sight."},
    Section{"Satellite/Repointing", "How the spacecraft is pointed anew each quarter."},
    Section{"Telescope", "How much light reaches the detector, and in how many cameras."},
    Section{
        "Telescope/Groups",
        "Groups of cameras with an optical axis, a time, a pixel phase and a throughput of their own; they share the "
        "attitude. Each list has one value for each group."},
    Section{"Telescope/Ageing", "How the optics lose throughput over the years."},
    Section{"Telescope/Distortion", "How positions depart from those of a perfect camera."},
    Section{"Telescope/Vignetting", "How stars, sky and stray light fade away from the optical axis."},
    Section{"Telescope/Ghosts", "Reflections of bright stars, on the other side of the optical axis."},
    Section{"PSF", "The image of a star."},
    Section{"PSF/IntraPixel", "Sensitivity within a pixel, relative to the pixel's mean."},
    Section{"PSF/Breathing", "How the width of the PSF follows the temperature."},
    Section{"StellarField", "The stars and the sky behind them."},
    Section{"StellarField/StrayLight", "Light in every pixel that comes from outside the field."},
    Section{"CCD", "The detector and its electronics."},
    Section{"CCD/OpticalAxis",
            "Pixel where the optical axis meets the detector; the centre of the first pixel is (0, 0)."},
    Section{"CCD/ReferencePixels", "Pixels that are read with the light-sensitive ones but see no light."},
    Section{"CCD/Smearing", "Light that falls on charge while it is moved, in a detector without a shutter."},
    Section{"CCD/Nodes", "Amplifiers that read parts of the detector at the same time."},
    Section{"CCD/Electronics", "What the electronics do to the signal between the nodes and the converter."},
    Section{"CCD/BadPixels", "Pixels that do not work, at places drawn once or known."},
    Section{"CCD/SubField", "The part of the detector that is simulated; without this element all of it."},
    Section{"CCD/FlatField", "A pattern of sensitivity with a power-law spatial spectrum, beside the white PRNU."},
    Section{"CCD/ChargeInjection", "Lines of charge that keep traps filled."},
    Section{"CCD/CosmicRays", "Particles that leave tracks of charge."},
    Section{"CCD/BrighterFatter", "Charge in a pixel pushes its boundaries inwards."},
    Section{"CCD/CTI", "Charge that transfers leave behind."},
    Section{"CMOS", "What only a CMOS detector has; what both kinds have stands in CCD."},
    Section{"CMOS/Coupling", "Inter-pixel capacitance."},
    Section{"CMOS/Telegraph", "Random telegraph signal of the dark current."},
    Section{"CMOS/Persistence", "Charge of an exposure that appears in the following ones."},
    Section{"Photometry", "How fluxes are measured."},
    Section{"Photometry/Annulus", "Ring around a star in which the local background is measured."},
    Section{"Photometry/Calibration", "Which corrections are applied to the images before they are measured."},
    Section{"Photometry/Knowledge", "How wrong the ground is about what it knows."},
    Section{"Analysis", "What is made of the fluxes."},
    Section{"Output", "What is written."},
};

std::vector<Parameter> whole_table() {
  std::vector<Parameter> table;
  for (auto part :
       {simulation_parameters, renderer_parameters, satellite_parameters, motion_parameters, telescope_parameters,
        group_parameters, optics_parameters, psf_parameters, intra_pixel_parameters, stellar_field_parameters,
        sky_parameters, ccd_parameters, pixel_effect_parameters, readout_parameters, cmos_parameters,
        photometry_parameters, analysis_parameters, output_parameters}) {
    for (Parameter& parameter : part()) table.push_back(std::move(parameter));
  }
  return table;
}

void add_once(std::vector<std::string>& names, std::string_view name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

/// The part of `path` below `parent`, empty where it is not below it.
std::string_view below(std::string_view path, std::string_view parent) {
  if (parent.empty()) return path;
  if (path.size() <= parent.size() || !path.starts_with(parent) || path[parent.size()] != '/') return {};
  return path.substr(parent.size() + 1);
}

}  // namespace

std::span<const Parameter> parameter_table() {
  static const std::vector<Parameter> table = whole_table();
  return table;
}

const Parameter* find_parameter(std::string_view path) {
  const auto table = parameter_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return p.path == path; });
  return found == table.end() ? nullptr : &*found;
}

bool is_section(std::string_view path) {
  return std::any_of(kSections.begin(), kSections.end(), [&](const Section& s) { return s.path == path; });
}

std::string_view section_meaning(std::string_view path) {
  const auto found = std::find_if(kSections.begin(), kSections.end(), [&](const Section& s) { return s.path == path; });
  return found == kSections.end() ? std::string_view() : found->meaning;
}

std::vector<std::string> element_names(std::string_view section) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameter_table()) {
    const std::string_view rest = below(parameter.path, section);
    if (rest.empty()) continue;
    const auto slash = rest.find('/');
    if (slash == std::string_view::npos && parameter.is_attribute) continue;
    add_once(names, rest.substr(0, slash));
  }
  return names;
}

std::vector<std::string> attribute_names(std::string_view element) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.is_attribute && parent_path(parameter.path) == element) add_once(names, last_name(parameter.path));
  }
  return names;
}

std::string_view last_name(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

std::string_view parent_path(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

std::string join_path(std::string_view parent, std::string_view name) {
  std::string path(parent);
  if (!path.empty()) path += '/';
  return path += name;
}

}  // namespace astroid::configuration
