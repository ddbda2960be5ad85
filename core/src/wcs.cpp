#include "astroid/core/wcs.hpp"

#include <fmt/format.h>
#include <wcslib/wcs.h>
#include <wcslib/wcsfix.h>
#include <wcslib/wcshdr.h>
#include <wcslib/wcsmath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "wcs_engine.hpp"

namespace astroid {

namespace {

constexpr std::array<std::string_view, 5> kProjections = {"TAN", "SIN", "ARC", "STG", "ZEA"};
constexpr double kHorizon = 90.0;        // deg from the axis, where TAN is infinite and SIN folds back
constexpr double kNearAntipode = 1e-6;   // deg around the antipode, which STG, ARC and ZEA cannot place
constexpr double kEdgeWidth = 1e-10;     // deg inside the horizon that count as the horizon: rounding of a separation
constexpr std::size_t kCardLength = 80;  // characters, FITS standard
constexpr double kWorldEquinox = 2000.0;

Direction unit_vector(const Direction& u) {
  return combine(1.0 / det::sqrt(dot(u, u)), u, 0.0, u);
}

// Galactic coordinates of the equatorial axes: rows are ICRS unit vectors of the galactic x, y and z axes.
// @source ESA1997 Vol. 1 Eq. 1.5.11
constexpr std::array<Direction, 3> kGalacticAxes = {{{-0.0548755604, -0.8734370902, -0.4838350155},
                                                     {0.4941094279, -0.4448296300, 0.7469822445},
                                                     {-0.8676661490, -0.1980763734, 0.4559837762}}};

SkyPosition galactic_to_icrs(SkyPosition galactic) {
  const Direction g = to_direction(galactic);
  return to_sky_position(combine(1.0, combine(g.x, kGalacticAxes[0], g.y, kGalacticAxes[1]), g.z, kGalacticAxes[2]));
}

SkyPosition icrs_to_galactic(SkyPosition icrs) {
  const Direction d = to_direction(icrs);
  return to_sky_position({dot(kGalacticAxes[0], d), dot(kGalacticAxes[1], d), dot(kGalacticAxes[2], d)});
}

void check_pointing(const CameraPointing& p) {
  std::vector<Problem> problems;
  const auto refuse = [&](const char* parameter, const std::string& value, const char* expected) {
    problems.push_back(
        Problem{.parameter = parameter, .value = value, .expected = expected, .message = "cannot be used"});
  };
  if (std::find(kProjections.begin(), kProjections.end(), p.projection) == kProjections.end()) {
    refuse("projection", p.projection, "TAN, SIN, ARC, STG or ZEA");
  }
  if (!(p.scale.value() > 0.0 && std::isfinite(p.scale.value()))) {
    refuse("pixel scale", fmt::format("{}", p.scale.value()), "a positive number of arcsec/px");
  }
  if (!std::isfinite(p.axis.ra)) refuse("right ascension of the axis", fmt::format("{}", p.axis.ra), "degrees");
  if (!(std::abs(p.axis.dec) <= kHorizon)) {
    refuse("declination of the axis", fmt::format("{}", p.axis.dec), "-90 .. 90 degrees");
  }
  if (!std::isfinite(p.roll.value())) refuse("roll", fmt::format("{}", p.roll.value()), "degrees");
  if (!std::isfinite(p.axis_pixel.x) || !std::isfinite(p.axis_pixel.y)) {
    refuse("pixel of the axis", fmt::format("({}, {})", p.axis_pixel.x, p.axis_pixel.y), "two pixel coordinates");
  }
  if (p.distortion != nullptr && p.detector.empty()) refuse("detector", "0 px", "the pixels that headers describe");
  if (!problems.empty()) throw InputError(std::move(problems));
}

// CD matrix in degrees per pixel, row by row, of the convention stated at CameraPointing.
std::array<double, 4> cd_matrix(const CameraPointing& p) {
  const double scale = to_degrees(Pixels(1.0) * p.scale).value();
  const SineCosine roll = sine_cosine(p.roll);
  return {-scale * roll.cosine, -scale * roll.sine, -scale * roll.sine, scale * roll.cosine};
}

void append_sip(const SipFit& fit, std::vector<FitsCard>& cards) {
  const SipPolynomial& sip = fit.polynomial;
  const std::string comment =
      fit.worst > 0.0 ? fmt::format("within {:.1g} px of the simulated distortion", fit.worst) : "distortion, exact";
  for (const char side : {'A', 'B'}) {
    cards.emplace_back(fmt::format("{}_ORDER", side), sip.order, comment);
    const std::vector<double>& coefficients = side == 'A' ? sip.a : sip.b;
    for (int i = 0; i <= sip.order; ++i) {
      for (int j = 0; i + j <= sip.order; ++j) {
        const double value = coefficients[sip.index(i, j)];
        if (value != 0.0) cards.emplace_back(fmt::format("{}_{}_{}", side, i, j), value);
      }
    }
  }
}

WcsPointer make_wcs(const CameraPointing& p) {
  auto wcs = std::make_unique<wcsprm>();
  wcs->flag = -1;
  const int status = wcsinit(1, 2, wcs.get(), 0, 0, 0);
  WcsPointer result(wcs.release());
  if (status != 0) throw std::runtime_error(wcs_message(status));
  const std::array<double, 4> cd = cd_matrix(p);
  std::copy(cd.begin(), cd.end(), result->cd);
  result->altlin = 2;  // the matrix is CD
  result->crpix[0] = p.axis_pixel.x + 1.0;
  result->crpix[1] = p.axis_pixel.y + 1.0;
  result->crval[0] = wrap_degrees(p.axis.ra);
  result->crval[1] = p.axis.dec;
  result->lonpole = 180.0;  // deg; said explicitly, for its default jumps to 0 at the pole
  const auto set_text = [](char* field, const std::string& text) { field[text.copy(field, text.size())] = '\0'; };
  set_text(result->ctype[0], "RA---" + p.projection);
  set_text(result->ctype[1], "DEC--" + p.projection);
  for (int i = 0; i < 2; ++i) set_text(result->cunit[i], "deg");
  if (const int set = wcsset(result.get()); set != 0) throw std::runtime_error(wcs_message(set));
  return result;
}

bool has_celestial_axis(const wcsprm& wcs) {
  for (int i = 0; i < wcs.naxis; ++i) {
    const std::string_view type = wcs.ctype[i];
    if (type.starts_with("RA--") || type.starts_with("DEC-")) return true;
    if (type.size() > 4 && (type.substr(1, 4) == "LON-" || type.substr(1, 4) == "LAT-")) return true;
  }
  return false;
}

// Blanks in place of bytes that FITS forbids, and no cards with texts that never end: WCSLIB 7.12 writes past its
// buffers when it meets such a card.
std::string harmless_header(std::string header) {
  std::replace_if(
      header.begin(), header.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
  constexpr std::size_t kValueColumn = 10;  // where a card's value begins, from 0
  for (std::size_t at = 0; at + kCardLength <= header.size(); at += kCardLength) {
    const std::string_view card(header.data() + at, kCardLength);
    const std::size_t open = card.find_first_not_of(' ', kValueColumn);
    if (open == std::string_view::npos || card[open] != '\'') continue;
    if (std::count(card.begin(), card.end(), '\'') % 2 != 0) header.replace(at, kCardLength, kCardLength, ' ');
  }
  return header;
}

// How far from its axis a projection has an image, deg.
double reach(const wcsprm& wcs) {
  const std::string code = wcs.cel.prj.code;
  const bool zenithal = std::find(kProjections.begin(), kProjections.end(), code) != kProjections.end();
  const bool axis_is_pole = wcs.cel.theta0 == kHorizon && wcs.cel.offset == 0;
  if (!zenithal || !axis_is_pole) return std::numeric_limits<double>::infinity();
  return code == "TAN" || code == "SIN" ? kHorizon - kEdgeWidth : 2.0 * kHorizon - kNearAntipode;
}

}  // namespace

struct SkyProjection::State {
  WcsEngine engine;
  std::optional<CameraPointing> pointing;  // nothing: from a header
  bool galactic = false;
  SkyPosition axis{};
  PixelPosition axis_pixel{};
  double reach = 0.0;  // deg
  PixelScale scale{};
  std::string code{};
  CameraAxes frame{};                         // about which attitudes turn
  std::optional<SipFit> header_distortion{};  // nothing: none, or none that is good enough

  State(WcsPointer wcs, std::optional<CameraPointing> p) : engine(std::move(wcs)), pointing(std::move(p)) {
    const wcsprm& w = engine.wcs();
    galactic = std::string_view(w.lngtyp).starts_with("GLON");
    axis_pixel = {w.crpix[0] - 1.0, w.crpix[1] - 1.0};
    const SkyPosition reference{w.crval[w.lng], w.crval[w.lat]};
    axis = galactic ? galactic_to_icrs(reference) : SkyPosition{wrap_degrees(reference.ra), reference.dec};
    reach = astroid::reach(w);
    code = w.cel.prj.code;
    if (pointing) {
      axis = {wrap_degrees(pointing->axis.ra), pointing->axis.dec};
      axis_pixel = pointing->axis_pixel;
      scale = pointing->scale;
      CameraPointing turned = *pointing;
      if (pointing->spacecraft) turned.roll = pointing->spacecraft->roll;
      set_frame(pointing->spacecraft ? pointing->spacecraft->axis : axis, cd_matrix(turned));
      set_header_distortion();
    } else {
      measure_frame();
    }
  }

  // @param cd  degrees on the tangent plane per pixel, row by row: (east, north) of x, y
  void set_frame(SkyPosition about, const std::array<double, 4>& cd) {
    const auto [east, north] = horizon(about);
    frame.axis = to_direction(about);
    frame.x = unit_vector(combine(cd[0], east, cd[2], north));
    const Direction y = combine(cd[1], east, cd[3], north);
    frame.y = unit_vector(combine(1.0, y, -dot(y, frame.x), frame.x));
  }

  void set_header_distortion() {
    constexpr double kAim = 1e-5;  // px; a higher order is worth its cards until then
    if (pointing->distortion == nullptr) return;
    const Distortion& distortion = *pointing->distortion;
    if (const SipPolynomial* sip = distortion.sip()) {
      header_distortion = SipFit{.polynomial = *sip, .worst = 0.0};
    } else {
      header_distortion = fit_sip(distortion, pointing->detector, axis_pixel, kAim);
      if (header_distortion && header_distortion->worst > kHeaderTolerance) header_distortion.reset();
    }
  }

  // Between a perfect camera and the real one; NaN where there is no image.
  [[nodiscard]] PixelPosition distorted(PixelPosition ideal) const { return moved(ideal, &Distortion::distort); }
  [[nodiscard]] PixelPosition undistorted(PixelPosition real) const { return moved(real, &Distortion::undistort); }
  [[nodiscard]] PixelPosition moved(PixelPosition p,
                                    std::optional<PixelShift> (Distortion::*map)(PixelShift) const) const {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    if (!pointing || pointing->distortion == nullptr) return p;
    const auto offset = (*pointing->distortion.*map)({p.x - axis_pixel.x, p.y - axis_pixel.y});
    return offset ? PixelPosition{axis_pixel.x + offset->dx, axis_pixel.y + offset->dy} : PixelPosition{kNan, kNan};
  }

  // For a WCS from a header, whatever its distortions and pole: the matrix by differences over one pixel.
  void measure_frame() {
    const auto column = [&](double dx, double dy) {
      const auto plus = gnomonic(to_sky({axis_pixel.x + dx, axis_pixel.y + dy}), axis);
      const auto minus = gnomonic(to_sky({axis_pixel.x - dx, axis_pixel.y - dy}), axis);
      if (!plus || !minus) return TangentPlanePoint{};
      return TangentPlanePoint{(plus->xi - minus->xi) / 2.0, (plus->eta - minus->eta) / 2.0};
    };
    const TangentPlanePoint x = column(1.0, 0.0);
    const TangentPlanePoint y = column(0.0, 1.0);
    const double area = std::abs(x.xi * y.eta - x.eta * y.xi);
    if (!(area > 0.0)) throw std::runtime_error("no image around its reference point");
    scale = PixelScale(to_arcseconds(Degrees(det::sqrt(area))).value());
    set_frame(axis, {x.xi, y.xi, x.eta, y.eta});
  }

  // Unrounded; NaN where there is no image.
  void project(std::span<const SkyPosition> positions, std::span<PixelPosition> pixels) const {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<SkyPosition> world(positions.begin(), positions.end());
    for (SkyPosition& position : world) {
      if (galactic) position = icrs_to_galactic(position);
    }
    engine.to_pixels(world, pixels);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const SkyPosition& p = positions[i];
      if (p.ra == axis.ra && p.dec == axis.dec && pointing) {
        pixels[i] = axis_pixel;
      } else if (!std::isfinite(p.ra) || !(std::abs(p.dec) <= kHorizon) ||
                 !(angular_separation(axis, p).value() < reach)) {
        pixels[i] = {kNan, kNan};
      } else {
        pixels[i] = distorted({pixels[i].x - 1.0, pixels[i].y - 1.0});
      }
    }
  }

  [[nodiscard]] SkyPosition to_sky(PixelPosition position) const {
    if (position.x == axis_pixel.x && position.y == axis_pixel.y && pointing) return axis;
    const PixelPosition ideal = undistorted(position);
    if (!std::isfinite(ideal.x) || !std::isfinite(ideal.y)) {
      return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    }
    const SkyPosition world = engine.to_world({ideal.x + 1.0, ideal.y + 1.0});
    if (galactic) return galactic_to_icrs(world);
    return {wrap_degrees(world.ra), world.dec};
  }
};

std::span<const std::string_view> supported_projections() {
  return kProjections;
}

PixelPosition round_to_pixel_grid(PixelPosition position) {
  const auto rounded = [](double value) { return std::floor(value / kPixelGrid + 0.5) * kPixelGrid; };
  return {rounded(position.x), rounded(position.y)};
}

SkyProjection::SkyProjection(std::shared_ptr<const State> state) : state_(std::move(state)) {}

SkyProjection::SkyProjection(const CameraPointing& pointing) {
  check_pointing(pointing);
  state_ = std::make_shared<const State>(make_wcs(pointing), pointing);
}

std::optional<SkyProjection> SkyProjection::from_header(const std::string& header, const std::string& file) {
  const auto refuse = [&](const std::string& reason) {
    return InputError(
        Problem{.file = file,
                .expected = "a celestial WCS of the FITS standard in ICRS, FK5 (J2000) or galactic coordinates",
                .message = "the world coordinates of the header cannot be used: " + reason});
  };
  std::string text = harmless_header(header);  // WCSLIB's parser wants a writable one
  int rejected = 0;
  int count = 0;
  wcsprm* all = nullptr;
  {
    static std::mutex parser;  // WCSLIB does not promise that its header parser may run twice at a time
    const std::lock_guard lock(parser);
    const int status =
        wcspih(text.data(), static_cast<int>(text.size() / kCardLength), WCSHDR_all, 0, &rejected, &count, &all);
    if (status != 0) throw refuse(wcs_message(status));
  }
  struct Release {
    int* count;
    wcsprm** all;
    ~Release() { wcsvfree(count, all); }
  } const release{&count, &all};
  if (count == 0) return std::nullopt;
  wcsprm& primary = all[0];
  if (!has_celestial_axis(primary)) return std::nullopt;
  // Repairs of old headers. The last of them calls wcsset() itself, and WCSLIB leaks when that fails and is called
  // again.
  (void)cdfix(&primary);
  (void)unitfix(0, &primary);
  if (const int status = celfix(&primary); status > 0) throw refuse(wcsfix_errmsg[status]);
  if (const int status = wcsset(&primary); status != 0) throw refuse(wcs_message(status));
  if (primary.lng < 0 || primary.lat < 0) throw refuse("only one of two celestial axes");

  const std::string_view longitude = primary.lngtyp;
  const std::string_view frame = primary.radesys;
  if (!longitude.starts_with("RA") && !longitude.starts_with("GLON")) {
    throw refuse(fmt::format("coordinates {} are not known", longitude));
  }
  if (longitude.starts_with("RA") && frame != "ICRS") {
    if (!frame.empty() && frame != "FK5") throw refuse(fmt::format("RADESYS {} is not known", frame));
    if (!undefined(primary.equinox) && primary.equinox != kWorldEquinox) {
      throw refuse(fmt::format("EQUINOX is {}, not {}", primary.equinox, kWorldEquinox));
    }
  }
  try {
    return SkyProjection(std::make_shared<const State>(copy_wcs(primary, true), std::nullopt));
  } catch (const std::runtime_error& error) {
    throw refuse(error.what());
  }
}

std::optional<PixelPosition> SkyProjection::to_pixel(SkyPosition position) const {
  return to_pixels({&position, 1}).front();
}

std::vector<std::optional<PixelPosition>> SkyProjection::to_pixels(std::span<const SkyPosition> positions) const {
  std::vector<PixelPosition> pixels(positions.size());
  state_->project(positions, pixels);
  std::vector<std::optional<PixelPosition>> result(positions.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (std::isfinite(pixels[i].x) && std::isfinite(pixels[i].y)) result[i] = round_to_pixel_grid(pixels[i]);
  }
  return result;
}

SkyPosition SkyProjection::to_sky(PixelPosition position) const {
  return state_->to_sky(position);
}

std::optional<AttitudeJacobian> SkyProjection::attitude_jacobian(SkyPosition position) const {
  // f'(0) = sum of weight * (f(k h) - f(-k h)) / h for k = 1, 2, 3, correct to h^6.
  constexpr std::array<double, 3> kWeights = {3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0};
  constexpr double kLongestStep =
      600.0;  // arcsec: 1e-15 relative truncation near the axis, rounding far below the grid
  constexpr double kEdgeDistances = 60.0;  // steps to the projection's edge at least: keeps truncation below 1e-9 there
  constexpr std::size_t kPoints = 6 * kWeights.size();
  const State& state = *state_;
  const double margin = state.reach - angular_separation(state.axis, position).value();
  if (!(margin > 0.0)) return std::nullopt;
  const double step = std::min(kLongestStep, to_arcseconds(Degrees(margin)).value() / kEdgeDistances);

  // The star in the camera's frame; a turn mixes two of its three components.
  const Direction sky = to_direction(position);
  const std::array<double, 3> star = {dot(sky, state.frame.x), dot(sky, state.frame.y), dot(sky, state.frame.axis)};
  // Yaw moves the axis direction (2) to x (0), pitch the axis direction to y (1), roll x to y.
  constexpr std::array<std::array<std::size_t, 2>, 3> kTurns = {{{2, 0}, {2, 1}, {0, 1}}};
  std::vector<SkyPosition> turned;
  turned.reserve(kPoints);
  for (const auto& [from, to] : kTurns) {
    for (std::size_t k = 0; k < kWeights.size(); ++k) {
      for (const double sign : {1.0, -1.0}) {
        const Arcseconds angle(sign * step * static_cast<double>(k + 1));
        const SineCosine turn = sine_cosine(to_degrees(angle));
        std::array<double, 3> v = star;
        v[from] = turn.cosine * star[from] - turn.sine * star[to];
        v[to] = turn.sine * star[from] + turn.cosine * star[to];
        turned.push_back(
            to_sky_position(combine(1.0, combine(v[0], state.frame.x, v[1], state.frame.y), v[2], state.frame.axis)));
      }
    }
  }
  std::vector<PixelPosition> pixels(kPoints);
  state.project(turned, pixels);
  std::array<PixelPosition, 3> derivative{};
  for (std::size_t t = 0; t < derivative.size(); ++t) {
    for (std::size_t k = 0; k < kWeights.size(); ++k) {
      const PixelPosition& plus = pixels[2 * (t * kWeights.size() + k)];
      const PixelPosition& minus = pixels[2 * (t * kWeights.size() + k) + 1];
      derivative[t].x += kWeights[k] * (plus.x - minus.x) / step;
      derivative[t].y += kWeights[k] * (plus.y - minus.y) / step;
    }
    if (!std::isfinite(derivative[t].x) || !std::isfinite(derivative[t].y)) return std::nullopt;
  }
  const auto rounded = [](double value) { return std::floor(value / kJacobianGrid + 0.5) * kJacobianGrid; };
  return AttitudeJacobian{.dx_dyaw = rounded(derivative[0].x),
                          .dx_dpitch = rounded(derivative[1].x),
                          .dx_droll = rounded(derivative[2].x),
                          .dy_dyaw = rounded(derivative[0].y),
                          .dy_dpitch = rounded(derivative[1].y),
                          .dy_droll = rounded(derivative[2].y)};
}

std::optional<Degrees> SkyProjection::field_angle(PixelPosition position) const {
  if (!state_->pointing) throw BugError("SkyProjection: the field angle of a projection that came from a header");
  const PixelPosition ideal = state_->undistorted(position);
  const PixelPosition axis = state_->axis_pixel;
  const double r =
      det::hypot(ideal.x - axis.x, ideal.y - axis.y) * to_radians(to_degrees(Pixels(1.0) * state_->scale)).value();
  if (!std::isfinite(r)) return std::nullopt;
  const std::string& code = state_->code;
  double angle = r;  // ARC
  if (code == "TAN") angle = det::atan(r);
  if (code == "SIN") angle = det::asin(r);
  if (code == "STG") angle = 2.0 * det::atan(0.5 * r);
  if (code == "ZEA") angle = 2.0 * det::asin(0.5 * r);
  if (!(angle < kPi)) return std::nullopt;  // NaN beyond the edge of SIN and ZEA
  return to_degrees(Radians(angle));
}

PixelPosition SkyProjection::axis_pixel() const {
  return state_->axis_pixel;
}
SkyPosition SkyProjection::axis() const {
  return state_->axis;
}
PixelScale SkyProjection::pixel_scale() const {
  return state_->scale;
}
const std::string& SkyProjection::code() const {
  return state_->code;
}

std::vector<FitsCard> SkyProjection::fits_cards(int x0, int y0) const {
  if (!state_->pointing) throw BugError("SkyProjection: keywords of a projection that came from a header");
  const CameraPointing& p = *state_->pointing;
  const std::optional<SipFit>& distortion = state_->header_distortion;
  if (p.distortion != nullptr && !distortion) return {};
  const std::array<double, 4> cd = cd_matrix(p);
  const std::string suffix = p.projection + (distortion ? "-SIP" : "");
  std::vector<FitsCard> cards = {{"WCSAXES", 2, "number of world coordinate axes"},
                                 {"CTYPE1", "RA---" + suffix, "right ascension"},
                                 {"CTYPE2", "DEC--" + suffix, "declination"},
                                 {"CUNIT1", "deg"},
                                 {"CUNIT2", "deg"},
                                 {"CRPIX1", p.axis_pixel.x - x0 + 1.0, "optical axis, first pixel centre at 1"},
                                 {"CRPIX2", p.axis_pixel.y - y0 + 1.0, "optical axis, first pixel centre at 1"},
                                 {"CRVAL1", state_->axis.ra, "[deg] optical axis"},
                                 {"CRVAL2", state_->axis.dec, "[deg] optical axis"},
                                 {"CD1_1", cd[0], "[deg/px]"},
                                 {"CD1_2", cd[1], "[deg/px]"},
                                 {"CD2_1", cd[2], "[deg/px]"},
                                 {"CD2_2", cd[3], "[deg/px]"},
                                 {"LONPOLE", 180.0, "[deg] native longitude of the celestial pole"},
                                 {"RADESYS", "ICRS", "reference system"}};
  if (distortion) append_sip(*distortion, cards);
  return cards;
}

}  // namespace astroid
