/// Paths of the shipped garments and templates: share/tensegric_fit beside the folder of this library,
/// installed or not and also in rviz, so that no environment variable is needed.
#pragma once

#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// The shipped folder of that name: garments, templates, tissue.
std::string shipped_folder(const std::string& name);

/// `word` itself where it is a path or ends in .yaml, else the file of that name in `folder`.
/// \throw Refusal `code`, naming the existing files: there is no such file
std::string yaml_file(const std::string& folder, const std::string& word, const std::string& code);

/// Names and files that are joined by '+'; a file whose own path has one is one. As many as there are '+' and
/// one more, empty or not.
std::vector<std::string> joined_words(const std::string& words);

}  // namespace tensegric_fit::geometry
