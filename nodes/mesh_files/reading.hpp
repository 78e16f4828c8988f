/// How a file's numbers are read as a standing person: unit and axes.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// What was asked for: empty is to be inferred. Units: m, cm, mm, inch. Up: x, y, z, -x, -y, -z.
struct Asked {
  std::string unit, up;
};

/// A reading of a file's numbers. Inferred is what was not asked for.
struct Reading {
  std::string unit = "m";
  std::string up = "z";

  double metres() const;  ///< per unit of the file
  Eigen::Matrix3d turn()
      const;  ///< the file's axes to z up: the identity for z, y and z swapped for y (x stays)
  /// As float32, which a PLY of the same body has: the last digits of other units are none of the body's.
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const;
  bool is_identity() const { return unit == "m" && up == "z"; }
};

/// Whether the points lie evenly on a person alone, as a mesh's samples do; which way is up in files of that
/// kind where the shape does not say ("" where any may be). any_size: their size in a given unit is not
/// checked.
struct Kind {
  bool surface = false;
  std::string usual_up = "z";
  bool any_size = false;
};

/// The rule. Unit: that in which the longest extent is a stature, 1.2 to 2.2 m; where none is, that in which
/// it is 0.4 to 4 m (parts of a person, a booth's floor); metres below 0.4. Up: the longest extent where z
/// has not half of it; of a surface any extent of at least 0.8 of it, and the end that widens fastest, from
/// head to shoulders, is the upper one. \param points not empty, any unit \throw Refusal wrong_unit,
/// wrong_axes: two readings fit, and which; wrong_unit also where a given unit makes the scan larger than 8 m
/// or smaller than 10 cm; bad_option: unknown names
Reading infer_reading(const std::vector<Eigen::Vector3d>& points, const Kind& kind, const Asked& asked);

/// Unit names and axes that may be asked for. \throw Refusal bad_option
void check_asked(const Asked& asked);

}  // namespace tensegric_fit::mesh_files
