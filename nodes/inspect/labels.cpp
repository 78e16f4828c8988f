#include "inspect/labels.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tensegric_fit::inspect {
namespace {

constexpr int kLabelMargin = 190;  // pixels
constexpr int kRow = 16;
constexpr int kBeside = 8;        // between a name and its line
constexpr double kMiddle = 0.02;  // of the width; what is so near the middle can be named on either side
constexpr double kSize = 0.42;    // of the font
const cv::Scalar kLeader(165, 165, 165);

cv::Scalar bgr(const Colour& colour) {
  return {double(colour[2]), double(colour[1]), double(colour[0])};
}

/// Rows for labels that are sorted by height, each as near to what it names as the others let it (least
/// squares with a least distance: neighbours that would touch form a group about their mean).
std::vector<int> rows_of(const std::vector<const Label*>& labels, int height) {
  struct Group {
    double sum;
    int count;
    double top() const { return sum / count; }
  };
  std::vector<Group> groups;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    groups.push_back({labels[i]->at.y() - kRow * static_cast<double>(i), 1});
    while (groups.size() > 1 && groups[groups.size() - 2].top() > groups.back().top()) {
      const Group below = groups.back();
      groups.pop_back();
      groups.back() = {groups.back().sum + below.sum, groups.back().count + below.count};
    }
  }
  std::vector<int> rows;
  const int highest = kRow, lowest = height - kRow * static_cast<int>(labels.size());
  for (const Group& group : groups) {
    const int top = std::max(highest, std::min(lowest, static_cast<int>(std::lround(group.top()))));
    for (int i = 0; i < group.count; ++i) rows.push_back(top + kRow * static_cast<int>(rows.size()));
  }
  return rows;
}

void write_side(cv::Mat& picture, std::vector<const Label*> labels, bool left) {
  std::stable_sort(labels.begin(), labels.end(),
                   [](const Label* a, const Label* b) { return a->at.y() < b->at.y(); });
  const std::vector<int> rows = rows_of(labels, picture.rows);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Label& label = *labels[i];
    const cv::Point at(kLabelMargin + static_cast<int>(std::lround(label.at.x())),
                       static_cast<int>(std::lround(label.at.y())));
    const cv::Point edge(left ? kLabelMargin : picture.cols - kLabelMargin, rows[i]);
    cv::line(picture, edge, at, kLeader, 1, cv::LINE_AA);
    int below = 0;
    const cv::Size size = cv::getTextSize(label.text, cv::FONT_HERSHEY_SIMPLEX, kSize, 1, &below);
    const cv::Point text(left ? edge.x - kBeside - size.width : edge.x + kBeside, edge.y + size.height / 2);
    cv::putText(picture, label.text, text, cv::FONT_HERSHEY_SIMPLEX, kSize, bgr(label.colour), 1,
                cv::LINE_AA);
  }
}

void draw_mark(cv::Mat& picture, const Label& label) {
  constexpr int kRadius = 4;
  const cv::Point at(kLabelMargin + static_cast<int>(std::lround(label.at.x())),
                     static_cast<int>(std::lround(label.at.y())));
  if (label.mark == Label::Mark::dot) {
    cv::circle(picture, at, kRadius + 1, cv::Scalar(255, 255, 255), cv::FILLED, cv::LINE_AA);
    cv::circle(picture, at, kRadius, bgr(label.colour), cv::FILLED, cv::LINE_AA);
  } else if (label.mark == Label::Mark::ring) {
    cv::circle(picture, at, kRadius, bgr(label.colour), 1, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat with_labels(const cv::Mat& picture, const std::vector<Label>& labels) {
  cv::Mat result;
  cv::copyMakeBorder(picture, result, 0, 0, kLabelMargin, kLabelMargin, cv::BORDER_CONSTANT,
                     cv::Scalar(255, 255, 255));
  std::vector<const Label*> left, right, middle;
  for (const Label& label : labels) {
    const double aside = label.at.x() / picture.cols - 0.5;
    (std::abs(aside) < kMiddle ? middle : aside < 0 ? left : right).push_back(&label);
  }
  for (const Label* label : middle) (left.size() < right.size() ? left : right).push_back(label);
  write_side(result, left, true);
  write_side(result, right, false);
  for (const Label& label : labels) draw_mark(result, label);
  return result;
}

}  // namespace tensegric_fit::inspect
