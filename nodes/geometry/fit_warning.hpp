/// What a fit gives a person to know beyond its figures: skin that folds, lines that do not hold.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// Codes of warnings: what is shown is no smooth skin.
namespace warning {
inline constexpr char kShelf[] = "shelf", kTurnedOver[] = "turned_over";
}
/// Codes of notices: the shape is sound, and somebody may want to know.
namespace notice {
inline constexpr char kSkinTurns[] = "skin_turns", kOverStretched[] = "over_stretched",
                      kPressedTogether[] = "pressed_together", kUnderConstricted[] = "under_constricted";
}
/// How a line is under-constricted.
namespace lack {
inline constexpr char kSlack[] = "slack", kLiftsOff[] = "lifts_off", kWeak[] = "weak";
}

struct FitWarning {
  std::string code;
  std::string line;  ///< of the garment: the nearest one, or the one that it is about; empty: none near
  std::string lack;  ///< of under_constricted, else empty
  Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();  ///< middle of the place, scan frame, m
  Eigen::Vector3d worn = Eigen::Vector3d::Zero();     ///< the same on the worn skin
  double area = 0;                                    ///< of the skin concerned, at rest, m^2
  double shelf_area = 0;                              ///< what of it is turned by more than 60 degrees, m^2
  /// Largest turn (rad), most or least stretch, tension, or the share of the line that came off the skin.
  double value = 0;
  std::vector<int> vertices{};  ///< of the body, the skin concerned, ascending

  bool is_warning() const { return code == warning::kShelf || code == warning::kTurnedOver; }
};

}  // namespace tensegric_fit::geometry
