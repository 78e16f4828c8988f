#include "geometry/section.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

namespace tensegric_fit::geometry {
namespace {

// The plane crosses an edge once; both triangles on it must use the same key for the crossing.
using EdgeKey = std::pair<int, int>;
EdgeKey key_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

struct Segment {
  EdgeKey from, to;
  int triangle;
};

}  // namespace

std::vector<SectionLoop> plane_section(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& normal) {
  std::vector<double> height(mesh.vertices.size());
  for (std::size_t v = 0; v < height.size(); ++v) height[v] = normal.dot(mesh.vertices[v] - origin);
  const auto above = [&height](int v) { return height[v] >= 0; };

  // A triangle is cut in one segment, from the edge that goes down through the plane to the one that comes
  // up: inside lies to the left.
  std::vector<Segment> segments;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& triangle = mesh.triangles[t];
    EdgeKey down{-1, -1}, up{-1, -1};
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      if (above(a) && !above(b)) down = key_of(a, b);
      if (!above(a) && above(b)) up = key_of(a, b);
    }
    if (down.first >= 0) segments.push_back({down, up, static_cast<int>(t)});
  }

  std::map<EdgeKey, std::vector<int>> leaving, arriving;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    leaving[segments[s].from].push_back(static_cast<int>(s));
    arriving[segments[s].to].push_back(static_cast<int>(s));
  }
  const auto point_on = [&](const EdgeKey& edge) {
    const double a = height[edge.first], b = height[edge.second];
    const double u = a / (a - b);
    return Eigen::Vector3d((1 - u) * mesh.vertices[edge.first] + u * mesh.vertices[edge.second]);
  };

  std::vector<SectionLoop> loops;
  std::vector<char> used(segments.size(), 0);
  const auto next_free = [&](const std::map<EdgeKey, std::vector<int>>& at, const EdgeKey& edge) {
    const auto found = at.find(edge);
    if (found != at.end())
      for (int s : found->second)
        if (!used[s]) return s;
    return -1;
  };
  for (std::size_t first = 0; first < segments.size(); ++first) {
    if (used[first]) continue;
    int start = static_cast<int>(first);  // go back to the open end, or round to where we began
    for (std::size_t steps = 0; steps < segments.size(); ++steps) {
      const int before = next_free(arriving, segments[start].from);
      if (before < 0 || before == static_cast<int>(first)) break;
      start = before;
    }
    SectionLoop loop{{}, {}, false};
    int s = start;
    EdgeKey last;
    while (s >= 0) {
      used[s] = 1;
      loop.points.push_back(point_on(segments[s].from));
      loop.triangles.push_back(segments[s].triangle);
      last = segments[s].to;
      s = next_free(leaving, last);
    }
    loop.closed = last == segments[start].from;
    if (!loop.closed) loop.points.push_back(point_on(last));
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Eigen::Vector3d> smoothed(const std::vector<Eigen::Vector3d>& line, double deviation, int reach) {
  const int last = static_cast<int>(line.size()) - 1;
  std::vector<Eigen::Vector3d> result(line.size(), Eigen::Vector3d::Zero());
  for (int i = 0; i <= last; ++i) {
    double sum = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double w = std::exp(-0.5 * k * k / (deviation * deviation));
      result[i] += w * line[std::clamp(i + k, 0, last)];
      sum += w;
    }
    result[i] /= sum;
  }
  return result;
}

bool is_outline(const SectionLoop& loop, const Eigen::Vector3d& normal) {
  Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& first = loop.points.front();
  for (std::size_t i = 1; i + 1 < loop.points.size(); ++i)
    twice_area += area_vector(first, loop.points[i], loop.points[i + 1]);
  return twice_area.dot(normal) > 0;
}

double length_of(const std::vector<Eigen::Vector3d>& points, bool closed) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  if (closed && points.size() > 1) length += (points.front() - points.back()).norm();
  return length;
}

double distance_to_line(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& line) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector3d way = line[i] - line[i - 1], to = point - line[i - 1];
    const double length = way.squaredNorm(),
                 part = length > 0 ? std::clamp(to.dot(way) / length, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (to - part * way).squaredNorm());
  }
  return std::sqrt(nearest);
}

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  // Andrew's monotone chain
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull(2 * points.size());
  std::size_t k = 0;
  const auto right_turn = [&hull](std::size_t at, const Eigen::Vector2d& p) {
    const Eigen::Vector2d u = hull[at - 1] - hull[at - 2], v = p - hull[at - 2];
    return u.x() * v.y() - u.y() * v.x() <= 0;
  };
  for (const Eigen::Vector2d& p : points) {
    while (k >= 2 && right_turn(k, p)) --k;
    hull[k++] = p;
  }
  const std::size_t lower = k + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    while (k >= lower && right_turn(k, points[i])) --k;
    hull[k++] = points[i];
  }
  hull.resize(k - 1);
  return hull;
}

std::vector<Eigen::Vector3d> tape(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal) {
  if (points.empty()) return {};
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const Eigen::Vector3d& origin = points.front();
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(u.dot(p - origin), v.dot(p - origin));
  std::vector<Eigen::Vector3d> loop;
  for (const Eigen::Vector2d& p : convex_hull(std::move(flat)))
    loop.push_back(origin + p.x() * u + p.y() * v);
  return loop;
}

}  // namespace tensegric_fit::geometry
