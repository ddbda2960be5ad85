// What the tests of the configuration share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid::test {

inline constexpr const char* kPlatoCatalogue = "catalogues/data/tycho2_lops2_8deg.csv";

inline constexpr const char* kPlatoBackground = "catalogues/data/lops2_faint_synthetic.csv";

inline std::filesystem::path cmos_preset() {
  return source_dir() / "apps/missions/cmos.xml";
}

inline std::filesystem::path plato_preset() {
  return source_dir() / "apps/missions/plato.xml";
}

inline std::filesystem::path week_preset() {
  return source_dir() / "apps/missions/plato-week.xml";
}

inline std::filesystem::path groups_preset() {
  return source_dir() / "apps/missions/plato-groups.xml";
}

/// A data folder with (empty) files where the PLATO preset looks for its catalogues, and one `stars.csv`.
class FolderWithCatalogue {
 public:
  FolderWithCatalogue() {
    std::filesystem::create_directories(folder_.path() / "catalogues/data");
    folder_.write(kPlatoCatalogue, "ra,dec,mag\n");
    folder_.write(kPlatoBackground, "ra,dec,mag\n");
    folder_.write("stars.csv", "ra,dec,mag\n");
  }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }

 private:
  TemporaryFolder folder_;
};

/// The least a configuration must say, with `more` inserted before the end.
inline std::string minimal_xml(const std::string& more = "") {
  return "<Astroid version=\"1\">\n"
         "<Satellite><Pointing><RA unit=\"deg\">10</RA><Dec unit=\"deg\">-5</Dec></Pointing></Satellite>\n"
         "<StellarField><Catalogue>stars.csv</Catalogue></StellarField>\n"
         "<CCD><Columns>100</Columns><Rows>80</Rows></CCD>\n" +
         more + "</Astroid>\n";
}

/// Reads a text whose files are in `data`.
inline ResolvedConfiguration read_text(const std::string& xml, const FolderWithCatalogue& data,
                                       const std::vector<std::string>& overrides = {}) {
  return read_configuration_text(xml, "test.xml", data.path(), {.overrides = overrides, .data_folders = {}});
}

/// The text of the InputError of a reading, or "no error".
template <class Reading>
std::string problems_of(const Reading& reading) {
  try {
    (void)reading();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace astroid::test
