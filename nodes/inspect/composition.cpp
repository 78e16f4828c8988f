#include "inspect/composition.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {
namespace {

const cv::Scalar kInk(70, 66, 64), kPaper(255, 255, 255);
const cv::Scalar kWarningInk(0, 70, 168);  // kWarnedColour is too pale for thin strokes on white
constexpr int kGap = 12;                   // pixels

int strip_height(const cv::Mat& picture) {
  return std::max(12, picture.rows / 16);
}

// Of pictures higher than wide, as of two regions: words as large as beside one of them.
int strip_under(const cv::Mat& picture) {
  return std::min(strip_height(picture), std::max(12, picture.cols / 31));
}

double scale_of(int strip) {
  return strip / 70.0;
}

cv::Size size_of(const std::string& text, int strip) {
  int below = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale_of(strip), 1, &below);
}

// `anchor` is 0 at the text's left end, 1 at its right end; `at` is half-way up its capitals.
void write(cv::Mat& picture, const std::string& text, int strip, cv::Point at, double anchor,
           const cv::Scalar& ink = kInk) {
  const cv::Size size = size_of(text, strip);
  at += cv::Point(-static_cast<int>(std::lround(anchor * size.width)), size.height / 2);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale_of(strip), ink, 1, cv::LINE_AA);
}

/// As many words a line as are no wider than that, pixels; one where it is wider. No more lines than make
/// sense.
std::vector<std::string> lines_of(const std::string& text, int strip, int width) {
  std::vector<std::string> lines;
  constexpr std::size_t kMost = 10;
  std::istringstream words(text);
  for (std::string word; lines.size() < kMost && words >> word;) {
    if (!lines.empty() && size_of(lines.back() + " " + word, strip).width <= width)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

// The two-sided scale of colours: words at its ends, figures below ends and middle.
struct ScaleStrip {
  std::string low_word, high_word, figures[3];
};

cv::Mat with_scale(const cv::Mat& picture, const ScaleStrip& scale) {
  // Beside the scale there is a quarter of the width: so high, "pressed together" just fits.
  const int strip = strip_under(picture), height = strip / 2;
  cv::Mat result;
  cv::copyMakeBorder(picture, result, 0, 2 * strip, 0, 0, cv::BORDER_CONSTANT, kPaper);
  const int width = result.cols / 2, left = (result.cols - width) / 2, top = picture.rows + strip / 3;
  for (int x = 0; x < width; ++x) {
    const Colour c = two_sided_colour(2.0 * x / std::max(1, width - 1) - 1);
    cv::line(result, {left + x, top}, {left + x, top + height}, cv::Scalar(c[2], c[1], c[0]));
  }
  const int under = top + height + strip / 2, beside = top + height / 2;
  for (int i = 0; i < 3; ++i) write(result, scale.figures[i], strip, {left + i * width / 2, under}, 0.5);
  write(result, scale.low_word, strip, {left - strip / 2, beside}, 1);
  write(result, scale.high_word, strip, {left + width + strip / 2, beside}, 0);
  return result;
}

std::string per_cent(double ratio) {
  return std::to_string(std::lround(100 * ratio)) + " %";
}

}  // namespace

cv::Mat side_by_side(const cv::Mat& left, const cv::Mat& right) {
  const cv::Mat gap(left.rows, kGap, left.type(), kPaper);
  cv::Mat result;
  cv::hconcat(std::vector<cv::Mat>{left, gap, right}, result);
  return result;
}

cv::Mat with_caption(const cv::Mat& picture, const std::string& text) {
  const int strip = strip_height(picture);
  cv::Mat result;
  cv::copyMakeBorder(picture, result, strip, 0, 0, 0, cv::BORDER_CONSTANT, kPaper);
  write(result, text, strip, {result.cols / 2, strip / 2}, 0.5);
  return result;
}

cv::Mat with_note(const cv::Mat& picture, const std::string& text) {
  const int strip = strip_under(picture);
  const std::vector<std::string> lines = lines_of(text, strip, picture.cols - strip);
  cv::Mat result;
  cv::copyMakeBorder(picture, result, 0, static_cast<int>(lines.size()) * strip, 0, 0, cv::BORDER_CONSTANT,
                     kPaper);
  for (int i = 0; i < static_cast<int>(lines.size()); ++i)
    write(result, lines[i], strip, {result.cols / 2, picture.rows + i * strip + strip / 2}, 0.5, kWarningInk);
  return result;
}

cv::Mat with_distortion_scale(const cv::Mat& picture) {
  return with_scale(
      picture, {"pressed together", "stretched", {per_cent(kTightest), per_cent(1), per_cent(kLoosest)}});
}

cv::Mat with_distance_scale(const cv::Mat& picture) {
  const std::string end = std::to_string(std::lround(1e3 * kFarthestDistance)) + " mm";
  return with_scale(picture, {"worn inside", "worn outside", {"-" + end, "0", end}});
}

std::string png_bytes(const cv::Mat& picture) {
  if (picture.type() != CV_8UC3) throw std::runtime_error("a picture that is not 8 bits of BGR");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.cols;
  image.height = picture.rows;
  image.format = PNG_FORMAT_BGR;
  image.flags = PNG_IMAGE_FLAG_FAST;  // files are larger by a third to a half, in a fifth of the time
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  const auto stride = static_cast<png_int_32>(picture.step1());
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.data, stride, nullptr))
    throw std::runtime_error(std::string("a picture cannot be encoded: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace tensegric_fit::inspect
