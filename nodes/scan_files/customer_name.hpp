/// The booth's own customer id in the names of its files.
#pragma once

#include <regex>
#include <string>

namespace tensegric_fit::scan_files {

/// ECMAScript, with one group that is the id: `^([^_]+)_` finds 4711 in 4711_left.ply; empty: there is none.
/// \throw Refusal bad_option: no regular expression, or one without exactly one group
std::regex customer_pattern(const std::string& text);

/// What the group finds in the name of the file, or nothing.
std::string customer_in(const std::string& path, const std::regex& pattern);

}  // namespace tensegric_fit::scan_files
