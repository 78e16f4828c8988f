/// What an action is refused by.
#pragma once

#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit {

/// The code of the refusal that `action` throws, "accepted" where it throws none.
template <typename Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

}  // namespace tensegric_fit
