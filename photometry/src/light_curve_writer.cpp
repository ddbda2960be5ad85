#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "light_curve_cards.hpp"

namespace astroid {

namespace {

// Rows of a table that are held at a time.
constexpr std::int64_t kRowsAtOnce = 65536;

template <class Value>
std::vector<Value> column_of(std::span<const LightCurveStar> stars, Value LightCurveStar::*member) {
  std::vector<Value> values;
  values.reserve(stars.size());
  for (const LightCurveStar& star : stars) values.push_back(star.*member);
  return values;
}

int longest_id(std::span<const LightCurveStar> stars) {
  std::size_t longest = 1;
  for (const LightCurveStar& star : stars) longest = std::max(longest, star.id.size());
  return static_cast<int>(longest);
}

}  // namespace

struct LightCurveWriter::Impl {
  // The sum over cameras of one block, until the last camera has come.
  struct Mean {
    int next_camera = 1;
    std::size_t count = 0;
    std::vector<float> sum;
    std::vector<std::uint8_t> good;  // cameras with a finite value
  };
  // The block that is being written; camera 0: none.
  struct Block {
    int camera = 0;
    std::int64_t first = 0;
    std::size_t count = 0;
    Mean* mean = nullptr;  // with several cameras
  };

  Impl(const std::string& path, const LightCurveHeader& h, std::span<const LightCurveStar> s,
       std::vector<std::vector<LightCurveStar>> g)
      : header(h), stars(static_cast<std::int64_t>(s.size())), groups(std::move(g)), writer(path) {
    ASTROID_CHECK_LE(1, header.cameras);
    ASTROID_CHECK_LE(header.cameras, std::numeric_limits<std::uint8_t>::max());
    ASTROID_CHECK_LE(0, header.exposures);
    written.assign(static_cast<std::size_t>(header.cameras), 0);
    begin_primary();
    write_times();
    write_stars(s, "STARS");
    for (int camera = 1; camera <= header.cameras; ++camera)
      images.push_back(begin_image("CAMERA" + std::to_string(camera), camera_cards(camera)));
    if (header.cameras > 1) combined = begin_image("COMBINED", {});
  }

  void begin_primary() {
    writer.begin_image(FitsNumber::kUnsigned8, {});
    writer.cards(detail::time_cards());
    writer.card({"CAMERAS", header.cameras, "number of cameras"});
    writer.card({"EXPOSURE", header.exposures, "number of exposures"});
    writer.card({"STARS", stars, "number of stars"});
    writer.card({"CYCLE", header.cycle, "[s] from exposure to exposure"});
    writer.card({"EXPTIME", header.exposure_time, "[s] exposure time"});
    writer.card({"MJD-BEG", header.start_mjd, "[d] TDB, start of the first exposure"});
    if (header.line_time > 0.0)
      writer.card({"LINETIME", header.line_time, "[s] a star's TIME is later by LINETIME * Y"});
    if (!groups.empty()) writer.card({"GROUPS", static_cast<int>(groups.size()), "number of groups of cameras"});
    for (const std::string& line : header.history) writer.history(line);
  }

  void write_times() {
    writer.begin_table({{"TIME", FitsNumber::kFloat64, "d"}, {"CADENCENO", FitsNumber::kInt64}}, "TIME",
                       header.exposures);
    writer.cards(detail::time_cards());
    std::vector<double> time;
    std::vector<std::int64_t> cadence;
    for (std::int64_t first = 0; first < header.exposures; first += kRowsAtOnce) {
      time.clear();
      cadence.clear();
      for (std::int64_t k = first; k < std::min(first + kRowsAtOnce, header.exposures); ++k) {
        time.push_back(mid_exposure_bjd(header, k));
        cadence.push_back(k);
      }
      writer.write_column(0, first, time);
      writer.write_column(1, first, cadence);
    }
  }

  [[nodiscard]] std::vector<FitsCard> camera_cards(int camera) const {
    if (groups.empty()) return {};
    return {
        {"GROUP", header.group.at(static_cast<std::size_t>(camera) - 1) + 1, "of this camera: stars in STARSn"},
        {"STAGGER", header.stagger.at(static_cast<std::size_t>(camera) - 1), "[s] from a cycle's start; TIME: mean"}};
  }

  void write_stars(std::span<const LightCurveStar> s, const std::string& name) {
    std::vector<FitsColumn> columns{{"ID", FitsNumber::kFloat64, "", longest_id(s)},
                                    {"MAG", FitsNumber::kFloat64, "mag"},
                                    {"X", FitsNumber::kFloat64, "pixel"},
                                    {"Y", FitsNumber::kFloat64, "pixel"},
                                    {"REFERENCE", FitsNumber::kFloat64, "electron"},
                                    {"NSR", FitsNumber::kFloat64},
                                    {"FLAGS", FitsNumber::kInt32}};
    if (header.has_responses)
      for (const char* axis : {"RYAW", "RPITCH", "RROLL"}) columns.push_back({axis, FitsNumber::kFloat64, "arcsec-1"});
    writer.begin_table(columns, name, stars);
    if (s.empty()) return;
    std::vector<std::int32_t> star_flags;
    star_flags.reserve(s.size());
    for (const LightCurveStar& star : s) star_flags.push_back(static_cast<std::int32_t>(star.flags));
    writer.write_column(0, 0, column_of(s, &LightCurveStar::id));
    writer.write_column(1, 0, column_of(s, &LightCurveStar::magnitude));
    writer.write_column(2, 0, column_of(s, &LightCurveStar::x));
    writer.write_column(3, 0, column_of(s, &LightCurveStar::y));
    writer.write_column(4, 0, column_of(s, &LightCurveStar::reference));
    writer.write_column(5, 0, column_of(s, &LightCurveStar::nsr_exposure));
    writer.write_column(6, 0, star_flags);
    if (!header.has_responses) return;
    std::size_t column = 7;
    for (double AttitudeResponse::*axis : {&AttitudeResponse::yaw, &AttitudeResponse::pitch, &AttitudeResponse::roll}) {
      std::vector<double> values;
      for (const LightCurveStar& star : s) values.push_back(star.response.*axis);
      writer.write_column(column++, 0, values);
    }
  }

  int begin_image(const std::string& name, const std::vector<FitsCard>& cards) {
    // An image without pixels is written as a header alone: FITS knows no axis of length 0 that readers agree on.
    const bool empty = stars == 0 || header.exposures == 0;
    const int unit = empty ? writer.begin_image(FitsNumber::kFloat32, {}, name)
                           : writer.begin_large_image(FitsNumber::kFloat32, {header.exposures, stars}, name);
    writer.card({"BUNIT", "", "relative deviation from REFERENCE"});
    writer.cards(cards);
    if (!empty) writer.end_large_header();
    return unit;
  }

  void begin_block(int camera, std::int64_t first, std::size_t count) {
    ASTROID_CHECK_EQ(block.camera, 0);
    ASTROID_CHECK_LE(1, camera);
    ASTROID_CHECK_LE(camera, header.cameras);
    ASTROID_CHECK_LE(0, first);
    ASTROID_CHECK_LE(first + static_cast<std::int64_t>(count), header.exposures);
    std::int64_t& done = written[static_cast<std::size_t>(camera - 1)];
    ASTROID_CHECK_LE(done + static_cast<std::int64_t>(count), header.exposures);
    Block next{.camera = camera, .first = first, .count = count, .mean = nullptr};
    if (header.cameras > 1 && count > 0) {
      Mean& mean = means[first];
      if (camera == mean.next_camera && camera == 1) {
        mean.count = count;
        mean.sum.assign(count * static_cast<std::size_t>(stars), 0.0F);
        mean.good.assign(mean.sum.size(), 0);
      }
      ASTROID_CHECK_EQ(camera, mean.next_camera);
      ASTROID_CHECK_EQ(count, mean.count);
      next.mean = &mean;
    }
    block = next;
    stars_written = 0;
    done += static_cast<std::int64_t>(count);
  }

  void write_star(std::size_t star, std::span<const float> deviation) {
    ASTROID_CHECK_LE(1, block.camera);
    ASTROID_CHECK_LT(star, static_cast<std::size_t>(stars));
    ASTROID_CHECK_EQ(deviation.size(), block.count);
    if (block.count > 0) {
      const std::int64_t at = static_cast<std::int64_t>(star) * header.exposures + block.first;
      writer.write_large_pixels(images[static_cast<std::size_t>(block.camera - 1)], at, deviation);
      if (block.mean != nullptr) add_to_mean(*block.mean, star, deviation, at);
    }
    ++stars_written;
  }

  void add_to_mean(Mean& mean, std::size_t star, std::span<const float> deviation, std::int64_t at) const {
    const std::span<float> sum = std::span(mean.sum).subspan(star * block.count, block.count);
    const std::span<std::uint8_t> good = std::span(mean.good).subspan(star * block.count, block.count);
    for (std::size_t k = 0; k < sum.size(); ++k) {
      if (!std::isfinite(deviation[k])) continue;
      sum[k] += deviation[k];
      ++good[k];
    }
    if (block.camera < header.cameras) return;
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] = good[k] > 0 ? sum[k] / static_cast<float>(good[k]) : std::numeric_limits<float>::quiet_NaN();
    writer.write_large_pixels(combined, at, sum);
  }

  void end_block() {
    ASTROID_CHECK_LE(1, block.camera);
    ASTROID_CHECK_EQ(stars_written.load(), stars);
    if (block.mean != nullptr && ++block.mean->next_camera > header.cameras) means.erase(block.first);
    block = {};
  }

  void write_attitudes(int camera, std::span<const Attitude> of_camera) {
    writer.begin_table({{"CADENCENO", FitsNumber::kInt64},
                        {"YAW", FitsNumber::kFloat64, "arcsec"},
                        {"PITCH", FitsNumber::kFloat64, "arcsec"},
                        {"ROLL", FitsNumber::kFloat64, "arcsec"}},
                       "ATTITUDE" + std::to_string(camera), static_cast<std::int64_t>(of_camera.size()));
    if (of_camera.empty()) return;
    std::vector<std::int64_t> cadence(of_camera.size());
    std::iota(cadence.begin(), cadence.end(), std::int64_t{0});
    writer.write_column(0, 0, cadence);
    std::size_t column = 1;
    for (double Attitude::*axis : {&Attitude::yaw, &Attitude::pitch, &Attitude::roll}) {
      std::vector<double> values;
      for (const Attitude& attitude : of_camera) values.push_back(attitude.*axis);
      writer.write_column(column++, 0, values);
    }
  }

  void write_flags() {
    join_flags(flags);
    writer.begin_table({{"CAMERA", FitsNumber::kInt32},
                        {"STAR", FitsNumber::kInt32},
                        {"CADENCENO", FitsNumber::kInt64},
                        {"EXPOSURES", FitsNumber::kInt64},
                        {"FLAGS", FitsNumber::kInt32}},
                       "FLAGS", static_cast<std::int64_t>(flags.size()));
    for (std::size_t first = 0; first < flags.size(); first += static_cast<std::size_t>(kRowsAtOnce)) {
      const std::size_t last = std::min(flags.size(), first + static_cast<std::size_t>(kRowsAtOnce));
      std::vector<std::int32_t> camera;
      std::vector<std::int32_t> star;
      std::vector<std::int64_t> exposure;
      std::vector<std::int64_t> exposures;
      std::vector<std::int32_t> bits;
      for (std::size_t i = first; i < last; ++i) {
        camera.push_back(static_cast<std::int32_t>(flags[i].camera));
        star.push_back(static_cast<std::int32_t>(flags[i].star));
        exposure.push_back(flags[i].exposure);
        exposures.push_back(flags[i].exposures);
        bits.push_back(static_cast<std::int32_t>(flags[i].flags));
      }
      const auto row = static_cast<std::int64_t>(first);
      writer.write_column(0, row, camera);
      writer.write_column(1, row, star);
      writer.write_column(2, row, exposure);
      writer.write_column(3, row, exposures);
      writer.write_column(4, row, bits);
    }
  }

  LightCurveHeader header;
  std::int64_t stars;
  std::vector<std::vector<LightCurveStar>> groups;
  FitsWriter writer;
  std::vector<int> images;  // unit of each camera
  int combined = 0;
  std::vector<std::int64_t> written;   // exposures of each camera
  std::map<std::int64_t, Mean> means;  // by first exposure
  Block block;
  std::atomic<std::int64_t> stars_written{0};  // of the block
  std::vector<LightCurveFlag> flags;
  std::vector<std::vector<Attitude>> attitudes;  // [camera][exposure], where corrected for
};

LightCurveWriter::LightCurveWriter(const std::string& path, const LightCurveHeader& header,
                                   std::span<const LightCurveStar> stars,
                                   std::vector<std::vector<LightCurveStar>> groups)
    : impl_(std::make_unique<Impl>(path, header, stars, std::move(groups))) {}

LightCurveWriter::~LightCurveWriter() = default;

void LightCurveWriter::write_block(int camera, std::int64_t first, std::size_t count,
                                   std::span<const float> deviation) {
  const auto stars = static_cast<std::size_t>(impl_->stars);
  ASTROID_CHECK_EQ(deviation.size(), count * stars);
  begin_block(camera, first, count);
  for (std::size_t star = 0; star < stars; ++star) write_star(star, deviation.subspan(star * count, count));
  end_block();
}

void LightCurveWriter::begin_block(int camera, std::int64_t first, std::size_t count) {
  impl_->begin_block(camera, first, count);
}

void LightCurveWriter::write_star(std::size_t star, std::span<const float> deviation) {
  impl_->write_star(star, deviation);
}

void LightCurveWriter::end_block() {
  impl_->end_block();
}

void LightCurveWriter::add_flags(std::span<const LightCurveFlag> flags) {
  impl_->flags.insert(impl_->flags.end(), flags.begin(), flags.end());
}

void LightCurveWriter::add_attitudes(int camera, std::span<const Attitude> attitudes) {
  ASTROID_CHECK_LE(1, camera);
  ASTROID_CHECK_LE(camera, impl_->header.cameras);
  impl_->attitudes.resize(static_cast<std::size_t>(impl_->header.cameras));
  std::vector<Attitude>& all = impl_->attitudes[static_cast<std::size_t>(camera) - 1];
  all.insert(all.end(), attitudes.begin(), attitudes.end());
}

void LightCurveWriter::commit(Durability durability) {
  for (const std::int64_t written : impl_->written) ASTROID_CHECK_EQ(written, impl_->header.exposures);
  for (std::size_t g = 0; g < impl_->groups.size(); ++g)
    impl_->write_stars(impl_->groups[g], "STARS" + std::to_string(g + 1));
  impl_->write_flags();
  if (impl_->header.is_corrected)
    for (std::size_t camera = 0; camera < impl_->attitudes.size(); ++camera) {
      ASTROID_CHECK_EQ(static_cast<std::int64_t>(impl_->attitudes[camera].size()), impl_->header.exposures);
      impl_->write_attitudes(static_cast<int>(camera) + 1, impl_->attitudes[camera]);
    }
  impl_->writer.commit(durability);
}

}  // namespace astroid
