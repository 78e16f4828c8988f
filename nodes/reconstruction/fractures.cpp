#include "reconstruction/fractures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/percentile.hpp"
#include "geometry/triangle_mesh.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using geometry::PointCloud;

constexpr double kFractureReach = 0.018;    // m, of the skin that is judged at a time
constexpr double kFractureSpacing = 0.012;  // m, between the places where it is judged
constexpr double kFacing = 0.75;            // cosine between a point's normal and the place's
constexpr std::size_t kFewestInSheet = 24;  // points
constexpr double kSmallestShare = 0.2;      // of the points, on either sheet
constexpr double kParted = 3.0;            // separation over the sheets' own deviation; one sheet cut in half
                                           // has 2.7
constexpr double kBeside = 0.35;           // of the reach: sheets whose middles lie farther apart are a step
constexpr double kFuzzy = 1.6;             // typical deviations; a sheet thicker than that is hair or fingers
constexpr double kLeastOffset = 0.003;     // m
constexpr double kOverRegistration = 1.3;  // of what 95 % of the body stays below
constexpr double kSkinOfPlace =
    kFractureSpacing * kFractureSpacing / 1.5;     // m^2; a plane at any angle meets so many cubes
constexpr std::size_t kFewestPlaces = 12;          // 11 cm^2
constexpr double kLowest = 0.10, kHighest = 0.85;  // toes end below, in m; the neck here, in heights

/// How the points around a place lie to the smooth surface through them.
struct Place {
  Vector3d point;
  double deviation;   // of all points, m
  double separation;  // of the two halves that differ most, m
  double within;      // deviation of either half from its own mean, m
  bool beside;        // the halves lie side by side, not one over the other
};

/// Heights over the quadratic surface that fits them best; `at` across, in units of the reach.
void remove_bend(const std::vector<Vector2d>& at, std::vector<double>& heights) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const auto terms = [](const Vector2d& p) {
    return (Vector6d() << 1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y()).finished();
  };
  Eigen::Matrix<double, 6, 6> products = 1e-9 * Eigen::Matrix<double, 6, 6>::Identity();
  Vector6d sums = Vector6d::Zero();
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vector6d t = terms(at[i]);
    products += t * t.transpose();
    sums += heights[i] * t;
  }
  const Vector6d bend = products.ldlt().solve(sums);
  for (std::size_t i = 0; i < at.size(); ++i) heights[i] -= bend.dot(terms(at[i]));
}

/// The cut through the heights that leaves the halves most uniform (Otsu 1979).
void part(const std::vector<Vector2d>& at, const std::vector<double>& heights, Place& place) {
  const std::size_t count = heights.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return heights[a] < heights[b]; });
  double sum = 0, squares = 0;
  for (double h : heights) {
    sum += h;
    squares += h * h;
  }
  const double n = static_cast<double>(count), variance = squares / n - sum * sum / (n * n);
  double low_sum = 0, between = 0;
  std::size_t cut = 0;
  for (std::size_t i = 1; i < count; ++i) {
    low_sum += heights[order[i - 1]];
    const double low = static_cast<double>(i), high = n - low;
    if (std::min(low, high) < kSmallestShare * n) continue;
    const double separation = (sum - low_sum) / high - low_sum / low;
    if (low * high * separation * separation / (n * n) <= between) continue;
    between = low * high * separation * separation / (n * n);
    place.separation = separation;
    cut = i;
  }
  place.deviation = std::sqrt(std::max(0.0, variance));
  place.within = std::sqrt(std::max(0.0, variance - between));
  Vector2d low_middle = Vector2d::Zero(), high_middle = Vector2d::Zero();
  for (std::size_t i = 0; i < count; ++i)
    (i < cut ? low_middle : high_middle) += at[order[i]] / static_cast<double>(i < cut ? cut : count - cut);
  place.beside = (high_middle - low_middle).norm() > kBeside;
}

/// False where too few points face the same way.
bool judge(const PointCloud& body, const std::vector<int>& near, Place& place, Vector3d normal) {
  std::vector<int> facing;
  for (int round = 0; round < 2; ++round) {
    facing.clear();
    Vector3d mean = Vector3d::Zero();
    for (int i : near) {
      if (body.normals[i].dot(normal) < kFacing) continue;
      facing.push_back(i);
      mean += body.normals[i];
    }
    if (facing.size() < kFewestInSheet) return false;
    normal = mean.normalized();
  }
  const Vector3d right = normal.unitOrthogonal(), up = normal.cross(right);
  std::vector<Vector2d> at;
  std::vector<double> heights;
  for (int i : facing) {
    const Vector3d d = body.points[i] - place.point;
    at.emplace_back(right.dot(d) / kFractureReach, up.dot(d) / kFractureReach);
    heights.push_back(normal.dot(d));
  }
  remove_bend(at, heights);
  part(at, heights, place);
  return true;
}

std::vector<Place> judged_places(const PointCloud& body) {
  const VoxelGrid grid(body.points, kFractureReach), spacing(body.points, kFractureSpacing);
  std::vector<int> cell_of(body.points.size()), cells, near;
  for (int c = 0; c < grid.cell_count(); ++c)
    for (int i = grid.begin(c); i < grid.end(c); ++i) cell_of[grid.order()[i]] = c;
  std::vector<Place> places;
  for (int s = 0; s < spacing.cell_count(); ++s) {
    const int middle = spacing.order()[spacing.begin(s)];
    Place place{body.points[middle], 0, 0, 0, false};
    grid.around(cell_of[middle], cells);
    near.clear();
    for (int c : cells)
      for (int i = grid.begin(c); i < grid.end(c); ++i)
        if ((body.points[grid.order()[i]] - place.point).squaredNorm() < kFractureReach * kFractureReach)
          near.push_back(grid.order()[i]);
    if (judge(body, near, place, body.normals[middle])) places.push_back(place);
  }
  return places;
}

/// The places with two sheets.
std::vector<Place> doubled(const std::vector<Place>& places, double height) {
  std::vector<double> deviations, separations;
  for (const Place& p : places) deviations.push_back(p.deviation);
  const double thickest = kFuzzy * geometry::percentile(deviations, 0.5);
  for (const Place& p : places)
    if (p.within < thickest) separations.push_back(p.separation);
  const double least = std::max(kLeastOffset, kOverRegistration * geometry::percentile(separations, 0.95));
  std::vector<Place> result;
  std::copy_if(places.begin(), places.end(), std::back_inserter(result), [&](const Place& p) {
    return p.point.z() > kLowest && p.point.z() < kHighest * height && !p.beside && p.within < thickest &&
           p.separation > least && p.separation > kParted * p.within;
  });
  return result;
}

/// Takes a place and all that are linked to it out of `left`.
std::vector<Place> linked(std::vector<Place>& left) {
  std::vector<Place> group(1, left.back());
  left.pop_back();
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto apart = std::stable_partition(left.begin(), left.end(), [&](const Place& p) {
      return (p.point - group[i].point).norm() > kFractureSpacing * std::sqrt(3.0);
    });
    std::vector<Place> next(apart, left.end());
    left.erase(apart, left.end());
    group.insert(group.end(), next.begin(), next.end());
  }
  return group;
}

}  // namespace

std::vector<geometry::Fracture> find_fractures(const PointCloud& body) {
  const std::vector<Place> places = judged_places(body);
  if (places.empty()) return {};
  std::vector<Place> left = doubled(places, geometry::bounding_box(body.points)[1].z());
  std::vector<geometry::Fracture> fractures;
  while (!left.empty()) {
    const std::vector<Place> group = linked(left);
    if (group.size() < kFewestPlaces) continue;
    geometry::Fracture fracture{Vector3d::Zero(), 0, 0, 0};
    std::vector<double> offsets;
    for (const Place& p : group) {
      fracture.centre += p.point / static_cast<double>(group.size());
      offsets.push_back(p.separation);
    }
    for (const Place& p : group)
      fracture.radius = std::max(fracture.radius, (p.point - fracture.centre).norm() + kFractureReach);
    fracture.area = static_cast<double>(group.size()) * kSkinOfPlace;
    fracture.offset = geometry::percentile(offsets, 0.9);
    fractures.push_back(fracture);
  }
  std::stable_sort(fractures.begin(), fractures.end(),
                   [](const auto& a, const auto& b) { return a.area > b.area; });
  return fractures;
}

}  // namespace tensegric_fit::reconstruction
