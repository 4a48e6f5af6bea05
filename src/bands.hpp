#pragma once
/// Pointwise quantiles of an ensemble.

#include <utility>
#include <vector>

#include <crashsim/simulate_many.hpp>

namespace crashsim {

/// The quantiles that leave out as much on either side, so that `level` is between them; unset of no values. `values`
/// come back in another order. NaN are left out.
std::pair<double, double> interval_of(std::vector<double>& values, double level);

/// interval_of() every column.
void band_of(const RowMatrix& rows, double level, std::vector<double>& low, std::vector<double>& high);

}  // namespace crashsim
