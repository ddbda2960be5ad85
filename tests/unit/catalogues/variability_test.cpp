// Variable stars: exact averages over exposures, and every message of the table's reader.
#include "astroid/catalogues/variability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

/// Mean by a fine midpoint rule.
double slow_mean(const std::function<double(double)>& flux, double begin, double end) {
  constexpr int kSteps = 200000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += flux(begin + (end - begin) * (i + 0.5) / kSteps);
  return sum / kSteps;
}

TEST(Variability, AveragesASinusoidOverTheExposure) {
  Variability v;
  v.add(SinusoidalVariation{.amplitude = 0.01, .period = 60.0, .phase = 0.1});
  const auto flux = [](double t) { return 1.0 + 0.01 * std::sin(2.0 * std::acos(-1.0) * (t / 60.0 + 0.1)); };
  for (const double begin : {0.0, 13.0, 100.0})
    EXPECT_NEAR(v.mean(begin, begin + 21.0), slow_mean(flux, begin, begin + 21.0), 1e-12);
  EXPECT_NEAR(v.mean(7.0, 67.0), 1.0, 1e-15);  // a whole period
  EXPECT_NEAR(v.mean(5.0, 5.0 + 1e-9), flux(5.0), 1e-9);
  EXPECT_DOUBLE_EQ(v.largest_change(), 0.01);
  // After 6 years the phase is as good as the time itself.
  const double late = 60.0 * 3155760.0;
  EXPECT_NEAR(v.mean(late, late + 21.0), v.mean(0.0, 21.0), 1e-10);
}

TEST(Variability, AveragesTransitsOverAnExposureThatBeginsInThem) {
  const PeriodicDips dips{.depth = 0.02, .duration = 100.0, .ingress = 15.0, .period = 1000.0, .epoch = 300.0};
  Variability v;
  v.add(dips);
  const auto flux = [&](double t) {
    double x = std::fmod(t - dips.epoch, dips.period);
    if (x > 500.0) x -= 1000.0;
    if (x < -500.0) x += 1000.0;
    const double inside = 50.0 - std::abs(x);  // from the edge
    return 1.0 - 0.02 * std::min(1.0, std::max(0.0, inside / 15.0));
  };
  for (const double begin : {0.0, 240.0, 251.0, 262.0, 300.0, 330.0, 345.0, 1255.0, 5244.5})
    EXPECT_NEAR(v.mean(begin, begin + 21.0), slow_mean(flux, begin, begin + 21.0), 1e-9) << begin;
  EXPECT_EQ(v.mean(400.0, 421.0), 1.0);
  EXPECT_DOUBLE_EQ(v.mean(290.0, 311.0), 0.98);
  // Over whole periods: the area of the trapezoid.
  EXPECT_NEAR(v.mean(123.0, 3123.0), 1.0 - 0.02 * 85.0 / 1000.0, 1e-14);
  EXPECT_NEAR(v.mean(1e8 + 240.0, 1e8 + 261.0), v.mean(240.0, 261.0), 1e-9);
}

TEST(Variability, WithoutIngressIsABox) {
  Variability v;
  v.add(PeriodicDips{.depth = 0.5, .duration = 10.0, .ingress = 0.0, .period = 100.0, .epoch = 50.0});
  EXPECT_DOUBLE_EQ(v.mean(40.0, 50.0), 0.75);
  EXPECT_DOUBLE_EQ(v.mean(45.0, 55.0), 0.5);
  EXPECT_DOUBLE_EQ(v.mean(55.0, 60.0), 1.0);
}

TEST(Variability, ComponentsAddUp) {
  Variability v;
  v.add(SinusoidalVariation{.amplitude = 0.1, .period = 1e6, .phase = 0.25});
  v.add(PeriodicDips{.depth = 0.2, .duration = 10.0, .ingress = 0.0, .period = 100.0, .epoch = 5.0});
  EXPECT_NEAR(v.mean(0.0, 10.0), 1.0 + 0.1 - 0.2, 1e-9);
  EXPECT_DOUBLE_EQ(v.least(), 1.0 - 0.1 - 0.2);
  EXPECT_DOUBLE_EQ(v.largest_change(), 0.1 + 0.2);
}

std::vector<VariableStar> read_text(const std::string& text, double end = 1000.0) {
  const test::TemporaryFolder folder;
  (void)folder.write("curve.csv", "time_s,flux\n0,1\n100,1.2\n300,0.8\n2000,0.8\n");
  (void)folder.write("short.csv", "time_s,flux\n0,1\n100,1.2\n");
  (void)folder.write("bad.csv", "time_s,flux\n0,1\n0,1\n50,-1\n2000,x\n");
  return read_variables(folder.write("variables.csv", text), end);
}

std::string problems_of(const std::string& text) {
  try {
    (void)read_text(text);
  } catch (const InputError& error) {
    std::string all;
    for (const Problem& p : error.problems())
      all += std::to_string(p.line) + ": " + p.parameter + (p.value.empty() ? "" : " = " + p.value) + ": " + p.message +
             "; ";
    return all;
  }
  return "no error";
}

TEST(VariableStars, AreReadFromATable) {
  const auto stars = read_text(
      "id,kind,amplitude_ppm,period_d,phase_deg,depth_ppm,duration_h,ingress_h,epoch_d,secondary_ppm,file\n"
      "A,sinusoid,100,0.5,90,,,,,,\n"
      "B,transit,,10,,8400,13,1,2,,\n"
      "C,eclipse,,2,,300000,4,1,0.5,100000,\n"
      "D,lightcurve,,,,,,,,,curve.csv\n"
      "A,sinusoid,50,1,,,,,,,\n");
  ASSERT_EQ(stars.size(), 4U);
  EXPECT_EQ(stars[0].id, "A");
  EXPECT_NEAR(stars[0].variability.mean(0.0, 1.0), 1.0001, 1e-7);
  EXPECT_NEAR(stars[0].variability.largest_change(), 150e-6, 1e-15);
  EXPECT_NEAR(stars[1].variability.mean(2.0 * 86400.0, 2.0 * 86400.0 + 21.0), 1.0 - 0.0084, 1e-12);
  EXPECT_NEAR(stars[2].variability.mean(1.5 * 86400.0, 1.5 * 86400.0 + 21.0), 0.9, 1e-12);
  EXPECT_NEAR(stars[3].variability.mean(0.0, 100.0), 1.1, 1e-14);
  EXPECT_NEAR(stars[3].variability.mean(50.0, 150.0), 1.0 + 0.5 * (0.15 + 0.15), 1e-14);
  EXPECT_NEAR(stars[3].variability.mean(500.0, 600.0), 0.8, 1e-13);
  EXPECT_NE(stars[1].variability.description().find("8400 ppm"), std::string::npos);
}

TEST(VariableStars, AreRefusedWithEveryProblem) {
  EXPECT_EQ(problems_of("id,period_d\nA,1\n"), "1: column kind: is missing; ");
  EXPECT_EQ(
      problems_of("id,kind,amplitude_ppm,period_d\nA,sinusoid,2e6,0\n,sinusoid,1,1\nB,pulsar,1,1\n"),
      "2: column amplitude_ppm = 2e6: out of range; 2: column period_d = 0: out of range; 3: column id: is missing; "
      "4: column kind = pulsar: is not a kind of variable star; ");
  EXPECT_EQ(problems_of("id,kind,depth_ppm,duration_h,ingress_h,period_d,epoch_d\nA,transit,100,30,0,1,0\n"),
            "2: column duration_h = 30: longer than the period; ");
  EXPECT_EQ(problems_of("id,kind,depth_ppm,duration_h,ingress_h,period_d,epoch_d\nA,transit,100,3,2,1,0\n"),
            "2: column ingress_h = 2: longer than half the duration; ");
  EXPECT_EQ(problems_of("id,kind,depth_ppm,duration_h,period_d\nA,transit,100,3,1\n"),
            "2: column epoch_d: is missing, which transit needs; ");
  EXPECT_EQ(problems_of("id,kind,amplitude_ppm,period_d\nA,sinusoid,6e5,1\nA,sinusoid,5e5,2\n"),
            "3: column kind = sinusoid: lets the flux of A become negative; ");
  EXPECT_EQ(problems_of("id,kind,file\nA,lightcurve,none.csv\nB,lightcurve,\n"),
            "2: column file = none.csv: no such file; 3: column file: is missing, which lightcurve needs; ");
  EXPECT_EQ(problems_of("id,kind,file\nA,lightcurve,short.csv\n"),
            "0: column time_s: 2 samples do not cover the run; ");
  EXPECT_EQ(problems_of("id,kind,file\nA,lightcurve,bad.csv\n"),
            "3: column time_s = 0: is not a time after the one before; 4: column flux = -1: is not a relative flux; "
            "5: column flux = x: is not a relative flux; ");
}

}  // namespace
}  // namespace astroid
