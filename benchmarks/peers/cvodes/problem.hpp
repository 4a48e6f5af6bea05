#pragma once
/// The workloads as `bench_workloads` writes them, and the equations.

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace peer {

using Channels = std::vector<std::vector<double>>;

/// Linear between knots, held beyond the last.
struct Curve {
  std::vector<double> knots, ordinates;
};

/// A curve at |s|: value and slope, and the ordinates that it is made of, value = sum of weight * ordinate.
struct CurvePoint {
  std::size_t first;
  double first_weight, second_weight;  ///< Of ordinates `first` and `first + 1`.
  double value, slope;
};
CurvePoint evaluate(const Curve& curve, double s);

/// m x'' + c(|v|) v + k(|x|) x = 0.
struct Crush {
  double mass, speed;
  Curve spring, damper;
};
double acceleration(const Crush& crush, double x, double v);

/// Error of a result as workloads.hpp defines it.
double largest_error(const Channels& result, const Channels& reference);
double ninetieth_percentile(std::vector<double> errors);

Crush crush_from(const nlohmann::json& model);
nlohmann::json read(const std::string& folder, const std::string& name);

/// CPU time of the process for one call of `work`, the median of some [s].
double median_seconds(int repetitions, const std::function<void()>& work);

/// Prints one result as a line of JSON, with the SUNDIALS that is linked.
void report(nlohmann::json result);

// What each file measures. `quick`: fewer repetitions.
void run_forward(const std::string& folder, bool quick);
void run_fit(const std::string& folder, bool quick);
void run_pitch(const std::string& folder, bool quick);

}  // namespace peer
