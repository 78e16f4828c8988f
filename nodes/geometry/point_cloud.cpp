#include "geometry/point_cloud.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "geometry/point_fields.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

using Field = pcl::PCLPointField;

template <typename T>
double value_at(const std::uint8_t* from, bool swap) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

std::size_t size_of(const Field& field) {
  return field.datatype == Field::FLOAT64 ? 8 : 4;
}

const Field* find_field(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(), [&](const Field& field) {
    return field.name == name && (field.datatype == Field::FLOAT32 || field.datatype == Field::FLOAT64);
  });
  return found == cloud.fields.end() ? nullptr : &*found;
}

std::optional<std::array<const Field*, 3>> find_fields(const pcl::PCLPointCloud2& cloud,
                                                       const std::array<const char*, 3>& names) {
  std::array<const Field*, 3> fields;
  for (int i = 0; i < 3; ++i) {
    fields[i] = find_field(cloud, names[i]);
    if (fields[i] == nullptr) return std::nullopt;
    if (fields[i]->offset + size_of(*fields[i]) > cloud.point_step)
      throw Refusal(refusal::kWrongFields, "field '" + fields[i]->name + "' lies outside the point step");
  }
  return fields;
}

/// Calls `take` with the bytes of each point. \pre check_size
template <typename Take>
void for_each_point(const pcl::PCLPointCloud2& cloud, const Take& take) {
  if (cloud.width == 0) return;  // any number of rows
  for (std::size_t row = 0; row < cloud.height; ++row)
    for (std::size_t column = 0; column < cloud.width; ++column)
      take(cloud.data.data() + row * cloud.row_step + column * cloud.point_step);
}

std::vector<Eigen::Vector3d> triples(const pcl::PCLPointCloud2& cloud,
                                     const std::array<const Field*, 3>& fields) {
  const bool host_is_big = pcl::PCLPointCloud2().is_bigendian != 0;
  const bool swap = (cloud.is_bigendian != 0) != host_is_big;
  std::vector<Eigen::Vector3d> result;
  result.reserve(static_cast<std::size_t>(cloud.width) * cloud.height);
  for_each_point(cloud, [&](const std::uint8_t* point) {
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) {
      const std::uint8_t* from = point + fields[i]->offset;
      value[i] =
          fields[i]->datatype == Field::FLOAT64 ? value_at<double>(from, swap) : value_at<float>(from, swap);
    }
    result.push_back(value);
  });
  return result;
}

const Field* find_sensor(const pcl::PCLPointCloud2& cloud) {
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(), [&](const Field& field) {
    return field.name == "sensor" && field.datatype == Field::UINT8;
  });
  if (found == cloud.fields.end()) return nullptr;
  if (found->offset >= cloud.point_step)
    throw Refusal(refusal::kWrongFields, "field 'sensor' lies outside the point step");
  return &*found;
}

std::vector<int> bytes(const pcl::PCLPointCloud2& cloud, const Field& field) {
  std::vector<int> result;
  result.reserve(static_cast<std::size_t>(cloud.width) * cloud.height);
  for_each_point(cloud, [&](const std::uint8_t* point) { result.push_back(point[field.offset]); });
  return result;
}

// The last row may lack its padding; the row step of a single row is irrelevant.
void check_size(const pcl::PCLPointCloud2& cloud) {
  const std::size_t rows = cloud.width == 0 ? 0 : cloud.height,
                    row = static_cast<std::size_t>(cloud.width) * cloud.point_step,
                    step = rows > 1 ? cloud.row_step : std::max<std::size_t>(row, cloud.row_step);
  const std::size_t least = rows == 0 ? 0 : (rows - 1) * step + row;
  if ((rows > 1 && step < row) || cloud.data.size() < least)
    throw Refusal(refusal::kBrokenFile,
                  "the cloud's data are shorter than its width, height and steps require");
  if (cloud.data.size() > rows * step)
    throw Refusal(refusal::kBrokenFile,
                  "the cloud's data are longer than its width, height and steps require");
}

}  // namespace

PointFields fields_of(const pcl::PCLPointCloud2& cloud) {
  const auto xyz = find_fields(cloud, {"x", "y", "z"});
  if (!xyz)
    throw Refusal(refusal::kWrongFields, "the cloud has no fields x, y, z of type float32 or float64");
  check_size(cloud);
  auto normals = find_fields(cloud, {"normal_x", "normal_y", "normal_z"});
  if (!normals) normals = find_fields(cloud, {"nx", "ny", "nz"});
  return {*xyz, normals};
}

PointCloud points_of(const pcl::PCLPointCloud2& cloud) {
  const PointFields fields = fields_of(cloud);
  PointCloud result;
  result.points = triples(cloud, fields.position);
  if (fields.normal) result.normals = triples(cloud, *fields.normal);
  if (const Field* sensor = find_sensor(cloud)) result.sensor = bytes(cloud, *sensor);
  return result;
}

PointCloud joined(const std::vector<PointCloud>& clouds) {
  if (clouds.size() == 1) return clouds.front();
  const auto any = [&](const auto& has) { return std::any_of(clouds.begin(), clouds.end(), has); };
  const bool normals = any([](const PointCloud& c) { return !c.normals.empty(); });
  const bool sensors = any([](const PointCloud& c) { return !c.sensor.empty(); });
  PointCloud result;
  int first = 0;  // index of the next cloud's sensor 0
  for (const PointCloud& cloud : clouds) {
    if (cloud.points.empty())
      throw Refusal(refusal::kEmptyCloud,
                    "one of the " + std::to_string(clouds.size()) + " scans has no points");
    result.points.insert(result.points.end(), cloud.points.begin(), cloud.points.end());
    result.normals.insert(result.normals.end(), cloud.normals.begin(), cloud.normals.end());
    if (normals) result.normals.resize(result.points.size(), Eigen::Vector3d::Zero());
    for (const int sensor : cloud.sensor) result.sensor.push_back(sensor < 0 ? sensor : first + sensor);
    if (sensors) result.sensor.resize(result.points.size(), -1);
    if (!cloud.sensor.empty())
      first += 1 + std::max(-1, *std::max_element(cloud.sensor.begin(), cloud.sensor.end()));
  }
  return result;
}

}  // namespace tensegric_fit::geometry
