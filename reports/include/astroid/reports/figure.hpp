// Figures drawn by gnuplot, with the script and the numbers beside them so that anybody can draw them again.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace astroid {

/// A figure before it is drawn.
struct Figure {
  std::string name;     ///< stem of its files: name.gp, name.png, name.svg, name.pdf
  std::string title;    ///< for the report
  std::string caption;  ///< plain text: what is shown, and how to read it
  int width = 900;      ///< px at 96 dpi
  int height = 560;
  std::vector<std::pair<std::string, std::string>> data;  ///< files beside the script: name and content
  std::string commands;  ///< gnuplot, between `set output` and the end; run once for each format
};

/// The colours of all figures: few, quiet, and told apart also by the colour-blind.
namespace palette {
inline constexpr const char* kInk = "#1f2933";
inline constexpr const char* kMuted = "#7b8794";
inline constexpr const char* kMeasured = "#2f6690";   ///< blue
inline constexpr const char* kPredicted = "#c8553d";  ///< rust
inline constexpr const char* kRequirement = "#1f2933";
inline constexpr const char* kEqual = "#2b9348";         ///< green, the line of equality
inline constexpr const char* kContaminated = "#e09f3e";  ///< amber
inline constexpr const char* kSaturated = "#9b2226";     ///< dark red
inline constexpr const char* kPhoton = "#5fa8d3";
inline constexpr const char* kBackground = "#8ab17d";
inline constexpr const char* kReadout = "#8e7dbe";
inline constexpr const char* kQuantisation = "#b8b8b8";
inline constexpr const char* kJitter = "#c76b98";
}  // namespace palette

/// The gnuplot script of a figure: complete, run as `gnuplot name.gp` in its folder.
std::string figure_script(const Figure& figure);

/// Writes the data and the scripts into `folder` and draws each figure as PNG, SVG and PDF, `threads` at a time
/// (< 1: as many as the process may run).
///
/// @returns what went wrong, in words for the report; empty when every figure was drawn. Without gnuplot, one entry.
/// @throws EnvironmentError when data or scripts cannot be written.
std::vector<std::string> draw_figures(const std::filesystem::path& folder, std::span<const Figure> figures,
                                      int threads = 0);

/// True if gnuplot can be started.
bool have_gnuplot();

/// Text inside a double-quoted gnuplot string with enhanced text: quotes, backslashes and markup are made harmless.
std::string gnuplot_text(const std::string& text);

}  // namespace astroid
