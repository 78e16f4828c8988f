#include "landmarks/body_shape.hpp"

#include <algorithm>
#include <vector>

namespace tensegric_fit::landmarks {
namespace {

// Thighs touch, or a wide gap was filled, where so far below the junction they are joined over that share of
// their depth.
constexpr double kHidden = 0.006, kBelowJunction = 0.009, kTouching = 0.15;  // statures, statures, share
// Where they do not, skin that fills a slit can still join them too low, but not by more than this.
constexpr double kUnderPerineum = 0.0024;  // statures
constexpr double kApart = 0.0025;          // m, between sections
constexpr int kReach = 2;                  // sections each way over which a slope is taken
constexpr int kGrown = 4;  // sections above, 10 mm, where what joins the legs has a good part of their depth
constexpr double kShareOfLimb = 0.5;
constexpr double kOverPerineum = 0.0013;  // m; the steep stretch begins at the perineum
constexpr double kStillSteep = 0.85;      // of the steepest slope
constexpr double kLowestCrotch = 0.435, kHighestCrotch = 0.505;  // statures over the soles

// The back end of what joins the legs, seen from behind: going up, it recedes gently along thighs that touch,
// steeply round the perineum, and gently again between the buttocks. The middle of the steep stretch, or
// `otherwise`.
double steepest_behind(const SlicedMesh& sliced, double low, double high, double y, double limb_depth,
                       double otherwise) {
  std::vector<Bridge> bridges;
  for (double z = low; z <= high; z += kApart)
    bridges.push_back(narrowest_bridge(sliced.outlines_at(z), y, y));
  const int count = static_cast<int>(bridges.size());
  std::vector<double> slopes(count, 0);
  for (int i = kReach; i + kGrown < count; ++i)
    if (bridges[i - kReach].length > 0 && bridges[i + kGrown].length > kShareOfLimb * limb_depth)
      slopes[i] = bridges[i - kReach].back - bridges[i + kReach].back;
  const int steepest = static_cast<int>(std::max_element(slopes.begin(), slopes.end()) - slopes.begin());
  if (slopes[steepest] <= 0) return otherwise;
  int first = steepest, last = steepest;
  while (first > 0 && slopes[first - 1] > kStillSteep * slopes[steepest]) --first;
  while (last + 1 < count && slopes[last + 1] > kStillSteep * slopes[steepest]) ++last;
  return low + kApart * (first + last) / 2 - kOverPerineum;
}

Junction find_crotch_junction(const SlicedMesh& sliced, const BodyLevels& levels) {
  const Level& parted = levels.parted();
  const Outline *left = &parted.outlines[parted.legs[0]], *right = &parted.outlines[parted.legs[1]];
  if (left->centroid.y() < right->centroid.y()) std::swap(left, right);
  // In statures: the gap between thighs stays this near its middle, and this far up at the most it can be
  // filled.
  const double middle = (left->low.y() + right->high.y()) / 2, reach = 0.008 * levels.stature;
  const double depth = left->high.x() - left->low.x(), s = levels.stature;
  Junction junction = find_junction(
      sliced, {parted.height - 0.01 * s, parted.height + 0.11 * s, middle - reach, middle + reach, depth});
  const double soles = levels.levels.front().height - levels.step / 2;
  const double steepest = steepest_behind(sliced, std::max(parted.height, soles + kLowestCrotch * s),
                                          soles + kHighestCrotch * s, middle, depth, junction.height);
  const std::vector<Outline> below = sliced.outlines_at(junction.height - kBelowJunction * s);
  const bool touching = junction.height - parted.height > kHidden * s &&
                        narrowest_bridge(below, middle, middle).length > kTouching * depth;
  junction.height = touching ? steepest : std::max(junction.height, steepest - kUnderPerineum * s);
  junction.above.y = middle;
  return junction;
}

}  // namespace

BodyShape::BodyShape(geometry::TriangleMesh body_in_its_frame, std::vector<char> unseen_vertices)
    : mesh(std::move(body_in_its_frame)),
      filled(std::move(unseen_vertices)),
      normals(geometry::vertex_normals(mesh.vertices, mesh.triangles)),
      sliced(mesh),
      levels(find_levels(sliced)),
      crotch(find_crotch_junction(sliced, levels)),
      stature(levels.stature) {}

bool BodyShape::unseen(const Eigen::Vector3d& point, double radius) const {
  for (std::size_t v = 0; v < filled.size(); ++v)
    if (filled[v] != 0 && (mesh.vertices[v] - point).squaredNorm() < radius * radius) return true;
  return false;
}

}  // namespace tensegric_fit::landmarks
