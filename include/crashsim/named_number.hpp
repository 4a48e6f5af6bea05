#pragma once
/// Tables of a result's numbers: the one list from which CLI, JSON, tables and Python print them.

#include <string_view>

namespace crashsim {

/// One number of a result struct S: its name in C++, JSON and Python, where it is and what it says.
template <class S>
struct NamedNumber {
  std::string_view name;
  double S::*member;
  std::string_view doc;
};

}  // namespace crashsim
