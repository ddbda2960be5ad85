// A full disk or a folder that cannot be written: exit code 3, the path and the cause, and no product by its name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A file system in memory of a given size, for as long as this lives. Only root may make one.
class SmallDisk {
 public:
  SmallDisk(std::filesystem::path folder, const std::string& size) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
    mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    if (!mounted_) why_ = std::strerror(errno);
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  std::filesystem::path folder_;
  bool mounted_ = false;
  std::string why_;
};

class Disk : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  test::TemporaryFolder folder_;
};

// The sizes stop a run at its images, at the data of its report, and at its page.
TEST_F(Disk, ThatIsFullEndsARunWithThePathAndTheCauseAndNoProduct) {
  for (const char* size : {"40k", "300k", "900k"}) {
    const SmallDisk disk(folder_.path() / "disk", size);
    if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small file system: " << disk.why();
    const test::ProgramResult run =
        test::run_astroid({"assess", "small.xml", "-o", "disk/result", "--set", "Output/Images=all"}, folder_.path());
    EXPECT_EQ(run.exit_code, 3) << size << ": " << run.err;
    EXPECT_THAT(run.out, IsEmpty()) << size;
    EXPECT_THAT(run.err, AllOf(HasSubstr("disk/result"), HasSubstr("No space left on device"))) << size;
    EXPECT_EQ(test::lines_of(run.err).size(), 1U) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "disk/result")) << size;
  }
}

TEST_F(Disk, ThatIsFullLeavesNoHalfWrittenTable) {
  ASSERT_EQ(test::run_astroid({"simulate", "small.xml", "-o", "run"}, folder_.path()).exit_code, 0);
  const SmallDisk disk(folder_.path() / "disk", "4k");
  if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small file system: " << disk.why();
  const std::vector<std::vector<std::string>> commands{
      {"field", "--radius", "1", "--number", "3000", "-o", "disk/field.csv"},
      {"budget", "small.xml", "--analytic", "--step", "0.05", "-o", "disk/budget.csv"},
      {"photometry", "run/images/camera1_000000.fits", "--catalogue", "run/truth/stars.csv", "-o", "disk/sources.csv"},
      {"init", "plato", "-o", "disk/plato.xml"}};
  for (const auto& command : commands) {
    const test::ProgramResult run = test::run_astroid(command, folder_.path());
    EXPECT_EQ(run.exit_code, 3) << command[0] << ": " << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr(command.back()), HasSubstr("No space left on device"))) << command[0];
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / command.back())) << command[0];
    for (const std::string& file : test::files_below(folder_.path() / "disk"))
      std::filesystem::remove(folder_.path() / "disk" / file);
  }
}

TEST_F(Disk, ThatCannotBeWrittenEndsARunBeforeItBegins) {
  const auto refused = [&](const std::string& where, const char* cause) {
    const test::ProgramResult run = test::run_astroid({"assess", "small.xml", "-o", where}, folder_.path());
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_THAT(run.err, AllOf(HasSubstr(where), HasSubstr(cause)));
  };
  refused("stars.csv/result", "Not a directory");
  refused("/proc/result", "No such file or directory");
  const test::ProgramResult run =
      test::run_astroid({"field", "--radius", "1", "--number", "30", "-o", "no/such/folder/field.csv"}, folder_.path());
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("no/such/folder/field.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "no"));
}

TEST_F(Disk, ThatIsReadOnlyEndsARunWithThePathAndTheCause) {
  const SmallDisk disk(folder_.path() / "disk", "1m");
  if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small file system: " << disk.why();
  const std::string place = (folder_.path() / "disk").string();
  if (::mount("tmpfs", place.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) != 0)
    GTEST_SKIP() << "cannot mount read-only: " << std::strerror(errno);
  const test::ProgramResult run = test::run_astroid({"simulate", "small.xml", "-o", "disk/result"}, folder_.path());
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("disk/result"), HasSubstr("Read-only file system")));
}

}  // namespace
}  // namespace astroid
