#pragma once
/// The models that a selection compares.

#include <span>
#include <vector>

#include <crashsim/select_model.hpp>

namespace crashsim {

/// Rows with what the options combine, each once, not yet fitted. @throws InvalidInput on lists that name none.
std::vector<SelectionRow> candidates_of(const SelectOptions& options);

/// How a candidate is identified, on one thread.
IdentifyOptions identify_options_of(const SelectionRow& candidate, const SelectOptions& options);

/// Completes the rows that are fitted by AICc, differences and what is recommended, best first, with the words for it.
void judge_candidates(std::span<const Pulse> pulses, const SelectOptions& options, Selection& selection);

}  // namespace crashsim
