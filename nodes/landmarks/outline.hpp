/// A closed loop of a horizontal section, and what can be said of it in its plane.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/section.hpp"

namespace tensegric_fit::landmarks {

/// Counter-clockwise seen from above, in metres; all points have the section's height.
struct Outline {
  std::vector<Eigen::Vector3d> points;
  double area = 0;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  Eigen::Vector2d low, high;  ///< box around the points
};

/// \pre at least three points
Outline outline_of(std::vector<Eigen::Vector3d> points);

/// The closed loops that run round material, largest area first.
std::vector<Outline> outlines_of(const std::vector<geometry::SectionLoop>& loops);

bool contains(const Outline& outline, const Eigen::Vector2d& point);

/// Area times covariance of the enclosed area about `centre`.
Eigen::Matrix2d second_moment(const Outline& outline, const Eigen::Vector2d& centre);

/// Length of a tape round all the points of horizontal outlines.
double tape_length(const std::vector<Outline>& outlines);

/// The loop of that tape.
std::vector<Eigen::Vector3d> tape_loop(const std::vector<Outline>& outlines);

}  // namespace tensegric_fit::landmarks
