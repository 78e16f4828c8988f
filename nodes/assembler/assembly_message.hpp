/// An assembled scan as a message.
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include "assembler/assembler.hpp"

namespace tensegric_fit::node {

/// x y z normal_x normal_y normal_z as float32, sensor as uint8.
sensor_msgs::PointCloud2 to_message(const std_msgs::Header& header, const assembler::Assembly& assembly);

}  // namespace tensegric_fit::node
