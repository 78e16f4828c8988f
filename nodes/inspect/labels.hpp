/// Names beside a picture.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {

struct Label {
  enum class Mark { dot, ring, none };

  std::string text;    ///< ASCII
  Eigen::Vector2d at;  ///< what it names, in pixels of the picture
  Colour colour;
  Mark mark;
};

/// The picture between two white margins with the names in them, each in the margin that is nearer, joined by
/// a thin line to what it names. No two names touch as long as the picture has 16 rows of pixels for each.
cv::Mat with_labels(const cv::Mat& picture, const std::vector<Label>& labels);

}  // namespace tensegric_fit::inspect
