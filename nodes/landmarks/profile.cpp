#include "landmarks/profile.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.001;
constexpr double kLeastOfLine = 0.6;    // of its points, that must be there
constexpr double kBelowOrigin = 0.010;  // m; a box ends with triangles
constexpr int kSmoothing =
    6;  // steps each way of a triangle filter: takes half a millimetre of noise down to a tenth

std::vector<Vector3d> in_even_steps(const std::vector<Vector3d>& line) {
  std::vector<Vector3d> even{line.front()};
  double left = kStep;  // to go to the next point
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = (line[i] - line[i - 1]).norm();
    double gone = 0;
    while (length - gone >= left) {
      gone += left;
      even.push_back(line[i - 1] + gone / length * (line[i] - line[i - 1]));
      left = kStep;
    }
    left -= length - gone;
  }
  return even;
}

std::vector<Vector3d> smoothed(const std::vector<Vector3d>& line) {
  std::vector<Vector3d> result(line.size());
  const int last = static_cast<int>(line.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const int reach = std::min({kSmoothing, i, last - i});
    Vector3d sum = Vector3d::Zero();
    double weight = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double w = reach + 1 - std::abs(k);
      sum += w * line[i + k];
      weight += w;
    }
    result[i] = sum / weight;
  }
  return result;
}

}  // namespace

double Profile::hollowness(int at, int reach) const {
  if (at < reach || at + reach >= static_cast<int>(points.size())) return 0;
  const Vector3d before = points[at] - points[at - reach], after = points[at + reach] - points[at];
  const Vector3d axis = before.cross(after);  // a line that runs down turns outward about -sideways
  const double turn = std::atan2(axis.norm(), before.dot(after));
  return (axis.dot(sideways) < 0 ? turn : -turn) / (reach * step);
}

double Profile::opening(int at, int first, int last) const {
  if (at < last || at + last >= static_cast<int>(points.size())) return -1;
  const Vector3d above = points[at - last] - points[at - first],
                 below = points[at + last] - points[at + first];
  return std::atan2(above.cross(below).norm(), above.dot(below));
}

std::optional<Profile::Line> Profile::line(int at, int first, int last) const {
  const int from = std::max(at + first, 0), to = std::min(at + last, static_cast<int>(points.size()) - 1);
  const int count = to - from + 1;
  if (count < std::max(2.0, kLeastOfLine * (last - first))) return std::nullopt;
  Vector3d middle = Vector3d::Zero(), direction = Vector3d::Zero();
  for (int i = from; i <= to; ++i) middle += points[i] / count;
  for (int i = from; i <= to; ++i) direction += (i - (from + to) / 2.0) * points[i];
  if (direction.norm() < 1e-12) return std::nullopt;
  return Line{middle, direction.normalized()};
}

std::vector<geometry::SectionLoop> cut(const BodyShape& body, const std::vector<int>& triangles,
                                       const Vector3d& origin, const Vector3d& normal) {
  geometry::TriangleMesh piece;
  std::vector<int> used;
  for (int t : triangles) {
    const Eigen::Vector3i& corners = body.mesh.triangles[t];
    const double a = normal.dot(body.mesh.vertices[corners[0]] - origin);
    const double b = normal.dot(body.mesh.vertices[corners[1]] - origin);
    const double c = normal.dot(body.mesh.vertices[corners[2]] - origin);
    if (std::min({a, b, c}) >= 0 || std::max({a, b, c}) < 0) continue;
    piece.triangles.push_back(corners);
    used.insert(used.end(), {corners[0], corners[1], corners[2]});
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (int v : used) piece.vertices.push_back(body.mesh.vertices[v]);
  for (Eigen::Vector3i& t : piece.triangles)
    for (int k = 0; k < 3; ++k)
      t[k] = static_cast<int>(std::lower_bound(used.begin(), used.end(), t[k]) - used.begin());
  return geometry::plane_section(piece, origin, normal);
}

Profile cut_profile(const BodyShape& body, const std::vector<int>& triangles, const Vector3d& origin,
                    const Vector3d& outward) {
  Profile profile{{}, kStep, Vector3d::UnitZ().cross(outward)};
  double longest = 0;
  bool longest_reaches = false;
  for (const geometry::SectionLoop& loop : cut(body, triangles, origin, profile.sideways)) {
    if (loop.closed) continue;
    double lowest = loop.points.front().z();  // skin that looks outward runs down from its first point
    for (const Vector3d& p : loop.points) lowest = std::min(lowest, p.z());
    const double drop = loop.points.front().z() - lowest;
    const bool reaches = loop.points.front().z() > origin.z() - kBelowOrigin;
    if (reaches == longest_reaches ? drop <= longest : longest_reaches) continue;
    longest = drop;
    longest_reaches = reaches;
    profile.points = loop.points;
  }
  // Noise makes a way longer: even steps are taken again where it is smoothed away.
  if (!profile.points.empty()) profile.points = in_even_steps(smoothed(in_even_steps(profile.points)));
  return profile;
}

std::vector<int> triangles_in_box(const BodyShape& body, const Vector3d& low, const Vector3d& high) {
  std::vector<int> inside;
  for (std::size_t t = 0; t < body.mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = body.mesh.triangles[t];
    const Vector3d middle =
        (body.mesh.vertices[v[0]] + body.mesh.vertices[v[1]] + body.mesh.vertices[v[2]]) / 3;
    if ((middle.array() >= low.array()).all() && (middle.array() <= high.array()).all())
      inside.push_back(static_cast<int>(t));
  }
  return inside;
}

}  // namespace tensegric_fit::landmarks
