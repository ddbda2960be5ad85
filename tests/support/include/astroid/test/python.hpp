// Debian's Python as an independent reader and oracle (python3-astropy, python3-sep, …); tests skip where it is absent.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace astroid::test {

/// Whether the system's Python can import all of `modules` ("numpy", "sep", …).
bool python_has(const std::vector<std::string>& modules);

/// Runs a script with arguments and returns what it printed. @throws std::runtime_error when it fails.
std::string run_python(const std::filesystem::path& script, const std::vector<std::string>& arguments);

}  // namespace astroid::test
