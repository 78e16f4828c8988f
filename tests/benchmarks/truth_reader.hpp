/// Truth files of bodies: those of the virtual booth and of sets made elsewhere alike.
#pragma once

#include <string>

#include "scored_figures.hpp"

namespace tensegric_fit::population {

/// JSON with `landmarks` (name -> [x, y, z], in the scan's frame), `heights`, `girths` (name -> value),
/// metres, and, where there are any, `vague`, `hidden` (lists of "girth waist" and the like) and `loose`
/// (name -> direction). Where there is a girth `neck_min` it is the neck's; without a list `vague` a waist by
/// the ruler counts as vague. `of_surface`: what the booth alone does not see is not hidden
/// (`hidden_on_surface`, where the file has it). \throw Refusal broken_file
Truth read_truth(const std::string& path, bool of_surface = false);

}  // namespace tensegric_fit::population
