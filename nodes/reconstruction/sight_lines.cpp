#include "reconstruction/sight_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/halves.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr int kEyes = 60;            // over half a turn
constexpr double kSlice = 0.006;     // m high
constexpr int kMostSlices = 4;       // of a row
constexpr double kDense = 120000;    // points of a body, of which one slice fills every column that it meets
constexpr double kColumn = 0.002;    // m
constexpr int kNarrowest = 2;        // columns of a gap
constexpr int kWidest = 30;          // columns of a gap
constexpr int kLimb = 20;            // columns of a limb beside a gap: not a finger
constexpr double kEdge = 0.004;      // m from a gap's edge: points there are on the limb's outline
constexpr double kFacing = 0.6;      // cosine between an outline point's normal and the way into the gap
constexpr double kShortest = 0.008;  // m, of an unseen strip, in the direction of sight
constexpr double kLongest = 0.08;    // m
constexpr double kSpacing = 0.003;   // m, of the new points
constexpr double kSeen = 0.004;      // m; no new point this close to one that was seen

/// The outline of a limb beside a gap, in one row of one picture.
struct Outline {
  double across;  // where the gap begins
  int side;       // +1: the gap lies beyond, -1: before
  std::vector<int> points;
};

/// The outlines in a row, from which of its columns hold points.
void add_outlines(const char* occupied, int columns, std::vector<Outline>& outlines) {
  const auto is_limb = [&](int column, int step) {
    int set = 0;
    for (int k = 0, c = column; k < kLimb && c >= 0 && c < columns; ++k, c += step) set += occupied[c];
    return set >= kLimb - 2;
  };
  int last = -1;
  for (int c = 0; c < columns; ++c) {
    if (!occupied[c]) continue;
    const int width = c - last - 1;
    if (last >= 0 && width >= kNarrowest && width <= kWidest && is_limb(last, -1) && is_limb(c, 1)) {
      outlines.push_back({(last + 1) * kColumn, 1, {}});
      outlines.push_back({c * kColumn, -1, {}});
    }
    last = c;
  }
}

/// Straight strips between the outline's neighbours in depth that are far apart.
void add_strips(const Outline& outline, const geometry::PointCloud& body, const Eigen::Vector3d& eye,
                geometry::PointCloud& strips) {
  std::vector<int> by_depth = outline.points;
  std::sort(by_depth.begin(), by_depth.end(), [&](int a, int b) {
    const double depth_a = eye.dot(body.points[a]), depth_b = eye.dot(body.points[b]);
    return depth_a != depth_b ? depth_a < depth_b : a < b;
  });
  for (std::size_t i = 1; i < by_depth.size(); ++i) {
    const int a = by_depth[i - 1], b = by_depth[i];
    const Eigen::Vector3d chord = body.points[b] - body.points[a];
    const double depth = eye.dot(chord);
    if (depth < kShortest || depth > kLongest) continue;
    const Eigen::Vector3d along = chord.normalized(), mean = body.normals[a] + body.normals[b];
    const Eigen::Vector3d normal = (mean - along.dot(mean) * along).normalized();
    const int count = static_cast<int>(chord.norm() / kSpacing);
    for (int k = 1; k < count; ++k) {
      strips.points.push_back(body.points[a] + chord * k / count);
      strips.normals.push_back(normal);
    }
  }
}

/// What one eye at the level of the body sees.
void look(const geometry::PointCloud& body, const Eigen::Vector3d& eye, int slices_of_row,
          geometry::PointCloud& strips) {
  const Eigen::Vector3d right(-eye.y(), eye.x(), 0);
  double left_end = 0, right_end = 0, bottom = 0, top = 0;
  for (const Eigen::Vector3d& p : body.points) {
    const double x = right.dot(p);
    left_end = std::min(left_end, x);
    right_end = std::max(right_end, x);
    bottom = std::min(bottom, p.z());
    top = std::max(top, p.z());
  }
  const int columns = static_cast<int>((right_end - left_end) / kColumn) + 1;
  const int slices = static_cast<int>((top - bottom) / kSlice) + 1;
  const auto across = [&](const Eigen::Vector3d& p) { return right.dot(p) - left_end; };
  const auto slice_of = [&](const Eigen::Vector3d& p) { return static_cast<int>((p.z() - bottom) / kSlice); };
  // Row r is slice r and those above it that it takes to be opaque.
  std::vector<char> occupied(static_cast<std::size_t>(columns) * slices);
  std::vector<std::vector<Outline>> outlines(slices);
  const auto first_row = [&](int slice) { return std::max(0, slice - slices_of_row + 1); };
  for (const Eigen::Vector3d& p : body.points)
    for (int r = first_row(slice_of(p)); r <= slice_of(p); ++r)
      occupied[static_cast<std::size_t>(r) * columns + static_cast<int>(across(p) / kColumn)] = 1;
  for (int r = 0; r < slices; ++r)
    add_outlines(occupied.data() + static_cast<std::size_t>(r) * columns, columns, outlines[r]);
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    const Eigen::Vector3d& p = body.points[i];
    for (int r = first_row(slice_of(p)); r <= slice_of(p); ++r)
      for (Outline& outline : outlines[r])
        if (std::abs(across(p) - outline.across) < kEdge &&
            outline.side * right.dot(body.normals[i]) > kFacing)
          outline.points.push_back(static_cast<int>(i));
  }
  for (const auto& in_row : outlines)
    for (const Outline& outline : in_row) add_strips(outline, body, eye, strips);
}

}  // namespace

geometry::PointCloud sight_line_points(const geometry::PointCloud& body) {
  const int slices_of_row = std::clamp(
      static_cast<int>(std::ceil(kDense / static_cast<double>(body.points.size()))), 1, kMostSlices);
  std::array<geometry::PointCloud, 2> of_half;
  geometry::in_halves(kEyes, [&](std::size_t begin, std::size_t end, int half) {
    for (std::size_t i = begin; i < end; ++i) {
      const double turn = M_PI * static_cast<double>(i) / kEyes;
      look(body, {std::cos(turn), std::sin(turn), 0}, slices_of_row, of_half[half]);
    }
  });
  const geometry::PointTree tree(body.points);
  geometry::PointCloud result;
  for (const geometry::PointCloud& strips : of_half) {
    for (std::size_t i = 0; i < strips.points.size(); ++i) {
      if (tree.distance(strips.points[i]) < kSeen) continue;
      result.points.push_back(strips.points[i]);
      result.normals.push_back(strips.normals[i]);
    }
  }
  return result;
}

}  // namespace tensegric_fit::reconstruction
