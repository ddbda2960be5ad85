// Files of power spectral densities: what is read, and every message.
#include "astroid/sim/jitter_spectrum.hpp"

#include <gtest/gtest.h>

#include <string>

#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

std::string problems_of(const std::string& text) {
  const test::TemporaryFolder folder;
  try {
    (void)read_jitter_spectrum(folder.write("psd.csv", text).string());
  } catch (const InputError& error) {
    std::string all;
    for (const Problem& p : error.problems())
      all += std::to_string(p.line) + ": " + p.parameter + (p.value.empty() ? "" : " = " + p.value) + ": " + p.message +
             "; ";
    return all;
  }
  return "no error";
}

TEST(JitterSpectrumFile, IsRead) {
  const test::TemporaryFolder folder;
  const JitterSpectrum s = read_jitter_spectrum(
      folder.write("psd.csv", "frequency_hz,yaw,pitch,roll\n1e-3,1,2,0\n1e-2,1,0.2,0\n1,1,0.002,0\n").string());
  EXPECT_EQ(s[0].lowest(), 1e-3);
  EXPECT_EQ(s[0].highest(), 1.0);
  EXPECT_NEAR(s[0].power(), 0.999, 1e-12);
  EXPECT_NEAR(s[1].density(0.1), 0.02, 1e-12);  // 1/f throughout
  EXPECT_EQ(s[2].power(), 0.0);
}

TEST(JitterSpectrumFile, WithoutAHeaderHasItsColumnsInOrder) {
  EXPECT_EQ(problems_of("0.001 1 2 3\n0.1 1 2 3\n"), "no error");
}

TEST(JitterSpectrumFile, IsRefusedWithEveryProblem) {
  EXPECT_EQ(problems_of("frequency_hz,yaw,roll\n1,1,1\n2,1,1\n"), "1: column pitch: the column is missing; ");
  EXPECT_EQ(problems_of("frequency_hz,yaw,pitch,roll\n0,1,1,1\n1,-1,1,x\n1,1,-1,1\n0.5,1,1,1\n"),
            "2: column frequency_hz = 0: frequency does not increase; "
            "3: column roll = x: is not a finite number; 4: column pitch = -1: density is negative; ");
  EXPECT_EQ(problems_of("frequency_hz,yaw,pitch,roll\n1,1,1,1\n"), "0: Satellite/Jitter/File: the file has 1; ");
}

}  // namespace
}  // namespace astroid
