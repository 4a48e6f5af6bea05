#pragma once
/// Which channels of an NHTSA test measure how the passenger compartment decelerates.

#include <vector>

#include "io/nhtsa_header.hpp"

namespace crashsim::io {

/// Indices of the longitudinal accelerometers of the first vehicle's compartment, from the best place that has any:
/// rear floor and rear seat cross-member, then centre of gravity and tunnel, then other floor and sills. Primary
/// channels are preferred to redundant ones. `usable[i]` says whether channel i has good samples.
std::vector<std::size_t> compartment_channels(const NhtsaHeader& header, const std::vector<bool>& usable);

}  // namespace crashsim::io
