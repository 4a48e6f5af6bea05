/// E with its gradient by sensitivities, and W2 with it.

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "problem.hpp"
#include "solver.hpp"

namespace peer {
namespace {

enum class Method { augmented, sensitivities, controlled_sensitivities };
constexpr const char* kNames[] = {"CVODE, states and sensitivities as one system",
                                  "CVODES sensitivities, without error control",
                                  "CVODES sensitivities, with error control"};
constexpr double kTolerance = 1e-8;

/// Model with a target; parameters are places 0..1 between 0 and the ordinates' bounds.
struct Fit {
  Crush crush;
  std::vector<double> times, bounds;
  Channels target;
  double smoothing = 0.0;
  int evaluations = 0;
  Method method = Method::augmented;

  std::size_t size() const { return bounds.size(); }
};

/// The force about a state, which all sensitivities share.
struct Tangent {
  CurvePoint spring, damper;
  double by_x, by_v;
};

Tangent tangent(const Crush& crush, double x, double v) {
  const CurvePoint spring = evaluate(crush.spring, x), damper = evaluate(crush.damper, v);
  return {spring, damper, spring.value + spring.slope * std::fabs(x), damper.value + damper.slope * std::fabs(v)};
}

/// d(acceleration)/d(place p), with the sensitivities of x and v.
double acceleration_by(const Fit& fit, std::size_t p, const Tangent& at, const double* state,
                       const double* sensitivity) {
  const std::size_t springs = fit.crush.spring.knots.size();
  const bool of_spring = p < springs;
  const CurvePoint& curve = of_spring ? at.spring : at.damper;
  const std::size_t ordinate = of_spring ? p : p - springs;
  double weight = 0.0;
  if (ordinate == curve.first) weight = curve.first_weight;
  if (ordinate == curve.first + 1) weight = curve.second_weight;
  const double force =
      at.by_x * sensitivity[0] + at.by_v * sensitivity[1] + fit.bounds[p] * weight * (of_spring ? state[0] : state[1]);
  return -force / fit.crush.mass;
}

int state_rhs(sunrealtype, N_Vector y, N_Vector ydot, void* data) {
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(ydot);
  rate[0] = state[1];
  rate[1] = acceleration(static_cast<const Fit*>(data)->crush, state[0], state[1]);
  return 0;
}

int sensitivity_rhs(int count, sunrealtype, N_Vector y, N_Vector, N_Vector* s, N_Vector* sdot, void* data, N_Vector,
                    N_Vector) {
  const Fit& fit = *static_cast<const Fit*>(data);
  const double* state = N_VGetArrayPointer(y);
  const Tangent at = tangent(fit.crush, state[0], state[1]);
  for (int p = 0; p < count; ++p) {
    const double* sensitivity = N_VGetArrayPointer(s[p]);
    double* rate = N_VGetArrayPointer(sdot[p]);
    rate[0] = sensitivity[1];
    rate[1] = acceleration_by(fit, static_cast<std::size_t>(p), at, state, sensitivity);
  }
  return 0;
}

int augmented_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void* data) {
  const Fit& fit = *static_cast<const Fit*>(data);
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(ydot);
  state_rhs(t, y, ydot, data);
  const Tangent at = tangent(fit.crush, state[0], state[1]);
  for (std::size_t p = 0; p < fit.size(); ++p) {
    const double* sensitivity = state + 2 + 2 * p;
    rate[2 + 2 * p] = sensitivity[1];
    rate[3 + 2 * p] = acceleration_by(fit, p, at, state, sensitivity);
  }
  return 0;
}

void set_places(Fit& fit, const double* places) {
  const std::size_t springs = fit.crush.spring.knots.size();
  for (std::size_t p = 0; p < fit.size(); ++p)
    (p < springs ? fit.crush.spring.ordinates[p] : fit.crush.damper.ordinates[p - springs]) = fit.bounds[p] * places[p];
}

std::unique_ptr<Solver> make_solver(Fit& fit) {
  std::vector<double> initial{0.0, fit.crush.speed};
  if (fit.method == Method::augmented) {
    initial.resize(2 + 2 * fit.size(), 0.0);
    return std::make_unique<Solver>(initial, augmented_rhs, &fit, kTolerance);
  }
  auto solver = std::make_unique<Solver>(initial, state_rhs, &fit, kTolerance);
  solver->add_sensitivities(sensitivity_rhs, std::vector<double>(fit.size(), 1.0),
                            fit.method == Method::controlled_sensitivities);
  return solver;
}

/// E of places with its gradient: mean over samples of |r|, relative to each channel's maximum, or its rounded form.
double evaluate(Fit& fit, const double* places, double* gradient) {
  set_places(fit, places);
  std::fill_n(gradient, fit.size(), 0.0);
  const std::unique_ptr<Solver> solver = make_solver(fit);
  double scales[3];
  for (std::size_t c = 0; c < 3; ++c) {
    scales[c] = 0.0;
    for (const double value : fit.target[c]) scales[c] = std::max(scales[c], std::fabs(value));
  }
  const double weight = 1.0 / static_cast<double>(fit.times.size()), eps = fit.smoothing;
  double sum = 0.0;
  for (std::size_t i = 0; i < fit.times.size(); ++i) {
    const double* y = solver->at(fit.times[i]);
    double** separate = fit.method == Method::augmented ? nullptr : solver->sensitivities();
    const double motion[3] = {y[0], y[1], acceleration(fit.crush, y[0], y[1])};
    const Tangent tangent_there = tangent(fit.crush, y[0], y[1]);
    double slope[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const double r = (motion[c] - fit.target[c][i]) / scales[c];
      const double root = std::sqrt(r * r + eps * eps);
      sum += weight * (root - eps);
      slope[c] = root > 0.0 ? weight * r / root / scales[c] : 0.0;
    }
    for (std::size_t p = 0; p < fit.size(); ++p) {
      const double* s = separate == nullptr ? y + 2 + 2 * p : separate[p];
      gradient[p] += slope[0] * s[0] + slope[1] * s[1] + slope[2] * acceleration_by(fit, p, tangent_there, y, s);
    }
  }
  return sum;
}

double objective(unsigned, const double* places, double* gradient, void* data) {
  Fit& fit = *static_cast<Fit*>(data);
  ++fit.evaluations;
  std::vector<double> unused(gradient == nullptr ? fit.size() : 0);
  try {
    return evaluate(fit, places, gradient == nullptr ? unused.data() : gradient);
  } catch (const std::exception&) {
    return std::numeric_limits<double>::infinity();
  }
}

/// Descends along a ladder of ever sharper corners to the true E.
double descend(Fit& fit, std::vector<double>& places) {
  double value = 0.0;
  for (const double smoothing : {3e-1, 3e-2, 3e-3, 3e-4, 0.0}) {
    fit.smoothing = smoothing;
    nlopt_opt nlopt = nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(fit.size()));
    nlopt_set_min_objective(nlopt, objective, &fit);
    nlopt_set_lower_bounds1(nlopt, 0.0);
    nlopt_set_upper_bounds1(nlopt, 1.0);
    nlopt_set_ftol_rel(nlopt, 1e-6);
    nlopt_set_maxeval(nlopt, 2000);
    nlopt_optimize(nlopt, places.data(), &value);  // a failed line search leaves the best point: go on from there
    nlopt_destroy(nlopt);
  }
  return value;
}

Fit fit_from(const nlohmann::json& workload) {
  Fit fit{crush_from(workload.at("truth")), workload.at("times"), {}, workload.at("target")};
  fit.bounds.assign(fit.crush.spring.knots.size(), workload.at("spring_upper"));
  fit.bounds.resize(fit.bounds.size() + fit.crush.damper.knots.size(), workload.at("damper_upper"));
  return fit;
}

std::vector<double> places_of(const Fit& fit, const std::vector<double>& ordinates) {
  std::vector<double> places(ordinates.size());
  std::ranges::transform(ordinates, fit.bounds, places.begin(), std::divides<>());
  return places;
}

/// Largest error of a gradient by places over its largest component, at 90 % of the points.
double gradient_error(Fit& fit, const Channels& points, const Channels& reference) {
  std::vector<double> errors, gradient(fit.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    evaluate(fit, places_of(fit, points[i]).data(), gradient.data());
    double error = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < fit.size(); ++p) {
      const double expected = fit.bounds[p] * reference[i][p];
      const double difference = std::fabs(gradient[p] - expected);
      if (!(difference <= error)) error = difference;  // so that what is not a number stays
      largest = std::max(largest, std::fabs(expected));
    }
    errors.push_back(error / largest);
  }
  return ninetieth_percentile(errors);
}

void measure_gradient(Fit& fit, const nlohmann::json& workload, const Channels& reference, bool quick) {
  const Channels points = workload.at("points");
  std::vector<double> gradient(fit.size());
  const double seconds = median_seconds(quick ? 3 : 9, [&] {
    for (const auto& point : points) evaluate(fit, places_of(fit, point).data(), gradient.data());
  });
  nlohmann::json result = {{"workload", "gradient"},
                           {"engine", kNames[static_cast<int>(fit.method)]},
                           {"seconds", seconds / static_cast<double>(points.size())}};
  if (!reference.empty()) result["error"] = gradient_error(fit, points, reference);
  report(result);
}

void measure_fit(Fit& fit, const nlohmann::json& workload, int starts) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> ends;
  const double seconds = median_seconds(1, [&] {
    for (int i = 0; i < starts; ++i) {
      std::vector<double> places = places_of(fit, workload.at("starts").at(static_cast<std::size_t>(i)));
      ends.push_back(descend(fit, places));
      best = std::min(best, ends.back());
    }
  });
  report({{"workload", "W2"},
          {"engine", std::string(kNames[static_cast<int>(fit.method)]) + " + NLopt"},
          {"seconds", seconds * 100 / starts},
          {"starts", starts},
          {"evaluations", fit.evaluations},
          {"ends", ends},
          {"E", best}});
}

}  // namespace

void run_fit(const std::string& folder, bool quick) {
  const nlohmann::json workload = read(folder, "w2.json");
  Channels reference;
  try {
    reference = read(folder, "w2_gradients.json").at("gradients");
  } catch (const std::runtime_error& error) {
    std::cerr << "peer_cvodes: gradients are not compared: " << error.what() << '\n';
  }
  for (const Method method : {Method::augmented, Method::sensitivities, Method::controlled_sensitivities}) {
    Fit fit = fit_from(workload);
    fit.method = method;
    measure_gradient(fit, workload, reference, quick);
    if (method != Method::controlled_sensitivities) measure_fit(fit, workload, quick ? 2 : 10);
  }
}

}  // namespace peer
