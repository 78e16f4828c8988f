/// Where the coordinates of a PointCloud2 lie.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <optional>

namespace tensegric_fit::geometry {

/// The fields that points_of() (point_cloud.hpp) reads: within the point step, float32 or float64. Valid as
/// long as the cloud's own.
struct PointFields {
  std::array<const pcl::PCLPointField*, 3> position;
  std::optional<std::array<const pcl::PCLPointField*, 3>> normal;
};

/// \throw Refusal as points_of
PointFields fields_of(const pcl::PCLPointCloud2& cloud);

}  // namespace tensegric_fit::geometry
