/// Text with places to be filled in.
#pragma once

#include <map>
#include <string>

namespace tensegric_fit::files {

/// `text` with each [NAME] of `values` replaced; other brackets stay.
std::string filled_in(const std::string& text, const std::map<std::string, std::string>& values);

/// A file's bytes. \throw Refusal broken_file: it is not there or cannot be read
std::string bytes_of(const std::string& path);

}  // namespace tensegric_fit::files
