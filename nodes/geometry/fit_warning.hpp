/// Warnings and notices of a fit: skin that folds, lines that do not hold.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// Codes of warnings: the shape shown is not smooth skin.
namespace warning {
inline constexpr char kShelf[] = "shelf", kTurnedOver[] = "turned_over", kSkinCrosses[] = "skin_crosses";
}
/// Codes of notices: the shape is sound, but something may need attention.
namespace notice {
inline constexpr char kSkinTurns[] = "skin_turns", kOverStretched[] = "over_stretched",
                      kPressedTogether[] = "pressed_together", kUnderConstricted[] = "under_constricted",
                      kSkinOverLine[] = "skin_over_line", kNotScanned[] = "not_scanned";
}
/// How a line is under-constricted.
namespace lack {
inline constexpr char kSlack[] = "slack", kLiftsOff[] = "lifts_off", kWeak[] = "weak";
}

struct FitWarning {
  std::string code;
  std::string line;  ///< garment line concerned, or the nearest one; empty: none nearby
  std::string lack;  ///< of under_constricted, else empty
  Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();  ///< centre of the skin concerned, scan frame, m
  Eigen::Vector3d worn = Eigen::Vector3d::Zero();     ///< the same on the worn skin
  double area = 0;                                    ///< of the skin concerned, at rest, m^2
  double shelf_area = 0;  ///< part of it that is turned by more than 60 degrees, m^2
  /// By code: largest turn (rad), depth (m), largest or least stretch, tension (pseudo force), or the share
  /// of the line that came off the skin, or lies over skin that was not scanned.
  double value = 0;
  std::vector<int> vertices{};  ///< of the body: the skin concerned, ascending

  bool is_warning() const {
    return code == warning::kShelf || code == warning::kTurnedOver || code == warning::kSkinCrosses;
  }
};

}  // namespace tensegric_fit::geometry
