/// How deep and how long JSON of others may be.
#include <gtest/gtest.h>

#include <string>

#include "geometry/json_text.hpp"

namespace tensegric_fit::geometry {
namespace {

std::string nested(int levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(JsonText, IsTakenToTheDeepestLevel) {
  EXPECT_FALSE(json_in(nested(kDeepestJson)).is_discarded());
  EXPECT_TRUE(json_in(nested(kDeepestJson + 1)).is_discarded());
  EXPECT_TRUE(json_in(nested(1 << 20)).is_discarded()) << "copies of it would end the process";
  EXPECT_TRUE(json_in("{\"a\": " + nested(kDeepestJson) + "}").is_discarded());
}

TEST(JsonText, BracketsInStringsAreNoLevels) {
  const std::string many(1000, '[');
  for (const std::string& text : {many, "\\\"" + many, many + "\\\\", "\\\\\\\"" + many})
    EXPECT_TRUE(json_in("[\"" + text + "\", {}]").is_array()) << text.substr(0, 6);
  EXPECT_TRUE(json_in("[\"\\\\\", " + nested(kDeepestJson) + "]").is_discarded()) << "the string has ended";
}

TEST(JsonText, WhatIsNoJsonIsDiscarded) {
  for (const char* text : {"", "[", "]", "{\"a\": }", "[1e999]", "\"\xff\"", "\"\\"})
    EXPECT_TRUE(json_in(text).is_discarded()) << text;
}

/// By the square of their number they would take hours.
TEST(JsonText, AMillionObjectsAreTaken) {
  std::string text = "[{}";
  for (int i = 1; i < 1000000; ++i) text += ",{}";
  EXPECT_EQ(json_in(text + "]").size(), 1000000u);
}

}  // namespace
}  // namespace tensegric_fit::geometry
