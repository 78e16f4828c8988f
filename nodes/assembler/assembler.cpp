#include "assembler/assembler.hpp"

#include <fmt/format.h>

#include "assembler/viewpoint_normals.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::assembler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::PointCloud;

void check_columns(std::size_t sensors, int per_column) {
  if (per_column >= 1 && sensors % static_cast<std::size_t>(per_column) == 0) return;
  throw geometry::Refusal(
      geometry::refusal::kBadOption,
      fmt::format("assembler option 'sensors_per_column' is {}; {} sensors are no whole number of columns",
                  per_column, sensors));
}

PointCloud in_booth(const PointCloud& seen, const Isometry3d& booth_from_sensor) {
  PointCloud cloud;
  for (const Vector3d& p : seen.points)
    if (p.allFinite()) cloud.points.push_back(booth_from_sensor * p);
  cloud.normals = viewpoint_normals(cloud.points, booth_from_sensor.translation());
  return cloud;
}

void append(PointCloud& cloud, const PointCloud& more) {
  cloud.points.insert(cloud.points.end(), more.points.begin(), more.points.end());
  cloud.normals.insert(cloud.normals.end(), more.normals.begin(), more.normals.end());
}

void move(PointCloud& cloud, const Isometry3d& by) {
  for (Vector3d& p : cloud.points) p = by * p;
  for (Vector3d& n : cloud.normals) n = by.linear() * n;
}

}  // namespace

Assembly assemble(const Capture& capture, const std::vector<Isometry3d>& booth_from_sensor,
                  const AssemblerOptions& options) {
  check_columns(capture.clouds.size(), options.sensors_per_column);
  Assembly assembly;
  // 1. Columns in the booth's frame, with normals.
  std::vector<PointCloud> clouds(capture.clouds.size());
  geometry::parallel_for(clouds.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t sensor = begin; sensor < end; ++sensor)
      if (capture.clouds[sensor])
        clouds[sensor] = in_booth(capture.clouds[sensor]->cloud, booth_from_sensor[sensor]);
  });
  std::vector<PointCloud> columns(clouds.size() / options.sensors_per_column);
  for (std::size_t sensor = 0; sensor < clouds.size(); ++sensor) {
    append(columns[sensor / options.sensors_per_column], clouds[sensor]);
    assembly.cloud.sensor.insert(assembly.cloud.sensor.end(), clouds[sensor].points.size(),
                                 static_cast<int>(sensor));
  }
  // 2. Their corrections.
  if (options.refine) {
    assembly.registration = register_columns(columns, options.registration);
    for (std::size_t c = 0; c < columns.size(); ++c) move(columns[c], assembly.registration->corrections[c]);
  }
  // 3. One cloud.
  for (const PointCloud& column : columns) append(assembly.cloud, column);
  return assembly;
}

}  // namespace tensegric_fit::assembler
