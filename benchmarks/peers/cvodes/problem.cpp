#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <utility>

namespace peer {

CurvePoint evaluate(const Curve& curve, double s) {
  const double position = std::fabs(s);
  const std::size_t last = curve.knots.size() - 1;
  if (position >= curve.knots[last]) return {last - 1, 0.0, 1.0, curve.ordinates[last], 0.0};
  std::size_t i = 0;
  while (position >= curve.knots[i + 1]) ++i;
  const double width = curve.knots[i + 1] - curve.knots[i];
  const double weight = (position - curve.knots[i]) / width;
  const double rise = curve.ordinates[i + 1] - curve.ordinates[i];
  return {i, 1.0 - weight, weight, curve.ordinates[i] + weight * rise, rise / width};
}

double acceleration(const Crush& crush, double x, double v) {
  return -(evaluate(crush.spring, x).value * x + evaluate(crush.damper, v).value * v) / crush.mass;
}

double largest_error(const Channels& result, const Channels& reference) {
  double worst = 0.0;
  for (std::size_t c = 0; c < reference.size(); ++c) {
    double error = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < reference[c].size(); ++i) {
      const double difference = std::fabs(result[c][i] - reference[c][i]);
      if (!(difference <= error)) error = difference;  // so that what is not a number stays
      largest = std::max(largest, std::fabs(reference[c][i]));
    }
    if (!(error / largest <= worst)) worst = error / largest;
  }
  return worst;
}

double ninetieth_percentile(std::vector<double> errors) {
  std::ranges::sort(errors);
  return errors.at((errors.size() * 9 + 9) / 10 - 1);
}

Crush crush_from(const nlohmann::json& model) {
  const auto curve = [&](const char* name) {
    return Curve{model.at(name).at("knots"), model.at(name).at("ordinates")};
  };
  return {model.at("mass"), model.at("speed"), curve("spring"), curve("damper")};
}

nlohmann::json read(const std::string& folder, const std::string& name) {
  std::ifstream file(folder + "/" + name);
  if (!file) throw std::runtime_error(folder + "/" + name + ": cannot be read; bench_workloads writes it");
  return nlohmann::json::parse(file);
}

double median_seconds(int repetitions, const std::function<void()>& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const double start = now();
    work();
    seconds.push_back(now() - start);
  }
  std::ranges::sort(seconds);
  return seconds[seconds.size() / 2];
}

void report(nlohmann::json result) {
  result["sundials"] = CRASHSIM_SUNDIALS;
  std::cout << result << std::endl;  // at once: a long run shows what it has
}

}  // namespace peer
