#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "astroid/catalogues/passbands.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

struct Range {
  double low;
  double high;
};
constexpr Range kBtVtRange{-0.2, 1.8};        // mag; ESA 1997
constexpr Range kBvRange{-0.4, 2.0};          // mag; hottest and coolest stars
constexpr Range kBpRpRange{-0.5, 5.0};        // mag; Gaia EDR3 documentation, table 5.10
constexpr Range kBpRpTeffRange{-0.3, 3.0};    // mag; see teff_from_bp_rp
constexpr Range kTeffRange{3000.0, 15000.0};  // K; see v_minus_p

struct Counts {
  std::size_t assumed_bv = 0;
  std::size_t assumed_teff = 0;
  std::size_t clamped = 0;
};

/// One star's colours on demand: its own where it has them, else derived, else assumed.
class StarColours {
 public:
  StarColours(const CatalogueStar& star, const std::string& index, const PassbandAssumptions& assumptions)
      : star_(star), assumptions_(assumptions) {
    if (std::isfinite(star.colour) && !index.empty()) index_ = index;
  }

  double bt_vt() {
    if (index_ == "B_T-V_T") return clamp(star_.colour, kBtVtRange);
    // The slope of B-V on B_T-V_T: the relation is a proportionality, so its inverse is one too.
    return clamp(bv() / bv_from_bt_vt(1.0), kBtVtRange);
  }
  double bp_rp() {
    if (index_ == "BP-RP") return clamp(star_.colour, kBpRpRange);
    if (index_.empty() && !has_teff()) {
      assumed_bv_ = true;
      return bp_rp_from_teff(teff_from_bv(assumptions_.bv));
    }
    return bp_rp_from_teff(teff());
  }
  double teff() {
    if (has_teff()) return clamp(star_.teff, kTeffRange);
    if (index_ == "BP-RP") return clamp(teff_from_bp_rp(clamp(star_.colour, kBpRpTeffRange)), kTeffRange);
    if (!index_.empty()) return clamp(teff_from_bv(bv()), kTeffRange);
    assumed_teff_ = true;
    return clamp(assumptions_.teff, kTeffRange);
  }
  void count_in(Counts& counts) const {
    counts.assumed_bv += assumed_bv_ ? 1U : 0U;
    counts.assumed_teff += assumed_teff_ ? 1U : 0U;
    counts.clamped += clamped_ ? 1U : 0U;
  }

 private:
  [[nodiscard]] bool has_teff() const { return std::isfinite(star_.teff); }
  double bv() {
    if (index_ == "B-V") return clamp(star_.colour, kBvRange);
    if (index_ == "B_T-V_T") return clamp(bv_from_bt_vt(star_.colour), kBvRange);
    if (index_ == "BP-RP" || has_teff()) return clamp(bv_from_teff(teff()), kBvRange);
    assumed_bv_ = true;
    return assumptions_.bv;
  }
  double clamp(double value, Range range) {
    if (value < range.low || value > range.high) clamped_ = true;
    return std::clamp(value, range.low, range.high);
  }

  const CatalogueStar& star_;
  const PassbandAssumptions& assumptions_;
  std::string index_;
  bool assumed_bv_ = false;
  bool assumed_teff_ = false;
  bool clamped_ = false;
};

/// One relation between two passbands: magnitude in `blue` minus magnitude in `red`.
struct Relation {
  const char* first;
  const char* second;
  const char* source;
  DeltaMag (*first_minus_second)(StarColours&);
};

constexpr std::array<Relation, 4> kRelations{{
    {"B_T", "V_T", "the colour B_T-V_T itself", [](StarColours& star) { return DeltaMag(star.bt_vt()); }},
    {"V", "V_T", "ESA 1997", [](StarColours& star) { return v_minus_vt(star.bt_vt()); }},
    {"G", "V", "Gaia EDR3 documentation", [](StarColours& star) { return g_minus_v(star.bp_rp()); }},
    {"V", "P", "Marchiori et al. 2019", [](StarColours& star) { return v_minus_p(star.teff()); }},
}};

struct Step {
  const Relation* relation;
  bool forward;  ///< from `first` to `second`
};

/// The steps from one passband to another; the relations form a tree, so there is at most one way without turning back.
std::optional<std::vector<Step>> find_way(const std::string& from, const std::string& to, const Relation* came_by) {
  if (from == to) return std::vector<Step>{};
  for (const Relation& relation : kRelations) {
    if (&relation == came_by) continue;
    for (const bool forward : {true, false}) {
      if (from != (forward ? relation.first : relation.second)) continue;
      auto rest = find_way(forward ? relation.second : relation.first, to, &relation);
      if (!rest) continue;
      rest->insert(rest->begin(), Step{&relation, forward});
      return rest;
    }
  }
  return std::nullopt;
}

std::string describe(const std::string& from, std::span<const Step> way) {
  std::string text = "magnitudes converted from " + from;
  for (const Step& step : way) {
    text +=
        fmt::format(" to {} ({})", step.forward ? step.relation->second : step.relation->first, step.relation->source);
  }
  return text;
}

void add_notes(StarCatalogue& catalogue, const Counts& counts, const PassbandAssumptions& assumptions) {
  const std::size_t stars = catalogue.stars.size();
  if (counts.assumed_bv > 0) {
    catalogue.notes.push_back(
        fmt::format("{} of {} stars have no colour: B-V = {} assumed", counts.assumed_bv, stars, assumptions.bv));
  }
  if (counts.assumed_teff > 0) {
    catalogue.notes.push_back(fmt::format("{} of {} stars have no effective temperature and no colour: {} K assumed",
                                          counts.assumed_teff, stars, assumptions.teff));
  }
  if (counts.clamped > 0) {
    catalogue.notes.push_back(fmt::format(
        "{} of {} stars have a colour or temperature outside the range of a relation: the value at its edge is used",
        counts.clamped, stars));
  }
}

}  // namespace

std::string canonical_passband(std::string_view name) {
  std::string key;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  constexpr std::array<std::pair<std::string_view, std::string_view>, 22> kSpellings{{
      {"v", "V"},         {"vmag", "V"},    {"johnsonv", "V"}, {"vt", "V_T"},     {"vtmag", "V_T"},   {"tychov", "V_T"},
      {"tychovt", "V_T"}, {"bt", "B_T"},    {"btmag", "B_T"},  {"tychob", "B_T"}, {"tychobt", "B_T"}, {"gaia", "G"},
      {"gaiag", "G"},     {"gaiamag", "G"}, {"p", "P"},        {"pmag", "P"},     {"plato", "P"},     {"platop", "P"},
      {"tmag", "T"},      {"tess", "T"},    {"tesst", "T"},    {"kp", "Kp"},
  }};
  for (const auto& [spelling, passband] : kSpellings) {
    if (key == spelling) return std::string(passband);
  }
  // Capital G and T are Gaia's and TESS's; small g is another survey's band.
  if (name == "G" || name == "Gmag") return "G";
  if (name == "T") return "T";
  if (key == "kepmag" || key == "kpmag" || key == "kepler") return "Kp";
  return std::string(name);
}

void convert_passband(StarCatalogue& catalogue, const std::string& to, const PassbandAssumptions& assumptions) {
  const std::string target = canonical_passband(to);
  const std::string from = canonical_passband(catalogue.passband);
  if (catalogue.brightness == BrightnessKind::kElectrons || from == target) return;
  const auto way = find_way(from, target, nullptr);
  if (!way) {
    throw InputError({.file = catalogue.source,
                      .parameter = "passband",
                      .value = from,
                      .expected = "",
                      .message = fmt::format("passband mismatch: catalogue is in {}, zero point in {}; there is no "
                                             "conversion",
                                             from, target),
                      .suggestion = "give the zero point in the catalogue's passband, or a catalogue in the zero "
                                    "point's"});
  }
  Counts counts;
  for (CatalogueStar& star : catalogue.stars) {
    StarColours colours(star, catalogue.colour_index, assumptions);
    for (const Step& step : *way) {
      const DeltaMag first_minus_second = step.relation->first_minus_second(colours);
      star.magnitude = step.forward ? star.magnitude - first_minus_second : star.magnitude + first_minus_second;
    }
    colours.count_in(counts);
  }
  catalogue.passband = target;
  catalogue.notes.push_back(describe(from, *way));
  add_notes(catalogue, counts, assumptions);
}

}  // namespace astroid
