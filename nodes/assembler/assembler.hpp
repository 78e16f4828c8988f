/// One scan of what a booth's sensors saw.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "assembler/capture_join.hpp"
#include "assembler/registration.hpp"
#include "assembler/shared_frames.hpp"

namespace tensegric_fit::assembler {

/// Field defaults are the parameters' defaults.
struct AssemblerOptions {
  bool refine = true;          ///< whether columns are moved onto each other where they overlap
  int sensors_per_column = 1;  ///< sensors are listed column by column; those of one column move as one
  RegistrationOptions registration;
};

struct Assembly {
  /// In the booth's frame, each normal towards its own sensor; zero where it is unknown where that stood.
  geometry::PointCloud cloud;
  std::optional<Registration> registration;  ///< one correction per column; none where not asked for
};

/// Brings the clouds of a capture into the booth's frame. `booth_from_sensor` has one transform per sensor;
/// those of missing sensors are not looked at. Where the sensors of `shared` stood is unknown. Points that
/// are not finite, or more than 10 km away, are left out. \throw Refusal bad_option: the sensors are not
/// whole columns, or an option of register_columns; no_transform: what a sensor saw lies more than 10 km from
/// the booth; empty_cloud: none saw anything
Assembly assemble(const Capture& capture, const std::vector<Eigen::Isometry3d>& booth_from_sensor,
                  const AssemblerOptions& options, const std::vector<SharedFrame>& shared = {});

}  // namespace tensegric_fit::assembler
