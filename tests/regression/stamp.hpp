/// When and from what a golden value was recorded.
#pragma once

#include <string>

namespace tensegric_fit::regression {

struct Stamp {
  std::string date;    ///< YYYY-MM-DD, UTC
  std::string commit;  ///< that was checked out, short, with "-dirty" where files differ from it; or unknown
};

/// Of now, and of the repository that the file lies in.
Stamp stamp_of(const std::string& file);

}  // namespace tensegric_fit::regression
