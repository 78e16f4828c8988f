/// What a depth camera sends.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace tensegric_fit::node {

/// Depth along the optical axis: 16UC1 in millimetres, 0 where nothing was seen, or 32FC1 in metres, NaN
/// there; and the lens as plumb_bob or rational_polynomial. depth_image_proc ends the process on some of
/// what is refused here. \throw Refusal no_stamp, broken_file (lengths), wrong_fields (another
/// encoding; CameraInfo of another size, without focal length, of another lens model, that turns the image
/// (R), bins pixels or takes a part of them: there would be no usable points, or wrong ones)
void check_depth_image(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info);

/// As a camera without lens distortion, with the matrix P, would see it: each pixel has the depth of the
/// nearest one, as depths of two surfaces have no mean between them. image_proc's own takes the pixel below,
/// which moves images by half a pixel. \pre check_depth_image passes
sensor_msgs::Image rectified(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info);

}  // namespace tensegric_fit::node
