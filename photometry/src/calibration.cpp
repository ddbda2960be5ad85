#include "astroid/photometry/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/digitise.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

double square(double v) {
  return v * v;
}

/// Variance of a reference pixel without light, e-².
double dark_variance(const CalibrationModel& model) {
  return square(model.readout_noise.value()) + square(model.gain.value() / kSqrt12);
}

InputError no_reference(const char* parameter, const char* value, const char* expected, const char* message) {
  return InputError(Problem{.parameter = parameter, .value = value, .expected = expected, .message = message});
}

}  // namespace

FrameCalibration::FrameCalibration(const PixelLayout& layout, const CalibrationModel& model) : model_(model) {
  noise_ = {.readout = std::sqrt(dark_variance(model)) / model.gain.value(),
            .gain = model.gain.value(),
            .bias = model.bias.value()};
  const ReadoutNodes nodes(model.detector, model.nodes);
  bends_ =
      !model.response.is_linear() || std::any_of(model.gain_factors.begin(), model.gain_factors.begin() + nodes.count(),
                                                 [](double factor) { return factor != 1.0; });
  const std::span<const Rectangle> regions = layout.regions();
  std::vector<std::size_t> overscan;
  std::array<std::size_t, kMostNodes> prescan_pixels{};
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Rectangle& area = regions[r];
    const bool behind = area.y0 >= model.detector.y1() || (nodes.splits_columns() && area.y1() <= model.detector.y0);
    if (behind && area.x0 >= model.detector.x0 && area.x1() <= model.detector.x1()) {
      overscan.push_back(r);
      overscan_rows_ = area.ny;
    }
    if (!overscan.empty() && overscan.back() == r) {
      level_begins_.push_back(levels_);
      levels_ += static_cast<std::size_t>(area.nx);
    }
    const bool beside = area.x1() <= model.detector.x0 || (nodes.count() > 1 && area.x0 >= model.detector.x1());
    if (!beside) continue;
    for (int y = area.y0; y < area.y1(); ++y) {
      const auto node = static_cast<std::size_t>(nodes.of(area.x0, y));
      prescan_pixels[node] += static_cast<std::size_t>(area.nx);
      if (prescan_[node].empty() || prescan_[node].back() != r) prescan_[node].push_back(r);
    }
  }
  // Nodes through which no light-sensitive pixel is read need no bias.
  std::array<bool, kMostNodes> used{};
  for (const Rectangle& area : regions)
    if (is_light_sensitive(area))
      for (const int x : {area.x0, area.x1() - 1})
        for (const int y : {area.y0, area.y1() - 1}) used[static_cast<std::size_t>(nodes.of(x, y))] = true;
  fewest_prescan_ = std::numeric_limits<std::size_t>::max();
  for (std::size_t node = 0; node < used.size(); ++node)
    if (used[node]) fewest_prescan_ = std::min(fewest_prescan_, prescan_pixels[node]);
  if (model.measure_bias && fewest_prescan_ == 0)
    throw no_reference("Photometry/Calibration/Bias", "prescan", "prescan columns on the side of every node",
                       "the detector has no pixels that show the bias of each of its nodes");
  if (!model.subtract_smearing) return;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!is_light_sensitive(regions[r])) continue;
    for (int half = 0; half < nodes.halves(); ++half) {
      const Rectangle part = intersect(regions[r], nodes.half(model.detector, half));
      if (part.empty()) continue;
      const auto covers = [&](std::size_t o) {
        return regions[o].x0 <= part.x0 && regions[o].x1() >= part.x1() && nodes.half_of(regions[o].y0) == half;
      };
      const auto found = std::ranges::find_if(overscan, covers);
      if (found == overscan.end())
        throw no_reference("Photometry/Calibration/Smearing", "overscan", "overscan rows",
                           "the detector has no pixels that show what is smeared into its columns");
      columns_.push_back({.region = r,
                          .y0 = part.y0,
                          .y1 = part.y1(),
                          .level = level_begins_[static_cast<std::size_t>(found - overscan.begin())] +
                                   static_cast<std::size_t>(part.x0 - regions[*found].x0)});
    }
  }
  overscan_ = std::move(overscan);
}

bool FrameCalibration::is_light_sensitive(const Rectangle& region) const {
  return intersect(region, model_.detector) == region;
}

double FrameCalibration::bias_variance() const {
  if (!model_.measure_bias) return 0.0;
  return dark_variance(model_) / static_cast<double>(fewest_prescan_);
}

double FrameCalibration::measured_bias(const Frame& frame, int node, Scratch& scratch) const {
  const ReadoutNodes nodes(model_.detector, model_.nodes);
  scratch.values.clear();
  for (const std::size_t r : prescan_[static_cast<std::size_t>(node)]) {
    const auto view = frame.pixels.view(r);
    const Rectangle& area = view.area();
    for (int y = area.y0; y < area.y1(); ++y)
      if (nodes.of(area.x0, y) == node)
        scratch.values.insert(scratch.values.end(), view.row(y).begin(), view.row(y).end());
  }
  const double level = reference_level(scratch.values, noise_);
  // What comes out of the electronics without a signal is no part of the bias before them.
  return std::isfinite(level) ? level - model_.response.a0 : model_.bias.value();
}

void FrameCalibration::straighten(Frame& frame, std::span<const double> bias) const {
  const ReadoutNodes nodes(model_.detector, model_.nodes);
  const double pedestal = model_.bias.value();
  for (std::size_t r = 0; r < frame.pixels.layout().regions().size(); ++r) {
    const auto view = frame.pixels.view(r);
    const Rectangle& area = view.area();
    for (int y = area.y0; y < area.y1(); ++y) {
      for_each_node(nodes, y, area.x0, area.x1(), [&](int node, int x0, int x1) {
        const std::span<float> row =
            view.row(y).subspan(static_cast<std::size_t>(x0 - area.x0), static_cast<std::size_t>(x1 - x0));
        const double level = bias[static_cast<std::size_t>(node)];
        const double factor = model_.gain_factors[static_cast<std::size_t>(node)];
        if (model_.response.is_linear()) {
          for (float& count : row) count = static_cast<float>(pedestal + factor * (static_cast<double>(count) - level));
        } else {
          for (float& count : row)
            count = static_cast<float>(pedestal + factor * model_.response.in(static_cast<double>(count) - level));
        }
      });
    }
  }
}

void FrameCalibration::subtract_smearing(Frame& frame, Scratch& scratch) const {
  scratch.levels.resize(levels_);
  const Frame& measured = frame;
  for (std::size_t o = 0; o < overscan_.size(); ++o) {
    const auto rows = measured.pixels.view(overscan_[o]);
    column_levels(rows, noise_,
                  std::span(scratch.levels).subspan(level_begins_[o], static_cast<std::size_t>(rows.nx())));
  }
  for (double& level : scratch.levels) level -= model_.bias.value();
  for (const Columns& columns : columns_) {
    const auto view = frame.pixels.view(columns.region);
    const Rectangle& area = view.area();
    const double* levels = scratch.levels.data() + columns.level;
    for (int y = columns.y0; y < columns.y1; ++y) {
      float* row = view.row(y).data();
      for (int i = 0; i < area.nx; ++i) row[i] = static_cast<float>(static_cast<double>(row[i]) - levels[i]);
    }
  }
}

void FrameCalibration::apply(Frame& frame, Scratch& scratch) const {
  if (bends_ || model_.measure_bias) {
    std::array<double, kMostNodes> bias{};
    bias.fill(model_.bias.value());
    const int nodes = ReadoutNodes(model_.detector, model_.nodes).count();
    if (model_.measure_bias)
      for (int node = 0; node < nodes; ++node)
        bias[static_cast<std::size_t>(node)] = measured_bias(frame, node, scratch);
    straighten(frame, bias);
  }
  if (model_.subtract_smearing) subtract_smearing(frame, scratch);
}

}  // namespace astroid
