/// Whether a worn scan is of the person that was simulated, standing as she stood.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "correlation/align.hpp"
#include "correlation/seen_surface.hpp"
#include "correlation/skin_parts.hpp"

namespace tensegric_fit::correlation {

/// A second scan of her, with the garment on. Only borrowed. Metres, its own frame.
struct WornBody {
  const geometry::TriangleMesh& mesh;
  const std::vector<char>& filled;  ///< empty, or one flag per vertex: 1 where the scan saw nothing
  const geometry::BodyMeasures& measures;
};

/// What ought to be the same in both scans. Pieces (see Pieces) are each aligned by themselves; nothing where
/// too little of one can be seen, or a landmark was not found.
struct Likeness {
  double still = 0;  ///< m; Alignment::residual of all still skin
  /// m; worn less simulated; NaN where either was not found
  double stature = std::numeric_limits<double>::quiet_NaN();
  double stature_half_width = 0;                ///< m, of that difference, 95 %
  std::optional<double> chest, pelvis, shanks;  ///< m; residuals of the pieces, of the worse shank
  std::optional<double> bend;                   ///< radians that the chest has turned against the pelvis
  std::optional<double> left_arm, right_arm;    ///< radians that an upper arm points another way
  double growth = 0;                            ///< m; of underbust and waist girth, the lesser
};

/// Largest values at which two scans are those of one person in one pose; README.md of this room has the
/// measurements behind each.
inline constexpr double kSamePiece = 0.003;    ///< m
inline constexpr double kSameShank = 0.0015;   ///< m
inline constexpr double kSameStill = 0.004;    ///< m
inline constexpr double kSameStature = 0.020;  ///< m; its half-width where that is more
inline constexpr double kSameBend = 4 * 3.14159265358979323846 / 180;
inline constexpr double kSameArm = 15 * 3.14159265358979323846 / 180;
inline constexpr double kCoat = 0.05;  ///< m of girth: 8 mm of cloth all round

/// `alignment`: of the still skin.
Likeness likeness_of(const SimulatedBody& body, const std::vector<SkinPart>& parts, const WornBody& worn,
                     const SeenSurface& surface, const Alignment& alignment);

/// \throw Refusal coat_on: underbust and waist are larger, stature and lower legs are not; other_person: a
/// piece does not match, or they do not together though she stands alike; other_pose: chest and pelvis match,
/// but not together, or an arm points elsewhere; too_few_data: neither chest nor pelvis can be compared
void check_same(const Likeness& likeness);

/// The points and normals of the deformed body at these vertices.
Patch patch_of(const SimulatedBody& body, const std::vector<int>& vertices);

/// Where the scan comes to lie by the two bodies' own frames: a start for align().
Eigen::Isometry3d by_body_frames(const SimulatedBody& body, const WornBody& worn);

}  // namespace tensegric_fit::correlation
