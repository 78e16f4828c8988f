/// Where a camera must stand to show a body, or the part of it that a garment changes, from one side.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tensegric_fit::inspect {

enum class From { front, her_left, back, her_right };

/// A camera that looks at a point from a distance, scan frame, metres and radians: yaw about z from x, pitch
/// upwards.
struct OrbitView {
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();
  double distance = 0, yaw = 0, pitch = 0;
};

/// So that all points, and `margin` metres about them, are in a picture of a field of view of `angle` radians
/// in its narrower direction. `body_from_scan`: where she stands and faces. \pre not empty
OrbitView framed(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& body_from_scan,
                 From from, double margin, double angle);

/// Whether most of the points lie behind the middle of the skin. Scan frame. \pre neither is empty
bool lie_behind(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan);

/// Whether somebody stands or faces clearly otherwise: by more than 0.2 m or 15 degrees.
bool is_moved(const Eigen::Isometry3d& body_from_scan, const Eigen::Isometry3d& before);

}  // namespace tensegric_fit::inspect
