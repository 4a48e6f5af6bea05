#pragma once
/// An uncertainty in words.

#include <string>

#include <crashsim/uncertainty.hpp>

namespace crashsim {

/// How many ordinates are determined, which are not, and what is determined instead.
std::string words_of(const Uncertainty& uncertainty);

}  // namespace crashsim
