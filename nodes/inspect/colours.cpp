#include "inspect/colours.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tensegric_fit::inspect {
namespace {

constexpr Colour kTightColour{178, 24, 43}, kLooseColour{33, 94, 172};  // of equal lightness
constexpr int kSteps = 256;                                             // from neutral to either end

cv::Vec3f lab(const Colour& colour) {
  cv::Mat3f pixel(1, 1, cv::Vec3f(colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F)), result;
  cv::cvtColor(pixel, result, cv::COLOR_RGB2Lab);
  return result(0, 0);
}

// From the tight end over neutral to the loose end, straight lines in CIE Lab.
std::array<Colour, 2 * kSteps + 1> make_scale() {
  const cv::Vec3f neutral = lab(kNeutral), tight = lab(kTightColour), loose = lab(kLooseColour);
  cv::Mat3f colours(1, 2 * kSteps + 1), rgb;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const float part = static_cast<float>(std::abs(i)) / kSteps;
    colours(0, i + kSteps) = (1 - part) * neutral + part * (i < 0 ? tight : loose);
  }
  cv::cvtColor(colours, rgb, cv::COLOR_Lab2RGB);
  std::array<Colour, 2 * kSteps + 1> scale;
  for (int i = 0; i <= 2 * kSteps; ++i)
    for (int c = 0; c < 3; ++c) scale[i][c] = cv::saturate_cast<std::uint8_t>(255 * rgb(0, i)[c]);
  scale[kSteps] = kNeutral;  // no rounding on the way through Lab
  return scale;
}

}  // namespace

Colour distortion_colour(double distortion) {
  static const std::array<Colour, 2 * kSteps + 1> scale = make_scale();
  if (!std::isfinite(distortion)) return kNeutral;
  const double span = distortion < 1 ? 1 - kTightest : kLoosest - 1;
  return scale[kSteps + std::lround(kSteps * std::clamp((distortion - 1) / span, -1.0, 1.0))];
}

std::vector<Colour> distortion_colours(const std::vector<double>& distortion) {
  std::vector<Colour> colours(distortion.size());
  std::transform(distortion.begin(), distortion.end(), colours.begin(), distortion_colour);
  return colours;
}

std::vector<Colour> lit(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                        const Eigen::Vector3d& light_direction) {
  constexpr double kAmbient = 0.35;
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const Eigen::Vector3d to_light = -light_direction.normalized();
  std::vector<Colour> result(colours);
  for (std::size_t v = 0; v < result.size(); ++v) {
    const double wrapped =
        (1 + normals[v].dot(to_light)) / 2;  // no hard shadow line: 0 only straight away from the light
    const double light = kAmbient + (1 - kAmbient) * wrapped;
    for (std::uint8_t& channel : result[v]) channel = cv::saturate_cast<std::uint8_t>(light * channel);
  }
  return result;
}

}  // namespace tensegric_fit::inspect
