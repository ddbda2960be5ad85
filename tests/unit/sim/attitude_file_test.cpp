#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "astroid/core/error.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

SimulationSettings two_exposures() {
  SimulationSettings s;
  s.exposures = 2;
  s.cycle = Seconds(10.0);
  s.exposure_time = Seconds(8.0);
  return s;
}

TEST(AttitudeFile, IsLinearBetweenItsSamples) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("attitude.csv", "time_s,yaw,pitch,roll\n0,0,0,1\n10,1,0,1\n20,1,-2,1\n");
  const auto model = make_file_attitude(path.string(), two_exposures());
  const std::vector<Attitude> a = model->sample(2, 2);
  ASSERT_EQ(a.size(), 4U);
  EXPECT_NEAR(a[0].yaw, 0.2, 1e-15);
  EXPECT_NEAR(a[1].yaw, 0.6, 1e-15);
  EXPECT_NEAR(a[2].pitch, -0.4, 1e-15);
  EXPECT_NEAR(a[3].pitch, -1.2, 1e-15);
  EXPECT_NEAR(a[3].roll, 1.0, 1e-15);
}

TEST(AttitudeFile, ListsEveryBadLine) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("attitude.csv", "time_s,yaw,pitch,roll\n0,0,0,x\n10,nan,0,0\n5,0,0,0\n5,0,0,0\n");
  try {
    make_file_attitude(path.string(), two_exposures());
    FAIL() << "a bad file was accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 3U);
    EXPECT_EQ(error.problems()[0].line, 2);
    EXPECT_EQ(error.problems()[1].line, 3);
    EXPECT_EQ(error.problems()[2].line, 5);
    EXPECT_THAT(error.problems()[2].message, testing::HasSubstr("does not increase"));
  }
}

TEST(AttitudeFile, MustCoverTheRun) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("attitude.txt", "0 0 0 0\n17.9 0 0 0\n");
  EXPECT_THROW(make_file_attitude(path.string(), two_exposures()), InputError);
  const auto long_enough = folder.write("long.txt", "0 0 0 0\n18 0 0 0\n");
  EXPECT_NO_THROW(make_file_attitude(long_enough.string(), two_exposures()));
}

}  // namespace
}  // namespace astroid
