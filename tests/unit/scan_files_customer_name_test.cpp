/// The booth's own customer id in names of files.
#include <gtest/gtest.h>

#include "geometry/status.hpp"
#include "scan_files/customer_name.hpp"

namespace tensegric_fit::scan_files {
namespace {

TEST(CustomerName, TheGroupIsTheId) {
  const std::regex pattern = customer_pattern("^([^_]+)_");
  EXPECT_EQ(customer_in("/in_box/4711_left.ply", pattern), "4711") << "the name alone, not the folder";
  EXPECT_EQ(customer_in("left.ply", pattern), "");
  EXPECT_EQ(customer_in("4711_left.ply", customer_pattern("")), "");
}

TEST(CustomerName, WhatIsNoPatternIsRefused) {
  for (const char* bad : {"(", "^[0-9]+_", "(a)(b)", "([0-9"})
    EXPECT_THROW(customer_pattern(bad), geometry::Refusal) << bad;
}

}  // namespace
}  // namespace tensegric_fit::scan_files
