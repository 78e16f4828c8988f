#include "reconstruction/unseen_skin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>

#include "body_model/missing_parts.hpp"
#include "body_model/samples.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr double kUnseen =
    0.008;  // m from every point that faces the same way: sparse scans leave 5 between two
constexpr double kUnseenReach =
    0.02;  // m that a normal turned by 60 degrees counts like: the other wall of a pocket is no neighbour
constexpr double kBeyond =
    0.10;  // m; skin that far from every point is a part that was not scanned, and is not made up
constexpr double kUnseenSpacing = 0.004;  // m
constexpr double kInside = 0.03;          // m under other skin that faces the other way: parts that touch
constexpr int kAround = 100;              // samples within that
// Cosine of two normals of skins that face each other: 107 degrees, by which skin with a radius above 19 mm
// does not turn within kInside. Hands, whose radii are smaller, are left out.
constexpr double kOpposed = -0.3;

/// The normals of a cell's samples lie in this box, each axis by itself.
using NormalBox = Eigen::AlignedBox3d;

std::vector<NormalBox> normal_boxes(const VoxelGrid& grid, const std::vector<Eigen::Vector3d>& normals) {
  std::vector<NormalBox> boxes(grid.cell_count());
  for (int c = 0; c < grid.cell_count(); ++c)
    for (int i = grid.begin(c); i < grid.end(c); ++i) boxes[c].extend(normals[i]);
  return boxes;
}

/// No normal in the box is further from n than this cosine says.
double least_cosine(const Eigen::Vector3d& n, const NormalBox& box) {
  return n.cwiseProduct(box.min()).cwiseMin(n.cwiseProduct(box.max())).sum();
}

}  // namespace

geometry::PointCloud unseen_skin(const body_model::RegisteredBody& body, const geometry::PointCloud& seen) {
  const body_model::Model& model = *body.model;
  const std::vector<char> lost = body_model::lost_skin(body);
  geometry::TriangleMesh skin{body.skin, {}};
  double area = 0;
  for (const Eigen::Vector3i& t : model.triangles) {
    const std::string& part = model.parts[model.part[t[0]]];
    if (part.rfind("hand", 0) == 0 || lost[t[0]] || lost[t[1]] || lost[t[2]]) continue;
    skin.triangles.push_back(t);
    area += geometry::area_vector(body.skin[t[0]], body.skin[t[1]], body.skin[t[2]]).norm() / 2;
  }
  const body_model::Samples spread =
      body_model::sample_surface(skin, {}, static_cast<int>(area / (kUnseenSpacing * kUnseenSpacing)));
  const VoxelGrid grid(spread.points, kInside);
  body_model::Samples samples;  // those beside each other stand beside each other in memory
  for (const int i : grid.order()) {
    samples.points.push_back(spread.points[i]);
    samples.normals.push_back(spread.normals[i]);
  }
  std::array<std::unique_ptr<const geometry::PointTree>, 2> trees;
  geometry::parallel_for(2, [&](std::size_t, std::size_t, int half) {
    trees[half] = std::make_unique<const geometry::PointTree>(half == 0 ? samples.points : seen.points);
  });
  const geometry::PointTree &own = *trees[0], &tree = *trees[1];
  const std::vector<NormalBox> boxes = normal_boxes(grid, samples.normals);
  std::vector<char> is_unseen(samples.points.size(), 0);
  const auto look = [&](int cell, const std::vector<int>& around, std::vector<int>& near) {
    for (int i = grid.begin(cell); i < grid.end(cell); ++i) {
      const Eigen::Vector3d &p = samples.points[i], &n = samples.normals[i];
      const auto is_seen = [&](int j) {
        return (seen.points[j] - p).squaredNorm() +
                   kUnseenReach * kUnseenReach * (seen.normals[j] - n).squaredNorm() <
               kUnseen * kUnseen;
      };
      if (tree.any_within(p, kUnseen, is_seen)) continue;
      if (!tree.any_within(p, kBeyond, [](int) { return true; })) continue;
      // What lies under skin that faces the other way has run into it.
      const auto over = [&](int j) {
        return n.dot(samples.normals[j]) < kOpposed && samples.normals[j].dot(p - samples.points[j]) < 0 &&
               (p - samples.points[j]).norm() < kInside;
      };
      const bool may_be_over = std::any_of(around.begin(), around.end(),
                                           [&](int c) { return least_cosine(n, boxes[c]) < kOpposed; });
      if (may_be_over && own.any_within(p, kInside, over)) {  // few: only for these the nearest are found
        own.nearest(p, kAround, near);
        if (std::any_of(near.begin(), near.end(), over)) continue;
      }
      is_unseen[grid.order()[i]] = 1;
    }
  };
  geometry::parallel_for(grid.cell_count(), [&](std::size_t begin, std::size_t end, int) {
    std::vector<int> around, near;
    for (std::size_t c = begin; c < end; ++c) {
      grid.around(static_cast<int>(c), around);
      look(static_cast<int>(c), around, near);
    }
  });
  geometry::PointCloud unseen;
  for (std::size_t i = 0; i < is_unseen.size(); ++i) {
    if (!is_unseen[i]) continue;
    unseen.points.push_back(spread.points[i]);
    unseen.normals.push_back(spread.normals[i]);
  }
  return unseen;
}

}  // namespace tensegric_fit::reconstruction
