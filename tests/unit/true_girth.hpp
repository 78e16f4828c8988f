/// The truth of virtual women, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit {

inline double true_girth(const virtual_body::VirtualBody& body, const std::string& name) {
  for (const geometry::Measure& measure : body.truth.girths)
    if (measure.name == name) return measure.metres;
  ADD_FAILURE() << "no girth " << name;
  return 0;
}

}  // namespace tensegric_fit
