// What is wrong with the user's input is said in full, with exit code 2, and nothing is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "astroid/core/product_folder.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class BadInput : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }

  /// Runs a command that must be refused with exit code 2, without a word on standard output and without any new file.
  /// @returns what was said on standard error
  std::string refused(const std::vector<std::string>& arguments) {
    const std::vector<std::string> before = everything();
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_EQ(everything(), before) << "nothing may be written";
    return run.err;
  }

  /// small.xml with `from` replaced by `to`, as another file.
  void write_changed(const std::string& name, const std::vector<std::pair<std::string, std::string>>& changes) {
    std::string text = test::read_file(folder_.path() / "small.xml");
    for (const auto& [from, to] : changes) {
      ASSERT_NE(text.find(from), std::string::npos) << from;
      text.replace(text.find(from), from.size(), to);
    }
    folder_.write(name, text);
  }

  std::vector<std::string> everything() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
      names.push_back(entry.path().string());
    std::ranges::sort(names);
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(BadInput, AWrongConfigurationGetsAllItsProblemsListedWithTheirLines) {
  write_changed("bad.xml", {{"<Gain unit=\"e-/ADU\">25</Gain>", "<Gian unit=\"e-/ADU\">25</Gian>"},
                            {"<Rows>100<", "<Rows>-5<"},
                            {"<PRNU unit=\"%\">1<", "<PRNU unit=\"furlong\">1<"},
                            {"stars.csv", "absent.csv"}});
  for (const char* command : {"assess", "simulate", "plan", "validate", "budget"}) {
    std::vector<std::string> arguments{command, "bad.xml"};
    if (std::string(command) == "budget") arguments.emplace_back("--analytic");
    const std::string said = refused(arguments);
    EXPECT_THAT(said, AllOf(HasSubstr("4 problems in the input"), HasSubstr("bad.xml:24: "), HasSubstr("absent.csv"),
                            HasSubstr("bad.xml:29: "), HasSubstr("-5"), HasSubstr("bad.xml:34: "), HasSubstr("furlong"),
                            HasSubstr("bad.xml:36: "), HasSubstr("did you mean")))
        << command;
    EXPECT_THAT(said, HasSubstr("Gain")) << command;
  }
}

TEST_F(BadInput, ABrokenXmlFileIsRefusedWithItsLine) {
  write_changed("broken.xml", {{"</Rows>", "</Row>"}});
  EXPECT_THAT(refused({"assess", "broken.xml"}), HasSubstr("broken.xml:29: not well-formed XML"));
}

TEST_F(BadInput, AWrongOverrideIsRefused) {
  EXPECT_THAT(refused({"assess", "small.xml", "--set", "CCD/Gian=3"}),
              AllOf(HasSubstr("--set"), HasSubstr("CCD/Gian"), HasSubstr("CCD/Gain")));
  EXPECT_THAT(refused({"assess", "small.xml", "--set", "CCD/Gain"}), HasSubstr("CCD/Gain"));
  EXPECT_THAT(refused({"assess", "small.xml", "--set", "CCD/Gain=-3"}), HasSubstr("-3"));
}

TEST_F(BadInput, AnUnknownOptionOrCommandIsRefused) {
  EXPECT_THAT(refused({"asess", "small.xml"}), AllOf(HasSubstr("asess"), HasSubstr("assess, simulate")));
  EXPECT_THAT(refused({"assess", "small.xml", "--exposures", "3"}), HasSubstr("--exposures"));
  EXPECT_THAT(refused({"--frobnicate"}), HasSubstr("--frobnicate"));
  EXPECT_THAT(refused({"assess"}), HasSubstr("CONFIG"));
  EXPECT_THAT(refused({"assess", "small.xml", "--threads", "many"}), HasSubstr("--threads"));
  EXPECT_THAT(refused({"assess", "small.xml", "--threads", "0"}), HasSubstr("--threads"));
  EXPECT_THAT(refused({"plan", "small.xml", "--seed", "-4"}), AllOf(HasSubstr("--seed"), HasSubstr("-4")));
  EXPECT_THAT(refused({"field", "--radius", "1", "--number", "9", "--seed", "-4", "-o", "field.csv"}),
              AllOf(HasSubstr("--seed"), HasSubstr("-4")));
  EXPECT_THAT(refused({}), HasSubstr("command"));
}

TEST_F(BadInput, AMissingFileIsRefusedByItsName) {
  EXPECT_THAT(refused({"assess", "absent.xml"}), HasSubstr("absent.xml"));
  EXPECT_THAT(refused({"assess", "platon"}), AllOf(HasSubstr("platon"), HasSubstr("plato")));
  EXPECT_THAT(refused({"init", "platon"}), HasSubstr("plato"));
  EXPECT_THAT(refused({"photometry", "absent.fits", "other.fits", "--catalogue", "stars.csv"}),
              AllOf(HasSubstr("absent.fits"), HasSubstr("other.fits")));
  EXPECT_THAT(refused({"analyse", "absent"}), HasSubstr("absent: there is no such folder"));
  EXPECT_THAT(refused({"analyse", "--truth", "absent.csv", "--sources", "stars.csv", "-o", "result"}),
              HasSubstr("absent.csv"));
  EXPECT_THAT(refused({"analyse"}), AllOf(HasSubstr("--truth"), HasSubstr("--sources")));
  EXPECT_THAT(refused({"field", "--extend", "absent.csv", "-o", "field.csv"}), HasSubstr("absent.csv"));
  folder_.write("image.fits", "");
  EXPECT_THAT(refused({"photometry", "image.fits", "--catalogue", "absent.csv"}), HasSubstr("absent.csv"));
}

TEST_F(BadInput, ABrokenCatalogueGetsEveryWrongCellListed) {
  folder_.write("bad.csv", "id,ra,dec,mag\na,95.31,-47.88,10\nb,east,-47.9,11\nc,95.3,-147.9,nan\n");
  EXPECT_THAT(refused({"assess", "small.xml", "--set", "StellarField/Catalogue=bad.csv"}),
              AllOf(HasSubstr("3 problems"), HasSubstr("bad.csv:3: column ra = east"),
                    HasSubstr("bad.csv:4: column dec = -147.9"), HasSubstr("bad.csv:4: column mag = nan")));
  folder_.write("empty.csv", "");
  EXPECT_THAT(refused({"plan", "small.xml", "--set", "StellarField/Catalogue=empty.csv"}), HasSubstr("empty.csv"));
  folder_.write("columns.csv", "name,where\nx,there\n");
  EXPECT_THAT(refused({"simulate", "small.xml", "--set", "StellarField/Catalogue=columns.csv"}),
              HasSubstr("columns.csv"));
}

TEST_F(BadInput, AFieldWithoutTargetsIsRefused) {
  EXPECT_THAT(refused({"assess", "small.xml", "--set", "Satellite/Pointing/Dec=10"}), HasSubstr("no target"));
}

TEST_F(BadInput, AnAttitudeFileThatIsTooShortIsRefused) {
  folder_.write("attitude.csv", "time_s,yaw,pitch,roll\n0,0,0,0\n10,0.1,0,0\n");
  EXPECT_THAT(
      refused({"assess", "small.xml", "--set", "Satellite/Jitter/model=file", "--set",
               "Satellite/Jitter/File=attitude.csv"}),
      AllOf(HasSubstr("attitude.csv"), HasSubstr("from 0 to 10 s do not cover the run"), HasSubstr("from 0 to 146 s")));
}

TEST_F(BadInput, AnImageThatIsNoFitsOrCutShortIsRefused) {
  folder_.write("garbage.fits", "This is no image.");
  EXPECT_THAT(refused({"photometry", "garbage.fits", "--catalogue", "stars.csv"}),
              HasSubstr("garbage.fits: is not a FITS file"));
  ASSERT_EQ(test::run_astroid({"simulate", "small.xml", "-o", "run"}, folder_.path()).exit_code, 0);
  const std::string image = test::read_file(folder_.path() / "run/images/camera1_000000.fits");
  folder_.write("header.fits", image.substr(0, 3000));
  EXPECT_THAT(refused({"photometry", "header.fits", "--catalogue", "stars.csv"}),
              HasSubstr("header.fits: is truncated"));
  folder_.write("pixels.fits", image.substr(0, image.size() - 2 * 2880));
  EXPECT_THAT(refused({"photometry", "pixels.fits", "--catalogue", "stars.csv"}),
              HasSubstr("pixels.fits: is truncated"));
  folder_.write("empty.fits", "");
  EXPECT_THAT(refused({"photometry", "empty.fits", "--catalogue", "stars.csv"}), HasSubstr("empty.fits: is empty"));
}

TEST_F(BadInput, ProductsThatAreThereAreLeftAlone) {
  ASSERT_EQ(test::run_astroid({"simulate", "small.xml", "-o", "run"}, folder_.path()).exit_code, 0);
  const std::string image = "run/images/camera1_000000.fits";
  const std::string before = sha256_of_file(folder_.path() / image);
  EXPECT_THAT(refused({"simulate", "small.xml", "-o", "run", "--seed", "5"}), HasSubstr("--overwrite"));
  EXPECT_THAT(refused({"assess", "small.xml", "-o", "run"}), HasSubstr("--overwrite"));
  EXPECT_EQ(sha256_of_file(folder_.path() / image), before);

  const std::string stars = test::read_file(folder_.path() / "stars.csv");
  EXPECT_THAT(refused({"photometry", image, "--catalogue", "stars.csv", "-o", "stars.csv"}), HasSubstr("--overwrite"));
  EXPECT_THAT(refused({"field", "--ra", "1", "--radius", "1", "--number", "9", "-o", "stars.csv"}),
              HasSubstr("--overwrite"));
  EXPECT_THAT(refused({"budget", "small.xml", "--analytic", "-o", "stars.csv"}), HasSubstr("--overwrite"));
  EXPECT_THAT(refused({"init", "plato", "-o", "small.xml"}), HasSubstr("--overwrite"));
  EXPECT_EQ(test::read_file(folder_.path() / "stars.csv"), stars);
}

TEST_F(BadInput, AFolderThatNoRunWroteIsNotOverwritten) {
  folder_.write("thesis/chapter1.tex", "important");
  EXPECT_THAT(refused({"assess", "small.xml", "-o", "thesis", "--overwrite"}), HasSubstr("run.json"));
  EXPECT_EQ(test::read_file(folder_.path() / "thesis/chapter1.tex"), "important");
}

TEST_F(BadInput, AStarOrFieldThatCannotBeIsNamedInTheUsersWords) {
  EXPECT_THAT(refused({"field", "--ra", "95", "--radius", "1", "-o", "field.csv"}),
              AllOf(HasSubstr("--number"), HasSubstr("--density")));
  EXPECT_THAT(refused({"field", "--radius", "1", "--number", "5", "--faint", "3", "-o", "field.csv"}),
              HasSubstr("--faint"));
  EXPECT_THAT(refused({"field", "--number", "5", "-o", "field.csv"}),
              AllOf(HasSubstr("--radius"), HasSubstr("region")));
  EXPECT_THAT(refused({"explain", "CCD/Gian"}), HasSubstr("CCD/Gain"));
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "run"}, folder_.path()).exit_code, 0);
  EXPECT_THAT(refused({"analyse", "run", "--export", "star3,nosuch", "-o", "single"}), HasSubstr("nosuch"));
  EXPECT_THAT(refused({"photometry", "run/images/camera1_000000.fits", "--catalogue", "stars.csv", "--method", "mask"}),
              HasSubstr("--psf"));
  EXPECT_THAT(
      refused({"photometry", "run/images/camera1_000000.fits", "--catalogue", "stars.csv", "--background", "dark"}),
      HasSubstr("--background = dark"));
}

}  // namespace
}  // namespace astroid
