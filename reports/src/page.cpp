#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "html.hpp"

namespace astroid {

namespace {

/// Vector graphics in the page where they are small enough for a browser, else the bitmap.
constexpr std::uintmax_t kLargestSvg = 400'000;  // bytes

std::string warnings_box(const PageContent& content) {
  std::vector<std::string> all = content.input->warnings;
  all.insert(all.end(), content.problems.begin(), content.problems.end());
  if (all.empty()) return {};
  std::string out = "<div class=\"warnings\" role=\"note\"><b>Notes and warnings</b><ul>";
  for (const std::string& warning : all) out += "<li>" + html::escape(warning) + "</li>";
  return out + "</ul></div>\n";
}

}  // namespace

std::string bin_text(double hours) {
  constexpr double kSecondsPerHour = 3600.0;
  return hours >= 1.0 ? fmt::format("{:g} h", hours) : fmt::format("{:g} s", hours * kSecondsPerHour);
}

std::string figure_block(const PageContent& content, const std::string& name) {
  const auto figure =
      std::find_if(content.figures.begin(), content.figures.end(), [&name](const Figure& f) { return f.name == name; });
  if (figure == content.figures.end()) return {};
  std::error_code error;
  const auto file = [&](const char* ending) { return content.figure_folder / (name + ending); };
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [text, ending] :
       std::array<std::pair<const char*, const char*>, 3>{{{"PNG", ".png"}, {"SVG", ".svg"}, {"PDF", ".pdf"}}}) {
    if (std::filesystem::exists(file(ending), error)) files.emplace_back(text, "figures/" + name + ending);
  }
  std::string picture;
  const auto svg_size = std::filesystem::file_size(file(".svg"), error);
  const bool svg = !error && svg_size > 0 && svg_size <= kLargestSvg;
  if (svg || std::filesystem::exists(file(".png"), error)) {
    picture =
        fmt::format("<img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\">",
                    svg ? html::data_uri(file(".svg"), "image/svg+xml") : html::data_uri(file(".png"), "image/png"),
                    html::escape(figure->title + ". " + figure->caption), figure->width, figure->height);
  }
  constexpr std::size_t kMostLinks = 4;
  if (figure->data.size() > kMostLinks) {
    files.emplace_back(fmt::format("data ({} files)", figure->data.size()), "figures/");
  } else {
    for (const auto& [data, text] : figure->data) files.emplace_back(data, "figures/" + data);
  }
  files.emplace_back("gnuplot", "figures/" + name + ".gp");
  return fmt::format("<figure{}>{}<figcaption>{} {}</figcaption></figure>\n", name == "image" ? " class=\"small\"" : "",
                     picture, html::escape(figure->caption), html::links(files));
}

std::string page(const PageContent& content) {
  const ReportInput& input = *content.input;
  const std::vector<std::pair<std::string, std::string>> sections{
      {"noise", noise_section(content)},
      {"recovery", recovery_section(content)},
      {"contamination", contamination_section(content)},
      {"budget", budget_section(content)},
      {"images", exposure_section(content)},
      {"flags", flags_section(content)},
      {"plan", plan_section(content)},
      {"configuration", configuration_section(content)},
      {"provenance", provenance_section(content)},
  };
  std::string navigation;
  std::string body;
  for (const auto& [anchor, text] : sections) {
    if (text.empty()) continue;
    std::string name = anchor;
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    navigation += fmt::format("<a href=\"#{}\">{}</a>", anchor, name);
    body += text;
  }
  const std::string title = html::escape(input.title);
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  out += "<title>" + title + " – ASTROID report</title>\n<style>" + page_style() +
         "</style>\n</head>\n<body>\n<div class=\"page\">\n";
  out += "<header><p class=\"kind\">ASTROID report</p><h1>" + title + "</h1></header>\n";
  out += "<nav aria-label=\"Sections\">" + navigation + "</nav>\n";
  out += verdict_section(content) + warnings_box(content) + body;
  out +=
      "<footer>Tables as CSV in <a href=\"../analysis/\">analysis/</a>; units and meaning of every column in "
      "<a href=\"columns.md\">columns.md</a>; every figure with its data and gnuplot script in <a "
      "href=\"figures/\">figures/</a>.</footer>\n";
  out += "</div>\n</body>\n</html>\n";
  return out;
}

}  // namespace astroid
