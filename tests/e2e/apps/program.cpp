#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "astroid/core/product_folder.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid::test {

namespace {

constexpr int kCannotStart = 127;  // as shells say it
constexpr int kSignalled = 128;

[[noreturn]] void become(std::vector<char*>& words, const std::filesystem::path& folder,
                         const std::filesystem::path& out, const std::filesystem::path& err) {
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(out_file, STDOUT_FILENO) < 0 || ::dup2(err_file, STDERR_FILENO) < 0)
    ::_exit(kCannotStart);
  if (::chdir(folder.c_str()) != 0) ::_exit(kCannotStart);
  ::execvp(words[0], words.data());
  ::_exit(kCannotStart);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& command, const std::filesystem::path& folder) {
  const TemporaryFolder scratch;
  const std::filesystem::path out = scratch.path() / "out";
  const std::filesystem::path err = scratch.path() / "err";
  std::vector<std::string> copies = command;
  std::vector<char*> words;
  for (std::string& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) become(words, folder, out, err);
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("lost a child process");
  ProgramResult result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
  if (result.exit_code == kCannotStart) throw std::runtime_error("cannot start " + command.front());
  result.out = read_file(out);
  result.err = read_file(err);
  return result;
}

ProgramResult run_astroid(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return run_astroid_through({}, arguments, folder);
}

ProgramResult run_astroid_through(const std::vector<std::string>& runner, const std::vector<std::string>& arguments,
                                  const std::filesystem::path& folder) {
  ::setenv("SOURCE_DATE_EPOCH", "1800000000", 1);
  ::setenv("ASTROID_COSTS", "/nonexistent/costs.json", 1);  // predicted times are those of any machine
  std::vector<std::string> command = runner;
  command.emplace_back(ASTROID_PROGRAM);
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command, folder);
}

bool has_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!std::filesystem::exists(folder)) return names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(folder).generic_string());
  std::ranges::sort(names);
  return names;
}

std::size_t expect_same_products(const std::filesystem::path& run, const std::filesystem::path& other,
                                 const std::vector<std::string>& parts) {
  const std::vector<std::string> files = files_below(run);
  EXPECT_EQ(files, files_below(other)) << other;
  std::size_t compared = 0;
  for (const std::string& file : files) {
    if (file == "run.json" || file.starts_with("report/figures/") || !std::filesystem::exists(other / file)) continue;
    if (std::ranges::none_of(parts, [&](const std::string& part) { return file.starts_with(part); })) continue;
    EXPECT_EQ(sha256_of_file(run / file), sha256_of_file(other / file)) << file << " in " << run << " and " << other;
    ++compared;
  }
  return compared;
}

}  // namespace astroid::test
