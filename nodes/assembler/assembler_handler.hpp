/// Clouds of a booth's sensors -> scan/points
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <tf2/buffer_core.h>

#include <string>
#include <vector>

#include "assembler/assembler.hpp"
#include "assembler/capture_join.hpp"
#include "ros/facts.hpp"
#include "ros/parameters.hpp"

namespace tensegric_fit::node {

class AssemblerHandler {
 public:
  struct Setup {
    std::vector<std::string> sensors;  ///< topics, column by column
    std::string frame_id;              ///< of the scan
    assembler::CaptureOptions capture;
    assembler::AssemblerOptions assembler;
  };

  /// \throw Refusal bad_option naming the parameter
  explicit AssemblerHandler(Parameters parameters);

  const Setup& setup() const { return setup_; }

  /// What that sensor sent; `now` as for assembler::CaptureJoin. \throw Refusal no_stamp, late_cloud, or as
  /// geometry::points_of, naming the sensor's topic
  void add(int sensor, const sensor_msgs::PointCloud2& message, double now);

  /// The next capture that is to be handled, if any.
  std::optional<assembler::Capture> next(double now) { return join_.next(now); }

  struct Output {
    sensor_msgs::PointCloud2::ConstPtr scan;
    Facts facts;
    std::string warning;  ///< why normals are left out, and which column stands off; else empty
  };
  /// `transforms` know where the sensors stood. \throw Refusal no_transform naming the sensor's topic; as
  /// assembler::assemble
  Output handle(const assembler::Capture& capture, const tf2::BufferCore& transforms) const;

 private:
  static Setup setup_from(Parameters& parameters);
  std::string off_calibration(const assembler::Registration& registration) const;
  Eigen::Isometry3d pose_of(int sensor, const assembler::SensorCloud& cloud,
                            const tf2::BufferCore& transforms) const;

  const Setup setup_;
  assembler::CaptureJoin join_;
};

/// Of a stamp in ns.
ros::Time time_of(std::uint64_t stamp);

}  // namespace tensegric_fit::node
