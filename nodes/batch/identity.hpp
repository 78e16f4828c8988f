/// What makes two results the same: content of the scan, settings, and the build that computed them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "batch/manifest.hpp"

namespace tensegric_fit::batch {

/// Of this build: programs, libraries and shipped data that decide a result, 16 hexadecimal digits.
const std::string& build_identity();

/// Of the rows of a manifest in that file, 16 hexadecimal digits: the same wherever the file and what lies
/// beside it are, and for rows of either format.
std::string manifest_identity(const std::vector<Job>& jobs, const std::string& file);

struct Identity {
  std::string subject;  ///< of scan and settings, 32 hexadecimal digits: the same for every build
  std::string key;      ///< of subject and build
};

/// \throw Refusal broken_file: a file cannot be read
Identity identity_of(const Job& job, const std::string& build);

}  // namespace tensegric_fit::batch
