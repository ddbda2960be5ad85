#include "astroid/test/python.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "astroid/test/temporary_folder.hpp"

namespace astroid::test {

namespace {

// Debian's own interpreter: one of the user's first in PATH rarely has Debian's modules.
constexpr const char* kPython = "/usr/bin/python3";

std::string shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

int run(const std::string& command, std::string& output) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 4096> buffer{};
  std::size_t n = 0;
  while ((n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) output.append(buffer.data(), n);
  return pclose(pipe);
}

}  // namespace

bool python_has(const std::vector<std::string>& modules) {
  std::string code;
  for (const std::string& module : modules) code += "import " + module + "\n";
  std::string output;
  return run(std::string(kPython) + " -c " + shell_word(code) + " 2>/dev/null", output) == 0;
}

std::string run_python(const std::filesystem::path& script, const std::vector<std::string>& arguments) {
  std::string command = std::string(kPython) + " " + shell_word(script.string());
  for (const std::string& argument : arguments) command += " " + shell_word(argument);
  // Warnings go to a file of their own: mixed into the output they could fall anywhere.
  const TemporaryFolder folder;
  const std::filesystem::path errors = folder.write("errors.txt", "");
  std::string output;
  if (run(command + " 2>" + shell_word(errors.string()), output) != 0) {
    std::ifstream file(errors);
    std::ostringstream text;
    text << file.rdbuf();
    throw std::runtime_error(script.string() + " failed:\n" + output + text.str());
  }
  return output;
}

}  // namespace astroid::test
