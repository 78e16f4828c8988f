/// Golden values are replaced on purpose only.
#pragma once

#include <string>
#include <vector>

#include "comparison.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {

/// Why nothing of a run may be recorded, a sentence each: its faults, values and skin that did not come out
/// or are not finite. Empty: it may.
std::vector<std::string> against_update(const Case& asked, const Recording& recording,
                                        const Verdict& verdict);

/// Old, new, difference and tolerance of every golden value of a case, of its recorded shape, and of what is
/// asked for and does not hold, which stays: a table for people.
std::string update_table(const Case& asked, const Verdict& verdict);

/// Writes the new values, and why, when, from which commit and over which values, into the case's file;
/// everything else stays as it is, letter for letter, and where no value is another one the whole file,
/// unless its recorded shape `moved`. \throw Refusal bad_case, and the file stays as it is: a golden value
/// does not stand on one line with its metric's name, or was not found in the run; the new file could not be
/// read
void update_goldens(const Case& asked, const Verdict& verdict, const std::string& reason, bool moved = false);

}  // namespace tensegric_fit::regression
