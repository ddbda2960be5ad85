// The entries of the parameter table: what a configuration may say, in data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/mission.hpp"

namespace astroid::configuration {

enum class Kind { kReal, kInteger, kBoolean, kText, kChoice, kFile, kTime, kIntegerList, kRealList };

/// An interval of numbers in the parameter's documented unit; an open end excludes its bound.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_is_open = false;

  [[nodiscard]] bool contains(double value) const {
    return (minimum_is_open ? value > minimum : value >= minimum) && value <= maximum;
  }
};
constexpr Range from_to(double minimum, double maximum) {
  return {minimum, maximum, false};
}
constexpr Range above_up_to(double minimum, double maximum) {
  return {minimum, maximum, true};
}
constexpr Range at_least(double minimum) {
  return {.minimum = minimum};
}

/// A value as parsed. Which member counts is the parameter's kind.
struct Value {
  double real = 0.0;                   ///< kReal, in the documented unit; kTime: MJD
  std::int64_t integer = 0;            ///< kInteger; the N of a counted choice ("every N")
  bool flag = false;                   ///< kBoolean
  std::size_t choice = 0;              ///< kChoice: index in `choices`
  bool is_keyword = false;             ///< kReal: the parameter's keyword was written instead of a number
  std::string text;                    ///< every kind: canonical text, in the documented unit
  std::vector<std::int64_t> integers;  ///< kIntegerList
  std::vector<double> reals;           ///< kRealList, in the documented unit
};

/// One parameter. `assign` copies a checked value to its place in the Mission.
struct Parameter {
  std::string_view path;
  Kind kind = Kind::kReal;
  bool is_attribute = false;           ///< its last name is an XML attribute of what is before
  bool is_required = false;            ///< else `fallback`; an empty one means unset
  bool is_required_in_parent = false;  ///< required only where its parent element is present
  std::string_view unit = {};          ///< as written in the file
  Range range = {};
  std::string_view fallback = {};              ///< the default, as text in `unit`
  std::string_view keyword = {};               ///< a word allowed in place of the number
  std::vector<std::string_view> choices = {};  ///< "every N" stands for "every" and an integer of at least 1
  std::string_view meaning = {};               ///< one sentence
  std::string_view example = {};               ///< a typical value, in `unit`
  void (*assign)(Mission&, const Value&) = nullptr;
};

/// Ends the name of a counted choice, which is followed by an integer in the file.
inline constexpr std::string_view kCountedSuffix = " N";

/// Every parameter, section by section, in the order of the reference page.
std::span<const Parameter> parameter_table();

/// The entry of a path, or null.
const Parameter* find_parameter(std::string_view path);

/// True for a path that has parameters below it and is no parameter itself ("CCD", "Satellite/Jitter").
bool is_section(std::string_view path);

/// One sentence about a section.
std::string_view section_meaning(std::string_view path);

/// Names of elements that may stand in a section ("": in the root), in order.
std::vector<std::string> element_names(std::string_view section);

/// Names of the parameters that are attributes of an element, in order.
std::vector<std::string> attribute_names(std::string_view element);

/// "CCD/Gain" -> "Gain" and "CCD".
std::string_view last_name(std::string_view path);
std::string_view parent_path(std::string_view path);
std::string join_path(std::string_view parent, std::string_view name);

// The sections of the table, one file each.
std::vector<Parameter> simulation_parameters();
std::vector<Parameter> satellite_parameters();
std::vector<Parameter> motion_parameters();
std::vector<Parameter> telescope_parameters();
std::vector<Parameter> group_parameters();
std::vector<Parameter> optics_parameters();
std::vector<Parameter> renderer_parameters();
std::vector<Parameter> psf_parameters();
std::vector<Parameter> intra_pixel_parameters();
std::vector<Parameter> stellar_field_parameters();
std::vector<Parameter> sky_parameters();
std::vector<Parameter> ccd_parameters();
std::vector<Parameter> cmos_parameters();
std::vector<Parameter> pixel_effect_parameters();
std::vector<Parameter> readout_parameters();
std::vector<Parameter> photometry_parameters();
std::vector<Parameter> analysis_parameters();
std::vector<Parameter> output_parameters();

}  // namespace astroid::configuration
