/// What makes two results the same: content of the scan, settings, and the build that computed them.
#pragma once

#include <map>
#include <string>

#include "batch/manifest.hpp"

namespace tensegric_fit::batch {

/// Of this build: programs, libraries and shipped data that decide a result, 16 hexadecimal digits.
const std::string& build_identity();

struct Identity {
  std::string subject;  ///< of scan and settings, 32 hexadecimal digits: the same for every build
  std::string key;      ///< of subject and build
};

/// \throw Refusal broken_file: a file cannot be read
Identity identity_of(const Job& job, const std::string& build);

}  // namespace tensegric_fit::batch
