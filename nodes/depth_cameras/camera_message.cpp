#include "depth_cameras/camera_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

template <typename Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

void check_pixels(const sensor_msgs::Image& image) {
  static const std::map<std::string, std::size_t> kBytes = {{"16UC1", 2}, {"32FC1", 4}};
  const auto bytes = kBytes.find(image.encoding);
  if (bytes == kBytes.end())
    throw Refusal(
        refusal::kWrongFields,
        fmt::format("the depth image's encoding is '{}'; 16UC1 (millimetres) and 32FC1 (metres) are read",
                    image.encoding.substr(0, 40)));
  if (image.is_bigendian) throw Refusal(refusal::kWrongFields, "the depth image is big-endian");
  constexpr std::uint32_t kLargest = 8192, kMostPadding = 4096;  // pixels; bytes
  constexpr std::size_t kMostPixels = 1 << 24;
  if (image.width == 0 || image.height == 0 || image.width > kLargest || image.height > kLargest ||
      std::size_t{image.width} * image.height > kMostPixels || image.step < image.width * bytes->second ||
      image.step > image.width * bytes->second + kMostPadding || image.step % bytes->second != 0 ||
      image.data.size() != static_cast<std::size_t>(image.step) * image.height)
    throw Refusal(refusal::kBrokenFile,
                  fmt::format("the depth image of {} x {} pixels, {} bytes a row, has {} bytes", image.width,
                              image.height, image.step, image.data.size()));
}

bool is_same(const boost::array<double, 9>& one, const boost::array<double, 9>& other) {
  constexpr double kRounded = 1e-6;  // by drivers
  return std::equal(one.begin(), one.end(), other.begin(),
                    [](double a, double b) { return std::abs(a - b) <= kRounded; });
}

void check_lens(const sensor_msgs::CameraInfo& info) {
  const auto wrong = [](const std::string& why) { return Refusal(refusal::kWrongFields, why); };
  if (!all_finite(info.K) || !all_finite(info.P) || !all_finite(info.R) || !all_finite(info.D))
    throw wrong("CameraInfo has numbers that are not finite");
  if (!(info.K[0] > 0) || !(info.K[4] > 0))
    throw wrong("CameraInfo has no focal length in K: calibrate the camera");
  if (!(info.P[0] > 0) || !(info.P[5] > 0))
    throw wrong("CameraInfo has no focal length in P: calibrate the camera");
  if (info.P[8] != 0 || info.P[9] != 0 || info.P[10] != 1)
    throw wrong("the third row of P in CameraInfo does not begin with 0 0 1");
  if (!is_same(info.R, {0, 0, 0, 0, 0, 0, 0, 0, 0}) && !is_same(info.R, {1, 0, 0, 0, 1, 0, 0, 0, 1}))
    throw wrong("CameraInfo turns the image (R): depths are along the lens' own axis");
  if (info.binning_x > 1 || info.binning_y > 1 || info.roi.x_offset > 0 || info.roi.y_offset > 0)
    throw wrong("CameraInfo bins pixels or takes a part of them: send the whole image");
  static const std::map<std::string, std::set<std::size_t>> kModels = {{"plumb_bob", {4, 5}},
                                                                       {"rational_polynomial", {8, 12, 14}}};
  if (info.D.empty()) return;
  const auto model = kModels.find(info.distortion_model);
  if (model == kModels.end())
    throw wrong(fmt::format("the lens model '{}' is not known; plumb_bob and rational_polynomial are",
                            info.distortion_model.substr(0, 40)));
  if (model->second.count(info.D.size()) == 0)
    throw wrong(fmt::format("CameraInfo has {} numbers in D, which are none of '{}'", info.D.size(),
                            info.distortion_model));
}

}  // namespace

void check_depth_image(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  if (image.header.stamp.isZero()) throw Refusal(refusal::kNoStamp, "the depth image has no time stamp");
  check_pixels(image);
  if (info.width != image.width || info.height != image.height)
    throw Refusal(refusal::kWrongFields, fmt::format("CameraInfo is of {} x {} pixels, the image has {} x {}",
                                                     info.width, info.height, image.width, image.height));
  check_lens(info);
}

sensor_msgs::Image rectified(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  const bool straight_lens = std::all_of(info.D.begin(), info.D.end(), [](double d) { return d == 0; });
  if (straight_lens && info.K[0] == info.P[0] && info.K[2] == info.P[2] && info.K[4] == info.P[5] &&
      info.K[5] == info.P[6])
    return image;
  const cv::Mat_<double> camera(3, 3, const_cast<double*>(info.K.data())),
      wanted(3, 4, const_cast<double*>(info.P.data())), d(info.D, true);
  const cv::Size size(static_cast<int>(image.width), static_cast<int>(image.height));
  cv::Mat columns, rows;
  cv::initUndistortRectifyMap(camera, d, cv::Mat(), wanted.colRange(0, 3), size, CV_32FC1, columns, rows);
  const bool metres = image.encoding == "32FC1";
  const cv::Mat seen(size, metres ? CV_32FC1 : CV_16UC1, const_cast<std::uint8_t*>(image.data.data()),
                     image.step);
  sensor_msgs::Image result = image;
  cv::Mat straight(size, seen.type(), result.data.data(), result.step);
  cv::remap(seen, straight, columns, rows, cv::INTER_NEAREST, cv::BORDER_CONSTANT,
            metres ? std::numeric_limits<double>::quiet_NaN() : 0);
  return result;
}

}  // namespace tensegric_fit::node
