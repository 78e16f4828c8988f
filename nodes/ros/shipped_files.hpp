/// Where the shipped garments and templates lie.
#pragma once

#include <string>

namespace tensegric_fit::node {

/// launch/<folder> of the package, as rospack finds it; empty where it does not.
std::string shipped_folder(const std::string& folder);

/// `word` itself where it is a path or a .yaml file, else the file of that name in `folder`.
/// \throw Refusal `code`: there is no such file
std::string shipped_file(const std::string& folder, const std::string& word, const char* code);

}  // namespace tensegric_fit::node
