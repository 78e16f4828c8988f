/// Plane sections of a mesh and the tape measure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// A polyline where a plane cuts a mesh. Closed ones do not repeat their first point.
/// `triangles[i]` is the triangle that holds the segment from points[i] to the next point.
struct SectionLoop {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> triangles;
  bool closed;
};

/// All loops of the plane through `origin` with unit normal `normal`, in a fixed order. A vertex that lies on
/// the plane counts as above it, so the section is always a set of simple polylines. Closed loops run
/// counter-clockwise seen from the tip of `normal`, around the mesh's interior.
std::vector<SectionLoop> plane_section(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& normal);

/// Whether a loop runs round the mesh's interior: one that runs round a hollow within turns the other way.
/// One that a hole leaves open is closed by a straight line. `normal` as for its section.
bool is_outline(const SectionLoop& loop, const Eigen::Vector3d& normal);

/// Length of a polyline, with the closing segment if closed. Metres.
double length_of(const std::vector<Eigen::Vector3d>& points, bool closed);

/// m, from a point to an open polyline; infinite where that has fewer than two points.
double distance_to_line(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& line);

/// A polyline of even steps convolved with a Gaussian of standard deviation `deviation` steps, truncated at
/// `reach` steps; beyond the ends the end points are repeated.
std::vector<Eigen::Vector3d> smoothed(const std::vector<Eigen::Vector3d>& line, double deviation, int reach);

/// Convex hull in a plane, counter-clockwise, without collinear points.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// Convex hull of points near a plane, as a loop in 3D: a tape pulled round them. \pre normal is a unit
/// vector
std::vector<Eigen::Vector3d> tape(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal);

}  // namespace tensegric_fit::geometry
