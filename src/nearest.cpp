#include "nearest.hpp"

#include <algorithm>
#include <numeric>

#include "text.hpp"

namespace crashsim {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::vector<std::string> nearest(std::string_view text, const std::vector<std::string>& candidates, std::size_t count) {
  constexpr std::size_t kMostLetters = 200;  // the distance takes letters times letters
  const std::string wanted = to_lower(text.substr(0, kMostLetters));
  std::vector<std::pair<std::size_t, std::size_t>> ranked;  // edits, index
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const std::string candidate = to_lower(candidates[i]);
    const bool inside = !wanted.empty() && candidate.find(wanted) != std::string::npos;
    ranked.emplace_back(inside ? 0 : edit_distance(wanted, candidate), i);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> result;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) result.push_back(candidates[ranked[i].second]);
  return result;
}

}  // namespace crashsim
