#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/worker_pool.hpp"
#include "astroid/reports/figure.hpp"

namespace astroid {

namespace {

constexpr int kNotStarted = -1;
constexpr int kCommandNotFound = 127;

/// Runs gnuplot with its arguments in `folder`, all it says going to `log`; its exit code, or kNotStarted.
int run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                const std::string& log) {
  std::vector<std::string> words{"gnuplot"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "gnuplot", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return kNotStarted;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return kNotStarted;
  }
  if (!WIFEXITED(status)) return WTERMSIG(status) + 128;
  return WEXITSTATUS(status) == kCommandNotFound ? kNotStarted : WEXITSTATUS(status);
}

std::string first_complaint(const std::filesystem::path& log) {
  std::error_code error;
  if (!std::filesystem::exists(log, error)) return {};
  const std::string text = read_text_file(log);
  std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return {};
  // gnuplot prints the line and a caret before the sentence: the last line is the sentence.
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  begin = text.find_last_of('\n', end);
  begin = begin == std::string::npos ? 0 : begin + 1;
  return text.substr(begin, end + 1 - begin);
}

/// Draws one figure; says what went wrong, or nothing.
std::string draw(const std::filesystem::path& folder, const Figure& figure) {
  const std::string log = figure.name + ".log";
  const int code = run_gnuplot(folder, {figure.name + ".gp"}, log);
  std::string problem;
  if (code != 0) {
    problem = fmt::format("figure {} was not drawn: gnuplot ended with code {}: {}", figure.name, code,
                          first_complaint(folder / log));
  }
  for (const char* format : {".png", ".svg", ".pdf"}) {
    std::error_code error;
    const auto size = std::filesystem::file_size(folder / (figure.name + format), error);
    if (problem.empty() && (error || size == 0)) {
      problem = fmt::format("figure {}{} is missing: gnuplot lacks that terminal", figure.name, format);
    }
  }
  std::error_code ignored;
  std::filesystem::remove(folder / log, ignored);
  return problem;
}

}  // namespace

std::string figure_script(const Figure& figure) {
  std::string script = fmt::format(
      "# {}\n# Draw it again, in this folder:  gnuplot {}.gp\n"
      "set encoding utf8\n"
      "set datafile separator comma\n"
      "set datafile missing \"nan\"\n"
      "do for [format in \"png svg pdf\"] {{\n"
      "  if (format eq \"png\") {{ set terminal pngcairo size {},{} fontscale 2 linewidth 2 pointscale 2 font \"DejaVu "
      "Sans,10\" background \"#ffffff\" }}\n"
      "  if (format eq \"svg\") {{ set terminal svg size {},{} dynamic linewidth 1.25 font \"DejaVu Sans,13\" "
      "background \"#ffffff\" "
      "}}\n"
      "  if (format eq \"pdf\") {{ set terminal pdfcairo size {:.3f}in,{:.3f}in font \"DejaVu Sans,10\" background "
      "\"#ffffff\" }}\n"
      "  set output \"{}.\".format\n",
      figure.title, figure.name, 2 * figure.width, 2 * figure.height, figure.width, figure.height, figure.width / 96.0,
      figure.height / 96.0, figure.name);
  script += fmt::format(
      "  set border 3 linecolor rgb \"{0}\" linewidth 0.8\n"
      "  set tics nomirror out scale 0.6 textcolor rgb \"{1}\"\n"
      "  set grid xtics ytics linetype 1 linecolor rgb \"#e6e9ed\" linewidth 0.6\n"
      "  set key textcolor rgb \"{1}\" samplen 2 spacing 1.15 noenhanced\n"
      "  set xlabel textcolor rgb \"{1}\"\n  set ylabel textcolor rgb \"{1}\"\n"
      "  set style fill transparent solid 0.35 noborder\n",
      "#9aa5b1", palette::kInk);
  script += figure.commands;
  script += "  unset output\n  reset\n  set datafile separator comma\n  set datafile missing \"nan\"\n}\n";
  return script;
}

bool have_gnuplot() {
  const std::filesystem::path temporary = std::filesystem::temp_directory_path();
  return run_gnuplot(temporary, {"--version"}, "/dev/null") == 0;
}

std::vector<std::string> draw_figures(const std::filesystem::path& folder, std::span<const Figure> figures,
                                      int threads) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw EnvironmentError(folder.string(), error.message());
  for (const Figure& figure : figures) {
    for (const auto& [name, content] : figure.data) write_text_file(folder / name, content);
    write_text_file(folder / (figure.name + ".gp"), figure_script(figure));
  }
  if (figures.empty()) return {};
  if (!have_gnuplot()) {
    return {
        "the figures were not drawn because gnuplot could not be started; their scripts and data are in report/figures "
        "(Debian: apt install gnuplot-nox, then `gnuplot NAME.gp` there)"};
  }
  std::vector<std::string> problems(figures.size());
  parallel_for(threads, figures.size(),
               [&](std::size_t /*worker*/, std::size_t i) { problems[i] = draw(folder, figures[i]); });
  std::erase(problems, std::string());
  return problems;
}

std::string gnuplot_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "''";
        break;
      case '\\':
      case '`':
      case '\n':
      case '\r':
        out += ' ';
        break;
      case '_':
      case '^':
      case '{':
      case '}':
      case '@':
      case '&':
      case '~':
        out += "\\\\";  // an escaped backslash in the string, which takes the markup from what follows
        out += c;
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace astroid
