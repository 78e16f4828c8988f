/// Left and right of the body.
#pragma once

namespace tensegric_fit::geometry {

enum Side { kLeft = 0, kRight = 1 };
inline constexpr Side kSides[2] = {kLeft, kRight};
inline constexpr double kSign[2] = {1, -1};  ///< of y in the body's frame
inline constexpr const char* kSuffix[2] = {"_L", "_R"};

}  // namespace tensegric_fit::geometry
