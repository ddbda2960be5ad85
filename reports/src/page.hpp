// The page report/index.html.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/noise_vs_magnitude.hpp"
#include "astroid/analysis/recovery.hpp"
#include "astroid/reports/figure.hpp"
#include "astroid/reports/report.hpp"

namespace astroid {

/// What the page shows besides the input.
struct PageContent {
  const ReportInput* input = nullptr;
  std::span<const NoiseBin> noise;
  std::span<const RecoveryBin> recovery;
  std::span<const Figure> figures;
  std::filesystem::path figure_folder;  ///< where they were drawn; those that are missing are left out
  std::vector<std::string> problems;
};

/// The whole page, self-contained: style and pictures are in it; only links lead to files beside it.
std::string page(const PageContent& content);

/// The page's style sheet.
std::string page_style();

// Sections; each empty when there is nothing to show.
std::string verdict_section(const PageContent& content);
std::string noise_section(const PageContent& content);
std::string recovery_section(const PageContent& content);
std::string contamination_section(const PageContent& content);
std::string budget_section(const PageContent& content);
std::string flags_section(const PageContent& content);
std::string exposure_section(const PageContent& content);
std::string plan_section(const PageContent& content);
std::string configuration_section(const PageContent& content);
std::string provenance_section(const PageContent& content);

/// <figure> of that name with its caption and links, or nothing if it was not made.
std::string figure_block(const PageContent& content, const std::string& name);
/// "1 h" or "600 s".
std::string bin_text(double hours);

}  // namespace astroid
