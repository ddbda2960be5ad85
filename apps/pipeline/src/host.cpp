#include "host.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>

namespace astroid {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::string processor_name() {
  FILE* file = std::fopen("/proc/cpuinfo", "r");
  if (file == nullptr) return "unknown";
  std::array<char, 512> line{};
  std::string name = "unknown";
  while (std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr) {
    const std::string text = line.data();
    if (!text.starts_with("model name")) continue;
    const std::size_t colon = text.find(':');
    if (colon != std::string::npos) name = text.substr(colon + 2, text.size() - colon - 3);
    break;
  }
  std::fclose(file);
  return name;
}

}  // namespace astroid
