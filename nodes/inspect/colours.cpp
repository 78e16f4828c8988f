#include "inspect/colours.hpp"

#include <vtkMath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/saturate.hpp>

#include "geometry/shading_normals.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr Colour kTightColour{178, 24, 43}, kLooseColour{33, 94, 172};  // of equal lightness
constexpr Colour kWayColour{98, 48, 148}, kForceless{120, 120, 120}, kNotCompared{158, 164, 170};
constexpr int kColourSteps = 256;  // from neutral to an end

// VTK's, since OpenCV's tables take 0.2 s to make.
std::array<double, 3> lab(const Colour& colour) {
  const std::array<double, 3> rgb{colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0};
  std::array<double, 3> result;
  vtkMath::RGBToLab(rgb.data(), result.data());
  return result;
}

using Ramp = std::array<Colour, kColourSteps + 1>;

// From neutral to an end, a straight line in CIE Lab.
Ramp ramp_to(const Colour& end) {
  const std::array<double, 3> from = lab(kNeutral), to = lab(end);
  Ramp ramp{kNeutral};  // no rounding on the way through Lab
  for (int i = 1; i <= kColourSteps; ++i) {
    const double share = static_cast<double>(i) / kColourSteps;
    std::array<double, 3> between, rgb;
    for (int c = 0; c < 3; ++c) between[c] = (1 - share) * from[c] + share * to[c];
    vtkMath::LabToRGB(between.data(), rgb.data());
    for (int c = 0; c < 3; ++c) ramp[i][c] = cv::saturate_cast<std::uint8_t>(255 * rgb[c]);
  }
  return ramp;
}

const Colour& at(const Ramp& ramp, double share) {
  return ramp[std::lround(kColourSteps * std::clamp(share, 0.0, 1.0))];
}

}  // namespace

Colour mixed(const Colour& from, const Colour& to, double share) {
  Colour colour;
  for (int c = 0; c < 3; ++c)
    colour[c] = cv::saturate_cast<std::uint8_t>((1 - share) * from[c] + share * to[c]);
  return colour;
}

std::vector<Colour> with_unheld(std::vector<Colour> colours, const std::vector<int>& unheld) {
  constexpr double kTint = 0.5;
  for (const int v : unheld) colours.at(v) = mixed(colours.at(v), kUnheldColour, kTint);
  return colours;
}

Colour two_sided_colour(double share) {
  static const Ramp tight = ramp_to(kTightColour), loose = ramp_to(kLooseColour);
  return share < 0 ? at(tight, -share) : at(loose, share);
}

Colour distance_colour(double metres, bool compared) {
  return compared ? two_sided_colour(metres / kFarthestDistance) : kNotCompared;
}

Colour way_colour(double share) {
  static const Ramp way = ramp_to(kWayColour);
  return at(way, share);
}

Colour distortion_colour(double distortion) {
  if (!std::isfinite(distortion)) return kNeutral;
  return two_sided_colour((distortion - 1) / (distortion < 1 ? 1 - kTightest : kLoosest - 1));
}

Colour tension_colour(double tension) {
  if (!std::isfinite(tension)) return kForceless;
  constexpr Colour kLoosePull{250, 224, 110}, kHardPull{150, 62, 8};  // neither is a colour of skin
  constexpr double kHalfWay = 5;  // a band shortened by 7 % (B1 on F0 to F2: 5.0 to 5.8)
  const double pull = std::max(0.0, tension);
  return mixed(kLoosePull, kHardPull, pull / (kHalfWay + pull));
}

Colour member_colour(double force) {
  if (!std::isfinite(force)) return kForceless;
  const double size = std::abs(force);
  return mixed(kForceless, force < 0 ? kLooseColour : kTightColour, size / (1 + size));
}

std::vector<Colour> distortion_colours(const std::vector<double>& distortion) {
  std::vector<Colour> colours(distortion.size());
  std::transform(distortion.begin(), distortion.end(), colours.begin(), distortion_colour);
  return colours;
}

std::vector<Colour> lit(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                        const Eigen::Vector3d& light_direction) {
  constexpr double kAmbient = 0.35;
  const std::vector<Eigen::Vector3d> normals = geometry::shading_normals(mesh.vertices, mesh.triangles);
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
