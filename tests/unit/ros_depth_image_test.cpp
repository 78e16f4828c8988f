/// What a depth camera sends is looked at before OpenCV is given it.
#include <gtest/gtest.h>

#include "depth_cameras/camera_message.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

sensor_msgs::Image image_of(std::uint32_t step) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(1, 0);
  image.encoding = "16UC1";
  image.width = 2;
  image.height = 1;
  image.step = step;
  image.data.assign(step, 0);
  return image;
}

sensor_msgs::CameraInfo lens() {
  sensor_msgs::CameraInfo info;
  info.width = 2;
  info.height = 1;
  info.K = {500, 0, 1, 0, 500, 0.5, 0, 0, 1};
  info.P = {500, 0, 1, 0, 0, 500, 0.5, 0, 0, 0, 1, 0};
  info.distortion_model = "plumb_bob";
  info.D = {0.1, 0, 0, 0, 0};
  return info;
}

TEST(DepthImage, RowsThatEndWithinAPixelAreRefused) {
  for (const std::uint32_t step : {4, 6}) {
    check_depth_image(image_of(step), lens());
    EXPECT_EQ(rectified(image_of(step), lens()).data.size(), step);
  }
  EXPECT_THROW(check_depth_image(image_of(5), lens()), geometry::Refusal)
      << "cv::Mat threw, and the node ended";
}

}  // namespace
}  // namespace tensegric_fit::node
