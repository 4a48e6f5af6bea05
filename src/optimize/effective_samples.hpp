#pragma once
/// How many independent samples a correlated series is worth.

#include <span>

namespace crashsim {

/// n / (1 + 2 sum of the autocorrelations), the sum to where those of two lags together fall below 0 (the initial
/// positive sequence of [Geyer1992]); 1..n. Of residuals: their mean is taken as 0.
double effective_samples(std::span<const double> residuals);

}  // namespace crashsim
