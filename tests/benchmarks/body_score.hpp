/// One body of a population, measured and compared with its truth.
#pragma once

#include <string>
#include <vector>

#include "control_mesh/template.hpp"
#include "score_file.hpp"
#include "subjects.hpp"

namespace tensegric_fit::population {

/// As scores and tables name it.
std::string input_name(Input input);

/// Measures the body and lays the templates on it. A refusal of the chain is a score like any other, with all
/// figures of the truth missing; so is one of the body itself, which could not be read or made and has no
/// figures: the bodies after it are to be measured, too. `made`, where given: false for the latter, which
/// says nothing of the chain.
Score score_of(const Family& family, const std::string& name, Input input,
               const std::vector<control_mesh::Template>& patterns, bool* made = nullptr);

}  // namespace tensegric_fit::population
