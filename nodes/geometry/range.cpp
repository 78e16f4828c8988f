#include "geometry/range.hpp"

#include <sstream>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {

void check_option(const std::string& name, double value, const Range& range) {
  if (range.holds(value)) return;
  std::ostringstream message;
  message << "option '" << name << "' is " << value << "; it must lie in [" << range.low << ", " << range.high
          << "]";
  throw Refusal(refusal::kBadOption, message.str());
}

}  // namespace tensegric_fit::geometry
