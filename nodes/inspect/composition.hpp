/// Pictures put together: before beside after, words, the scale of colours; as files.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace tensegric_fit::inspect {

/// Left and right with a narrow gap. \pre of one height, BGR
cv::Mat side_by_side(const cv::Mat& left, const cv::Mat& right);

/// The picture under a white strip with `text` (ASCII) in its middle.
cv::Mat with_caption(const cv::Mat& picture, const std::string& text);

/// The picture over white strips with `text` (ASCII) in as many lines as it needs, in the colour of warnings;
/// without text the picture alone.
cv::Mat with_note(const cv::Mat& picture, const std::string& text);

/// The picture over a white strip with the fixed scale of distortion_colour: per cent, "pressed
/// together" and "stretched".
cv::Mat with_distortion_scale(const cv::Mat& picture);

/// The same with the fixed scale of distance_colour, millimetres.
cv::Mat with_distance_scale(const cv::Mat& picture);

/// The picture (8 bits, BGR) as a PNG file's bytes. \throw std::runtime_error: it cannot be encoded
std::string png_bytes(const cv::Mat& picture);

}  // namespace tensegric_fit::inspect
