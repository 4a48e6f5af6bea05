#pragma once
/// What varies in a case: [sweep] and [monte_carlo].

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/distribution.hpp>
#include <crashsim/options.hpp>
#include <crashsim/sampling.hpp>

namespace crashsim {

/// How one number of a case varies: `vehicle.mass = {normal = ["1719 kg", "30 kg"]}`.
///
/// The number is any of a case's keys that a sample depends on, or an ordinate of the model's crush curves: `crush.k1`,
/// `crush.k2`, .. of the spring, `crush.c1`, .. of the damper, in the order of the knots; `crush.k` and `crush.c` are
/// all of a curve, times a factor.
struct Variation {
  std::string key;                                          ///< "vehicle.mass", "crush.k3"
  DistributionKind distribution = DistributionKind::table;  ///< In [sweep] a table: each of its numbers.
  std::vector<std::string> numbers;  ///< Its numbers, each with a unit or in SI; a table's may be ranges "1 t..2 t:5".
  std::vector<double> weights;       ///< Of a table's numbers.
  std::string lower, upper;          ///< Ends where normal and lognormal are cut off; "": none.
  bool relative = false;             ///< The numbers are factors of what the case or its model has.

  bool operator==(const Variation&) const = default;
};

/// [sweep]: every combination of the numbers.
struct SweepOptions {
  std::vector<Variation> vary;  ///< The last varies fastest.

  bool operator==(const SweepOptions&) const = default;
};

/// [monte_carlo]: numbers at random.
struct MonteCarloOptions {
  int samples = 1024;  ///< With `saltelli` groups of samples: two more than there are numbers in each.
  std::uint64_t seed = 1;
  SampleMethod method = SampleMethod::sobol;
  std::vector<Variation> vary;

  bool operator==(const MonteCarloOptions&) const = default;
};
inline constexpr double kMostSamples = 1e6;  ///< In one case.
inline constexpr std::array<Field<MonteCarloOptions>, 3> kMonteCarloFields = {{
    {"samples", "samples", "", "samples; of saltelli groups, each with two more samples than numbers that vary",
     &MonteCarloOptions::samples, between(1, kMostSamples)},
    {"seed", "seed", "", "seed of the samples; each depends on it and on its own index only", &MonteCarloOptions::seed},
    {"method", "method", "", "how the samples are spread; saltelli gives total Sobol' indices, too",
     choice<&MonteCarloOptions::method>()},
}};
template <>
inline constexpr std::span<const Field<MonteCarloOptions>> fields<MonteCarloOptions>{kMonteCarloFields};

}  // namespace crashsim
