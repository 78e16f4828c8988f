#include "assembler/assembler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "geometry/moved_cloud.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/principal_axes.hpp"
#include "geometry/scan_extent.hpp"
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

/// Of the planes through each point's neighbours, towards the side from which all were seen.
std::vector<Vector3d> viewpoint_normals(const std::vector<Vector3d>& points, const Vector3d& viewpoint) {
  constexpr int kNeighbours = 16;
  std::vector<Vector3d> normals(points.size());
  if (points.empty()) return normals;
  const geometry::PointTree tree(points);
  std::vector<int> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.nearest(points[i], kNeighbours, near);
    const Vector3d normal =
        geometry::principal_axes(points, near, points[near.front()]).eigenvectors().col(0);
    normals[i] = normal.dot(viewpoint - points[i]) < 0 ? Vector3d(-normal) : normal;
  }
  return normals;
}

/// Of many points in one place all but the first: to look for the nearest ones there would take the square of
/// their number.
void drop_repeats(std::vector<Vector3d>& points) {
  constexpr std::size_t kMost = 16;
  std::map<std::array<double, 3>, std::size_t> places;
  std::vector<std::array<double, 3>> sorted;
  for (const Vector3d& p : points) sorted.push_back({p.x(), p.y(), p.z()});
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = kMost; i < sorted.size(); ++i)
    if (sorted[i] == sorted[i - kMost]) places[sorted[i]] = 0;
  if (places.empty()) return;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&places](const Vector3d& p) {
                                const auto place = places.find({p.x(), p.y(), p.z()});
                                return place != places.end() && place->second++ > 0;
                              }),
               points.end());
}

PointCloud in_booth(const PointCloud& seen, const Isometry3d& booth_from_sensor) {
  PointCloud cloud;
  for (const Vector3d& p : seen.points) {
    const Vector3d q = booth_from_sensor * p;
    if (q.allFinite() && q.cwiseAbs().maxCoeff() < geometry::kFarthestFromOrigin) cloud.points.push_back(q);
  }
  drop_repeats(cloud.points);
  cloud.normals = viewpoint_normals(cloud.points, booth_from_sensor.translation());
  return cloud;
}

/// \throw Refusal no_transform: it saw something, and nothing of that is near the booth
void check_place(const SensorCloud& sent, const PointCloud& placed) {
  const auto& seen = sent.cloud.points;
  if (!placed.points.empty() ||
      std::none_of(seen.begin(), seen.end(), [](const Vector3d& p) { return p.allFinite(); }))
    return;
  throw geometry::Refusal(
      geometry::refusal::kNoTransform,
      fmt::format("no point of the cloud in frame '{}' lies within {:.0f} km of the booth: its points, or "
                  "where its sensor stands, are wrong",
                  sent.frame_id, geometry::kFarthestFromOrigin / 1000));
}

}  // namespace

Assembly assemble(const Capture& capture, const std::vector<Isometry3d>& booth_from_sensor,
                  const AssemblerOptions& options, const std::vector<SharedFrame>& shared) {
  check_columns(capture.clouds.size(), options.sensors_per_column);
  Assembly assembly;
  // 1. Columns in the booth's frame, with normals.
  std::vector<PointCloud> clouds(capture.clouds.size());
  geometry::parallel_for(clouds.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t sensor = begin; sensor < end; ++sensor)
      if (capture.clouds[sensor])
        clouds[sensor] = in_booth(capture.clouds[sensor]->cloud, booth_from_sensor[sensor]);
  });
  for (std::size_t sensor = 0; sensor < clouds.size(); ++sensor)
    if (capture.clouds[sensor]) check_place(*capture.clouds[sensor], clouds[sensor]);
  std::vector<bool> lost(clouds.size());  // where the sensor stood
  for (const SharedFrame& frame : shared)
    for (const int sensor : frame.sensors) lost[sensor] = true;
  std::vector<PointCloud> columns(clouds.size() / options.sensors_per_column);
  std::vector<bool> signless(columns.size());
  for (std::size_t sensor = 0; sensor < clouds.size(); ++sensor) {
    const std::size_t column = sensor / options.sensors_per_column;
    geometry::append(columns[column], clouds[sensor]);
    if (lost[sensor]) signless[column] = true;
    assembly.cloud.sensor.insert(assembly.cloud.sensor.end(), clouds[sensor].points.size(),
                                 static_cast<int>(sensor));
  }
  // 2. Their corrections.
  if (options.refine) {
    assembly.registration = register_columns(columns, options.registration, signless);
    for (std::size_t c = 0; c < columns.size(); ++c)
      geometry::move(columns[c], assembly.registration->corrections[c]);
  }
  // 3. One cloud. A normal that may point into the body is worse than none.
  for (const PointCloud& column : columns) geometry::append(assembly.cloud, column);
  if (assembly.cloud.points.empty())
    throw geometry::Refusal(geometry::refusal::kEmptyCloud, "no sensor saw anything");
  for (std::size_t i = 0; i < assembly.cloud.normals.size(); ++i)
    if (lost[assembly.cloud.sensor[i]]) assembly.cloud.normals[i].setZero();
  return assembly;
}

}  // namespace tensegric_fit::assembler
