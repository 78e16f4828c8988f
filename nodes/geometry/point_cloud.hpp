/// Points of a scan, as all stages use them.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::geometry {

/// Points in metres, in the scan's frame. `normals` is empty or has one unit vector per point; `sensor` is
/// empty or has the index of the sensor that saw each point, from 0, or -1.
struct PointCloud {
  std::vector<Eigen::Vector3d> points = {};
  std::vector<Eigen::Vector3d> normals = {};
  std::vector<int> sensor = {};
};

/// The x, y, z (and normal_x, normal_y, normal_z or nx, ny, nz where all three are there) of a cloud, float32
/// or float64, in either byte order, with any other fields, padding or organisation. No point is dropped: NaN
/// stay NaN. A field `sensor` of type uint8 is the index of the sensor that saw each point.
/// \throw Refusal wrong_fields: no x, y, z of a floating type; broken_file: the data are shorter or longer
/// than the layout says
PointCloud points_of(const pcl::PCLPointCloud2& cloud);

/// Clouds of one person in one frame as one. Where only some clouds have normals or sensors, the others get
/// zero normals and sensors of -1; two clouds never share a sensor index. \throw Refusal empty_cloud: one of
/// several has no points
PointCloud joined(const std::vector<PointCloud>& clouds);

}  // namespace tensegric_fit::geometry
