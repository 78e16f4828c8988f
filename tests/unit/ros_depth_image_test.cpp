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

/// P may be of another focal length than K, with a lens that distorts nothing: the image is as P says.
TEST(DepthImage, AnImageIsMadeAsPSaysWhateverTheLens) {
  sensor_msgs::CameraInfo info = lens();
  info.D.clear();
  info.width = 9;
  info.height = 1;
  info.K = {8, 0, 4, 0, 8, 0, 0, 0, 1};
  info.P = {4, 0, 4, 0, 0, 4, 0, 0, 0, 0, 1, 0};
  sensor_msgs::Image image = image_of(18);
  image.width = 9;
  image.data[2 * 6] = 77;  // 2 pixels, of 8 a unit, from the middle
  check_depth_image(image, info);
  const sensor_msgs::Image made = rectified(image, info);
  EXPECT_EQ(made.data[2 * 5], 77);  // 1 pixel, of 4 a unit
  info.P[0] = info.P[5] = 8;
  EXPECT_EQ(rectified(image, info).data, image.data);
}

TEST(DepthImage, WhatTurnsBinsOrCutsTheImageIsRefused) {
  const auto is_refused = [](const sensor_msgs::CameraInfo& info) {
    try {
      check_depth_image(image_of(4), info);
      return false;
    } catch (const geometry::Refusal& refusal) {
      return refusal.code() == std::string(geometry::refusal::kWrongFields);
    }
  };
  sensor_msgs::CameraInfo info = lens();
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_FALSE(is_refused(info));
  info.R = {0.9998, 0, 0.0175, 0, 1, 0, -0.0175, 0, 0.9998};  // a degree: 10 mm at 1.2 m
  EXPECT_TRUE(is_refused(info));
  info = lens();
  info.binning_x = 2;
  EXPECT_TRUE(is_refused(info));
  info = lens();
  info.roi.x_offset = 1;
  EXPECT_TRUE(is_refused(info));
}

}  // namespace
}  // namespace tensegric_fit::node
