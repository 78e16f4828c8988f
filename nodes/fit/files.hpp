/// Where the shipped garments and templates lie: share/tensegric_fit beside the program, installed or not.
#pragma once

#include <string>

namespace tensegric_fit::fit {

/// `word` as a file, or the shipped garment of that name. \throw Refusal bad_garment naming the shipped ones
std::string garment_file(const std::string& word);

/// The shipped template of a region. \throw Refusal bad_garment: a region without a template
std::string template_file(const std::string& region);

}  // namespace tensegric_fit::fit
