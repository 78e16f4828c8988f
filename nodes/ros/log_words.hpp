/// What may stand in a log.
#pragma once

#include <string>

namespace tensegric_fit::node {

/// The sentence with # in place of each number and (file) in place of each file and folder: logs outlive the
/// customer's visit, and hold neither a measure of her nor her name. Digits within a name (B1) and topics
/// stay. It ends at missing_part: what follows says which part her body lacks.
std::string log_words(const std::string& sentence);

/// The files alone left out: for what is said of parameters at a start, before there is anybody's scan.
std::string without_files(const std::string& sentence);

}  // namespace tensegric_fit::node
