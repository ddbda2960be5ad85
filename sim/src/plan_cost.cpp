#include "plan_cost.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "astroid/core/psf.hpp"
#include "plan_memory.hpp"
#include "star_lists.hpp"

namespace astroid {

namespace {

/// Nanoseconds a pixel and exposure, measured by `astroid doctor --calibrate` on one core of the machine named in
/// docs/performance.md, which has AVX-512; with SSE4 alone noise takes two to three times as long.
struct PixelCost {
  std::string_view effect;
  double nanoseconds;
};
constexpr PixelCost kPixelCosts[] = {{"sky", 0.1},
                                     {"zodiacal-sky", 0.85},
                                     {"stray-light", 0.85},
                                     {"prnu", 0.27},
                                     {"dark-current", 0.27},
                                     {"photon-noise", 2.1},
                                     {"full-well", 0.12},
                                     {"readout-noise", 1.15},
                                     {"gain", 0.17},
                                     {"bias", 0.1},
                                     {"adc", 0.22},
                                     {"flat-field", 0.33},
                                     {"charge-injection", 0.01},
                                     {"vignetting", 0.32},
                                     {"variable-stars", 0.2},
                                     {"open-shutter-smearing", 0.65},
                                     {"frame-transfer-smearing", 0.7},
                                     {"hot-pixels", 0.01},
                                     {"dead-pixels", 0.01},
                                     {"cross-talk", 2.0},
                                     {"non-linearity", 0.8},
                                     {"bias-drift", 0.1},
                                     {"row-offset", 0.14},
                                     {"pick-up-noise", 2.7},
                                     {"bad-pixel-map", 0.02}};
/// The same of a CMOS detector, a read (bench: BM_CmosExposure).
constexpr PixelCost kReadCosts[] = {{"pixel-saturation", 0.5}, {"inter-pixel-capacitance", 6.0},
                                    {"pixel-gain", 0.4},       {"reset-noise", 1.45},
                                    {"column-noise", 0.8},     {"pixel-offset", 0.4},
                                    {"ramp-reads", 3.0},       {"ramp-fit", 2.2}};
constexpr double kClear = 0.1;     ///< ns a pixel: the noiseless image is set to zero
constexpr double kRegion = 150.0;  ///< ns a region: what a window takes beyond its pixels
/// Ns a pixel of one map, where the maps fit into a share of the last cache and where they come from memory.
constexpr double kMapPixel = 0.15;
constexpr double kFarMapPixel = 0.27;
constexpr double kCachedBytes = 16.0 * 1024.0 * 1024.0;
/// What it takes to render a star, once for each strip that it reaches (bench: BM_AddStar).
struct StarCost {
  double star;        ///< ns
  double row;         ///< ns a row of the stamp
  double pixel;       ///< ns a pixel of the stamp
  double broadening;  ///< factor
};
constexpr StarCost kAnalytic{.star = 70.0, .row = 5.0, .pixel = 0.1, .broadening = 1.7};
constexpr StarCost kPrf{.star = 100.0, .row = 0.0, .pixel = 5.0, .broadening = 5.0};
/// Of the sub-pixel renderer (bench: BM_SubPixelFrame).
constexpr double kMapNode = 11.0;    ///< ns a node of the map
constexpr double kDeposit = 3500.0;  ///< ns a star, once for each tile that it reaches
constexpr double kMapCell = 15.0;    ///< ns a cell of the light
/// Of persistence (bench: BM_Persistence): what each pixel gives, and what it takes from each image that is kept.
constexpr double kTaking = 0.4;
constexpr double kPastImage = 0.6;
constexpr double kNanosecond = 1e-9;

/// Ns a pixel of what moves charge between pixels (bench: BM_ChargeTransfer, BM_Traps, BM_BrighterFatter); rows are
/// cheaper to move than columns, which are turned first.
double moving_cost(std::string_view effect, const CcdSettings& ccd) {
  constexpr double kShift = 0.9;   // range² times
  constexpr double kSimple = 2.0;  // for each direction
  constexpr double kTrap = 6.0;    // for each species
  if (effect == "brighter-fatter") return kShift * ccd.brighter_fatter.range * ccd.brighter_fatter.range;
  if (effect != "cti") return 0.0;
  if (ccd.cti.model == CtiModel::kSimple)
    return (ccd.cti.parallel > 0.0 ? kSimple : 0.0) + (ccd.cti.serial > 0.0 ? 2.0 * kSimple : 0.0);
  return kTrap * static_cast<double>(ccd.cti.trap_density.size() + ccd.cti.register_density.size());
}

/// Ns a pixel of the particles of one cycle (bench: BM_CosmicRays).
double particle_cost(const Mission& mission) {
  constexpr double kParticle = 750.0;    // ns
  constexpr double kCentimetres = 1e-4;  // in a micrometre
  const double side = mission.ccd.pixel_size * kCentimetres;
  return kParticle * mission.ccd.cosmic_rays.rate * side * side * mission.simulation.cycle.value();
}

const StarCost& star_cost(const Plan& plan) {
  return plan.renderer == "analytic" ? kAnalytic : kPrf;
}

double nanoseconds_of(const StarCost& cost, double rows, double columns) {
  return cost.star + rows * (cost.row + columns * cost.pixel);
}

/// How many times a star is rendered for one exposure.
double renderings(const Plan& plan) {
  switch (plan.knobs.jitter) {
    case JitterTreatment::kBroadened:
      return star_cost(plan).broadening;
    case JitterTreatment::kSubSteps:
      return plan.knobs.attitude_steps;
    default:
      return 1.0;
  }
}

/// Of the pixels that are computed.
double stars_cost(const Plan& plan, const Scene& scene) {
  const StarCost& cost = star_cost(plan);
  std::vector<Rectangle> areas;
  for (const Strip& strip : make_strips(*plan.layout, kStripPixels, plan.knobs.band_rows))
    areas.insert(areas.end(), strip.areas.begin(), strip.areas.end());
  double nanoseconds = 0.0;
  auto next = areas.begin();
  for (const auto& stars : star_lists(scene, plan.knobs, areas, {})) {
    const Rectangle& area = *next++;
    for (const RenderedStar& star : stars) {
      const Rectangle stamp = intersect(stamp_box(star.position, star.half_width), area);
      if (!stamp.empty()) nanoseconds += nanoseconds_of(cost, stamp.ny, stamp.nx);
    }
  }
  return nanoseconds * renderings(plan);
}

/// The sub-pixel renderer's time, for the tiles that touch some regions (none: all).
double map_seconds(const Plan& plan, const Scene& scene, std::span<const Rectangle> regions) {
  const SubPixelRenderer& map = *scene.sub_pixel_renderer();
  double tiles = 0.0;
  double pixels = 0.0;
  for (const Rectangle& tile : map.tiles()) {
    if (!regions.empty() &&
        std::ranges::none_of(regions, [&](const Rectangle& region) { return !intersect(region, tile).empty(); }))
      continue;
    tiles += 1.0;
    pixels += static_cast<double>(tile.size());
  }
  const double share = pixels / std::max(1.0, static_cast<double>(scene.detector().size()));
  const double deposits = share * static_cast<double>(scene.summary().stars) * renderings(plan);
  const auto maps = static_cast<double>(map.maps());
  const double nodes = maps * static_cast<double>(map.map_size());
  const double cells = static_cast<double>(map.cells()) * map.cells();
  return kNanosecond * (tiles * nodes * kMapNode + maps * deposits * kDeposit + pixels * cells * kMapCell);
}

/// Whether the noiseless image is recalled rather than rendered.
bool recalls(const Plan& plan) {
  return plan.still || plan.knobs.jitter == JitterTreatment::kPolynomial;
}

/// The effects that make the stars: one of them runs.
bool renders_stars(const EffectSpec& spec) {
  return spec.name == "stars" || spec.name == "sub-pixel-stars";
}

/// Of one effect that runs, on the machine that the constants were measured on.
double nominal_seconds(const PlannedEffect& effect, const Plan& plan, const Scene& scene) {
  const EffectSpec& spec = effect.effect->spec();
  const auto pixels = static_cast<double>(plan.layout->size());
  if (renders_stars(spec)) {     // which makes the noiseless image, or stands for its recall
    if (plan.still) return 0.0;  // the draws read it where it lies
    if (plan.knobs.jitter == JitterTreatment::kPolynomial)
      return maps_seconds(plan.knobs.polynomial.terms.size(), pixels);
    if (scene.sub_pixel_renderer() != nullptr)
      return kNanosecond * kClear * pixels + map_seconds(plan, scene, plan.layout->exposed_regions());
    return kNanosecond * (kClear * pixels + stars_cost(plan, scene));
  }
  if (recalls(plan) && spec.role != ImageRole::kVaryingLight && spec.level <= EffectLevel::kPixelMean) return 0.0;
  const double reads = spec.per_read ? plan.reads : 1;
  for (const std::span<const PixelCost> costs :
       {std::span<const PixelCost>(kPixelCosts), std::span<const PixelCost>(kReadCosts)})
    for (const PixelCost& cost : costs)
      if (cost.effect == spec.name) return kNanosecond * cost.nanoseconds * pixels * reads;
  if (spec.name == "persistence")
    return kNanosecond * pixels * (kTaking + kPastImage * static_cast<double>(kept_images(plan, scene)));
  if (spec.name == "cosmic-rays") return kNanosecond * particle_cost(scene.mission()) * pixels;
  return kNanosecond * moving_cost(spec.name, scene.mission().ccd) * pixels;
}

}  // namespace

double full_frame_seconds(const Plan& plan, const Scene& scene) {
  if (scene.sub_pixel_renderer() != nullptr) return map_seconds(plan, scene, {});
  const StarCost& cost = star_cost(plan);
  const double strip_rows = std::max(1.0, static_cast<double>(kStripPixels) / scene.detector().nx);
  double nanoseconds = 0.0;
  for (const SceneStar& star : scene.stars()) {
    const double side = 2.0 * plan.knobs.stamp_half_width(star.electrons) + 1.0;
    const double strips = 1.0 + (side - 1.0) / strip_rows;  // on average, wherever the star lies
    nanoseconds += nanoseconds_of(cost, side, side) + (strips - 1.0) * cost.star;
  }
  return kNanosecond * nanoseconds * renderings(plan);
}

double maps_seconds(std::size_t terms, double pixels) {
  const double map_pixel = maps_bytes(terms, pixels) > kCachedBytes ? kFarMapPixel : kMapPixel;
  return kNanosecond * pixels * map_pixel * static_cast<double>(terms);
}

double maps_bytes(std::size_t terms, double pixels) {
  return pixels * static_cast<double>(sizeof(double) + (terms - 1) * sizeof(float));
}

std::string cost_part(const PlannedEffect& effect, const Plan& plan) {
  const EffectSpec& spec = effect.effect->spec();
  if (!renders_stars(spec)) return std::string(spec.name);
  return plan.knobs.jitter == JitterTreatment::kPolynomial ? "maps" : "stars, " + plan.renderer;
}

void predict_times(Plan& plan, const Scene& scene, const CostFactors& costs) {
  const PixelLayout& layout = *plan.layout;
  plan.seconds_per_exposure = kNanosecond * kRegion * static_cast<double>(layout.regions().size());
  for (PlannedEffect& effect : plan.effects) {
    effect.seconds =
        effect.need.needed ? nominal_seconds(effect, plan, scene) * costs.of(cost_part(effect, plan)) : 0.0;
    plan.seconds_per_exposure += effect.seconds;
  }
}

double predicted_memory(const Plan& plan, const Scene& scene) {
  double bytes_per_pixel = sizeof(float) + sizeof(std::uint8_t);  // the frame
  // Drawn electrons, where charge moves from pixel to pixel.
  if (plan.reads > 1 && plan.runs("inter-pixel-capacitance"))  // planes and ramps of all pixels from read to read
    bytes_per_pixel += 5.0 * sizeof(double) + sizeof(float) + 2.0 * sizeof(std::uint8_t);
  if (plan.runs("full-well") || plan.runs("brighter-fatter") || plan.runs("cti")) bytes_per_pixel += sizeof(double);
  bytes_per_pixel += sizeof(float) * static_cast<double>(kept_images(plan, scene));
  constexpr double kStripPlanes = 3.0;  // expected and drawn electrons, ADU
  const SubPixelRenderer* map = scene.sub_pixel_renderer();
  const bool whole = map != nullptr && !recalls(plan);  // expected electrons, tile by tile
  if (whole) bytes_per_pixel += sizeof(double);
  return (whole ? map->workspace_bytes() : 0.0) + bytes_per_pixel * static_cast<double>(plan.layout->size()) +
         kStripPlanes * sizeof(double) * static_cast<double>(kStripPixels);
}

}  // namespace astroid
