/// Scores of bodies, one line of JSON a body: a run that ended early goes on where it was.
#pragma once

#include <string>
#include <vector>

#include "scored_figures.hpp"

namespace tensegric_fit::population {

/// What came of one body.
struct Score {
  std::string family, input, body;
  std::string refusal;  ///< "code: message" where it was refused; then all its figures are missing
  std::vector<Figure> figures;
};

/// The file's bodies, in its order, without a last line that is not written to its end; none where there is
/// no file. \throw Refusal broken_file: another line that is no score
std::vector<Score> read_scores(const std::string& path);

/// Takes such a last line off a file that is to be added to, and that no other run is writing.
void take_off_unfinished(const std::string& path);

/// Adds a line. \throw Refusal cannot_write
void append_score(const std::string& path, const Score& score);

}  // namespace tensegric_fit::population
