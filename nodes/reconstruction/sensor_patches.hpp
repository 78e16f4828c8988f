/// What each sensor sees of the same patches of skin.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace tensegric_fit::reconstruction {

/// A patch's skin over its plane, terms 1, x, y, xx, xy, yy.
using Surface = Eigen::Matrix<double, 6, 1>;

/// A round patch; x and y run along it, in units of its radius.
struct Patch {
  Eigen::Vector3d centre, normal, x, y;
  std::size_t begin, end;  ///< its sheets
};

/// What one sensor sees of a patch: sums over its points.
struct SensorPatch {
  int sensor;
  double count;
  Eigen::Matrix<double, 6, 6> gram;  ///< of the surface's terms
  Surface heights;                   ///< terms times height over the patch, m
  double squares;                    ///< of the heights, m^2
};

struct SensorPatches {
  std::vector<Patch> patches;
  std::vector<SensorPatch> sheets;  ///< patch by patch
};

/// Patches all over the points that at least two of the sensors, numbered from 0, see. With `normals` (one
/// per point) a patch has those points only that face its way; without, it is left out unless it is flat. One
/// in `step` cubes as wide as a patch's radius has a patch.
SensorPatches sensor_patches_of(const std::vector<Eigen::Vector3d>& points,
                                const std::vector<Eigen::Vector3d>& normals,
                                const std::vector<int>& sensor_of, int sensors, double radius, int step);

/// Least squares of a patch's sheets, each counted by its weight, about the surface that fits them best, in
/// the first three terms that may be added to each sheet's heights.
class PatchEquations {
 public:
  /// All count alike.
  void set(const SensorPatches& all, const Patch& patch);
  /// `heights` and `weights`: one per sheet of the patch, in place of its own heights.
  void set(const SensorPatches& all, const Patch& patch, const std::vector<Surface>& heights,
           const double* weights);

  /// What sheet j's terms add to the equations of sheet i's.
  Eigen::Matrix3d squares(std::size_t i, std::size_t j) const;
  /// What is on the right of sheet i's equations.
  Eigen::Vector3d right(std::size_t i) const;
  /// Mean distance of sheet i from the surface, m.
  double difference(std::size_t i) const;
  /// Deviation of its points from the surface that is moved by this difference, m.
  double thickness(std::size_t i) const;

 private:
  const SensorPatch* sheets_ = nullptr;
  std::vector<double> weights_;
  std::vector<Surface> heights_;
  Surface surface_;
  std::vector<Surface> left_;                        // heights less the surface's
  std::vector<Eigen::Matrix<double, 6, 3>> solved_;  // what the surface follows a sheet's terms by
};

}  // namespace tensegric_fit::reconstruction
