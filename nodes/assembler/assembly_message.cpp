#include "assembler/assembly_message.hpp"

#include <cstring>

namespace tensegric_fit::node {

sensor_msgs::PointCloud2 to_message(const std_msgs::Header& header, const assembler::Assembly& assembly) {
  constexpr const char* kFloats[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  sensor_msgs::PointCloud2 message;
  message.header = header;
  const auto add_field = [&message](const char* name, std::uint8_t type) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(sizeof(float) * message.fields.size());
    field.datatype = type;
    field.count = 1;
    message.fields.push_back(field);
  };
  for (const char* name : kFloats) add_field(name, sensor_msgs::PointField::FLOAT32);
  add_field("sensor", sensor_msgs::PointField::UINT8);
  message.point_step = static_cast<std::uint32_t>(sizeof(float) * message.fields.size());
  message.height = 1;
  message.width = static_cast<std::uint32_t>(assembly.cloud.points.size());
  message.row_step = message.width * message.point_step;
  message.is_dense = true;
  message.data.resize(message.row_step);
  std::uint8_t* at = message.data.data();
  for (std::size_t i = 0; i < assembly.cloud.points.size(); ++i, at += message.point_step) {
    Eigen::Matrix<float, 6, 1> values;
    values << assembly.cloud.points[i].cast<float>(), assembly.cloud.normals[i].cast<float>();
    std::memcpy(at, values.data(), sizeof(float) * values.size());
    at[message.fields.back().offset] = static_cast<std::uint8_t>(assembly.cloud.sensor[i]);
  }
  return message;
}

}  // namespace tensegric_fit::node
