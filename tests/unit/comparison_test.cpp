#include <crashsim/comparison.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/metrics.hpp>

namespace crashsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;  // rounding: of numbers of order 1 to 100
constexpr double kStep_s = 1e-4;

using Curve = std::function<double(double)>;

double half_sine(double t) { return t > 0.0 && t < 0.1 ? -200.0 * std::sin(std::numbers::pi * t / 0.1) : 0.0; }

std::vector<double> clock(double from_s, double to_s, double step_s = kStep_s) {
  std::vector<double> times;
  for (long i = std::lround(from_s / step_s); i <= std::lround(to_s / step_s); ++i)
    times.push_back(static_cast<double>(i) * step_s);
  return times;
}

Trace trace(std::string name, Dimension dimension, const std::vector<double>& times, const Curve& curve) {
  Trace out;
  out.name = std::move(name);
  out.dimension = dimension;
  out.time_s = std::make_shared<const std::vector<double>>(times);
  for (const double t : times) out.values.push_back(curve(t));
  return out;
}

TraceSet set_of(std::string path, std::vector<Trace> traces) {
  TraceSet set;
  set.path = std::move(path);
  for (std::size_t i = 0; i < traces.size(); ++i) traces[i].id = std::to_string(i + 2);
  set.traces = std::move(traces);
  return set;
}

TraceSet one(std::string path, const std::vector<double>& times, const Curve& curve) {
  return set_of(std::move(path), {trace("accel_mps2", Dimension::acceleration, times, curve)});
}

TEST(Compare, IdenticalCurvesHaveNoErrorAndFullRating) {
  const TraceSet set =
      set_of("a", {trace("accel_mps2", Dimension::acceleration, clock(0.0, 0.12), half_sine),
                   trace("speed_mps", Dimension::speed, clock(0.0, 0.12), [](double t) { return std::cos(t); })});
  const Comparison comparison = compare(set, set);
  EXPECT_EQ(comparison.start_s, 0.0);
  EXPECT_EQ(comparison.end_s, set.traces[0].times().back());
  EXPECT_NEAR(comparison.dt_s, kStep_s, kRounding);
  EXPECT_THAT(comparison.notes, IsEmpty());
  ASSERT_THAT(comparison.channels, SizeIs(2));
  for (const ChannelComparison& channel : comparison.channels) {
    EXPECT_EQ(channel.errors.mean_abs, 0.0);
    EXPECT_EQ(channel.errors.max_abs, 0.0);
    EXPECT_EQ(channel.rating.overall, 1.0);
    EXPECT_THAT(channel.not_rated, IsEmpty());
  }
  EXPECT_EQ(comparison.channels[0].unit, "m/s^2");
  EXPECT_EQ(comparison.channels[1].unit, "m/s");
}

TEST(Compare, ErrorsAreThoseOfTheCandidate) {
  const auto times = clock(0.0, 0.12);
  const Comparison comparison =
      compare(one("a", times, half_sine), one("b", times, [](double t) { return half_sine(t) + 3.0; }));
  EXPECT_NEAR(comparison.channels[0].errors.mean_abs, 3.0, kRounding);
  EXPECT_NEAR(comparison.channels[0].errors.mean_abs_relative, 3.0 / 200.0, kRounding);
}

TEST(Compare, NamesMayDifferInTheirUnit) {
  const auto times = clock(0.0, 0.12);
  const TraceSet si = one("a", times, half_sine);
  const TraceSet in_g = set_of("b", {trace("accel_g", Dimension::acceleration, times, half_sine)});
  const Comparison comparison = compare(si, in_g);
  ASSERT_THAT(comparison.channels, SizeIs(1));
  EXPECT_EQ(comparison.channels[0].name, "accel_mps2");
  const TraceSet force = set_of("c", {trace("accel_n", Dimension::force, times, half_sine)});
  EXPECT_THAT([&] { static_cast<void>(compare(si, force)); },
              ThrowsMessage<InvalidInput>(HasSubstr("a and c have no channel in common: accel_mps2 against accel_n")));
}

TEST(Compare, TheCandidateIsInterpolatedAtTheReferencesSamples) {
  const Curve line = [](double t) { return 5.0 * t + 1.0; };
  const Comparison comparison = compare(one("a", clock(0.0, 0.1), line), one("b", clock(-0.003, 0.12, 0.003), line));
  EXPECT_NEAR(comparison.channels[0].errors.max_abs, 0.0, kRounding);
  EXPECT_EQ(comparison.start_s, 0.0);
}

TEST(Compare, KeepsToTheTimeThatBothHave) {
  const Comparison comparison =
      compare(one("a", clock(-0.02, 0.09), half_sine), one("b", clock(0.01, 0.12), half_sine));
  EXPECT_NEAR(comparison.start_s, 0.01, kRounding);
  EXPECT_NEAR(comparison.end_s, 0.09, kRounding);
  EXPECT_NEAR(comparison.channels[0].errors.max_abs, 0.0, kRounding);
}

TEST(Compare, KeepsToTheWindowAskedFor) {
  const auto times = clock(0.0, 0.12);
  const Curve off_after_50ms = [](double t) { return half_sine(t) + (t > 0.0501 ? 100.0 : 0.0); };
  CompareOptions options;
  options.start_s = 0.01;
  options.end_s = 0.05;
  const Comparison comparison = compare(one("a", times, half_sine), one("b", times, off_after_50ms), options);
  EXPECT_NEAR(comparison.start_s, 0.01, kRounding);
  EXPECT_NEAR(comparison.end_s, 0.05, kRounding);
  EXPECT_NEAR(comparison.channels[0].errors.max_abs, 0.0, kRounding);
}

TEST(Compare, AReferenceOfUnequalStepsIsMadeUniform) {
  std::vector<double> times;
  for (int i = 0; i <= 100; ++i) times.push_back(1e-5 * i * (i + 1));
  const Curve line = [](double t) { return 5.0 * t + 1.0; };
  const Comparison comparison = compare(one("a", times, line), one("b", clock(0.0, 0.2), line));
  EXPECT_THAT(comparison.notes, ElementsAre(HasSubstr("accel_mps2: steps are not uniform: compared every 0.00101 s")));
  EXPECT_NEAR(comparison.dt_s, times.back() / 100.0, kRounding);
  EXPECT_NEAR(comparison.end_s, times.back(), kRounding);
  EXPECT_NEAR(comparison.channels[0].errors.max_abs, 0.0, kRounding);
}

TEST(Compare, TellsChannelsThatAreAlone) {
  const auto times = clock(0.0, 0.12);
  const TraceSet both = set_of("a", {trace("accel_g", Dimension::acceleration, times, half_sine),
                                     trace("wall_kn", Dimension::force, times, half_sine)});
  const Comparison comparison = compare(both, one("b", times, half_sine));
  EXPECT_THAT(comparison.channels, SizeIs(1));
  EXPECT_THAT(comparison.notes, ElementsAre("not in b: wall_kn"));
}

TEST(Compare, ChoosesChannels) {
  const auto times = clock(0.0, 0.12);
  const TraceSet set = set_of("a", {trace("x_g", Dimension::acceleration, times, half_sine),
                                    trace("y_g", Dimension::acceleration, times, half_sine),
                                    trace("z_mps", Dimension::speed, times, half_sine)});
  CompareOptions options;
  options.channels = {"*_g"};
  EXPECT_THAT(compare(set, set, options).channels, SizeIs(2));
  options.channels = {"4"};
  EXPECT_EQ(compare(set, set, options).channels.at(0).name, "z_mps");
  options.channels = {"w_g"};
  EXPECT_THAT([&] { static_cast<void>(compare(set, set, options)); },
              ThrowsMessage<InvalidInput>(HasSubstr("a: no channel 'w_g' among 3")));
}

TEST(Compare, WhatCannotBeRatedSaysWhy) {
  const auto times = clock(0.0, 0.12);
  const Curve none = [](double) { return 0.0; };
  const Comparison zero = compare(one("a", times, none), one("b", times, none));
  EXPECT_THAT(zero.channels[0].rating.overall, IsNan());
  EXPECT_THAT(zero.channels[0].not_rated, HasSubstr("zero"));
  EXPECT_EQ(zero.channels[0].errors.max_abs, 0.0);
  const auto few = clock(0.0, 0.0004);
  EXPECT_THAT(compare(one("a", few, half_sine), one("b", few, half_sine)).channels[0].not_rated, HasSubstr("samples"));
}

TEST(Compare, RefusesWhatHasNoTimeInCommon) {
  EXPECT_THAT(
      [] { static_cast<void>(compare(one("a", clock(0.0, 0.1), half_sine), one("b", clock(0.2, 0.3), half_sine))); },
      ThrowsMessage<InvalidInput>(HasSubstr("accel_mps2: 0 samples between 0.2 and 0.1 s")));
}

TEST(Compare, RefusesMissingValues) {
  const auto times = clock(0.0, 0.1);
  const Curve gap = [](double t) { return t == 0.0 ? kUnset : 1.0; };
  EXPECT_THAT([&] { static_cast<void>(compare(one("a", times, half_sine), one("b", times, gap))); },
              ThrowsMessage<InvalidInput>(HasSubstr("accel_mps2: sample 1 at 0 s is nan: must be finite")));
}

/// A motion under constant deceleration `a` from 15 m/s, to `end_s`, with the channels' names.
TraceSet braking(double a, double end_s, const char* accel = "accel_mps2") {
  const auto times = clock(-0.01, end_s);
  const auto since = [](double t) { return std::max(t, 0.0); };
  return set_of("braking",
                {trace(accel, Dimension::acceleration, times, [=](double t) { return t < 0.0 ? 0.0 : -a; }),
                 trace("velocity_mps", Dimension::speed, times, [=](double t) { return 15.0 - a * since(t); }),
                 trace("displacement_m", Dimension::length, times,
                       [=](double t) { return 15.0 * t - 0.5 * a * since(t) * since(t); })});
}

TEST(CompareMetrics, ArePutSideBySide) {
  TraceSet test = braking(200.0, 0.1), model = braking(220.0, 0.12, "accel_g");
  test.mass_kg = model.mass_kg = 1500.0;
  const std::vector<MetricComparison> compared = compare_metrics(test, model);
  ASSERT_THAT(compared, SizeIs(kMetricFields.size()));
  for (std::size_t i = 0; i < compared.size(); ++i) {
    EXPECT_EQ(compared[i].name, kMetricFields[i].name);
    EXPECT_EQ(compared[i].doc, kMetricFields[i].doc);
  }
  const auto find = [&](std::string_view name) {
    return *std::find_if(compared.begin(), compared.end(), [&](const auto& m) { return m.name == name; });
  };
  EXPECT_NEAR(find("t_m_s").reference, 15.0 / 200.0, kRounding);
  EXPECT_NEAR(find("t_m_s").candidate, 15.0 / 220.0, kRounding);
  EXPECT_NEAR(find("t_m_s").difference, 200.0 / 220.0 - 1.0, kRounding);
  EXPECT_NEAR(find("peak_decel_g").difference, 0.1, kRounding);
  EXPECT_NEAR(find("energy_j").difference, 0.0, kRounding);
  EXPECT_THAT(find("restitution").reference, IsNan());
  EXPECT_THAT(find("restitution").difference, IsNan());
}

TEST(CompareMetrics, DifferencesOfNegativeNumbersGrowWithThem) {
  // Both end in rebound, braked no more after 80 ms: of -1 and -2.6 m/s.
  const auto rebounding = [](double a) {
    TraceSet set = braking(a, 0.08);
    TraceSet rest = braking(0.0, 0.12);
    for (std::size_t c = 0; c < 3; ++c) {
      Trace& channel = rest.traces[c];
      const std::vector<double>& braked = set.traces[c].values;
      for (std::size_t i = 0; i < channel.values.size(); ++i)
        channel.values[i] = i < braked.size() ? braked[i] : c == 0 ? 0.0 : braked.back();
    }
    return rest;
  };
  const auto compared = compare_metrics(rebounding(200.0), rebounding(220.0));
  const auto rebound =
      std::find_if(compared.begin(), compared.end(), [](const auto& m) { return m.name == "rebound_velocity_mps"; });
  EXPECT_NEAR(rebound->reference, -1.0, kRounding);
  EXPECT_NEAR(rebound->difference, -1.6, kRounding * 1e2);
}

TEST(CompareMetrics, NeedTwoMotions) {
  const auto times = clock(0.0, 0.12);
  EXPECT_THAT(compare_metrics(braking(200.0, 0.1), one("b", times, half_sine)), IsEmpty());
  const auto compares = [](const TraceSet& other) { return !compare_metrics(braking(200.0, 0.1), other).empty(); };
  EXPECT_TRUE(compares(braking(200.0, 0.1)));
  TraceSet backward = braking(200.0, 0.1);
  for (double& v : backward.traces[1].values) v = -v;
  EXPECT_FALSE(compares(backward)) << "no metrics of a motion away from the barrier";
  TraceSet other_clock = braking(200.0, 0.1);
  other_clock.traces[2] = braking(200.0, 0.2).traces[2];
  EXPECT_FALSE(compares(other_clock));
  EXPECT_FALSE(compares(braking(200.0, 0.0))) << "one sample from impact on";
}

TEST(CheckMotion, TellsTheFileThatIsOutOfBalance) {
  TraceSet set = braking(200.0, 0.1);
  EXPECT_THAT(check_motion(set), IsEmpty());
  for (double& x : set.traces[2].values) x *= 1.05;
  EXPECT_THAT(check_motion(set),
              testing::Contains(HasSubstr("braking: displacement is not the integral of velocity: they differ by 4.76 "
                                          "% of the largest displacement")));
  EXPECT_THAT(check_motion(one("b", clock(0.0, 0.12), half_sine)), IsEmpty());
}

}  // namespace
}  // namespace crashsim
