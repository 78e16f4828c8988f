#include "geometry/crossing_triangles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel_for.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Array3d;
using Eigen::Array3i;
using Eigen::Vector3d;

constexpr double kMostCells = 8;  // of a grid, per triangle in it: cells that are mostly empty take time, too
// Of triangles in cells: a few that are much larger than the others would each lie in most cells.
constexpr double kMostEntries = 16;

// Six times the volume of the tetrahedron, positive where d is on the side that sees a, b, c
// counter-clockwise.
double volume(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

// On which sides of a triangle's plane the corners of another lie, as such volumes.
Array3d sides(const Corners& of, const Corners& t) {
  return {volume(t[0], t[1], t[2], of[0]), volume(t[0], t[1], t[2], of[1]), volume(t[0], t[1], t[2], of[2])};
}

// Where edges of a triangle go through the inside of another.
void add_passages(const Corners& edges, const Array3d& side, const Corners& t,
                  std::vector<Vector3d>& points) {
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    if (!(side[i] > 0 && side[next] < 0) && !(side[i] < 0 && side[next] > 0)) continue;
    const Vector3d &from = edges[i], &to = edges[next];
    const double a = volume(from, to, t[0], t[1]), b = volume(from, to, t[1], t[2]),
                 c = volume(from, to, t[2], t[0]);
    if ((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))
      points.push_back(from + side[i] / (side[i] - side[next]) * (to - from));
  }
}

bool lies_beside(const Array3d& side) {
  return (side >= 0).all() || (side <= 0).all();
}

struct Box {
  Array3d low, high;
  bool meets(const Box& other) const { return (low <= other.high).all() && (other.low <= high).all(); }
};

// The triangles that are looked at, by the cells of a uniform grid that their boxes touch.
class Grid {
 public:
  Grid(const std::vector<Box>& boxes, const std::vector<char>& is_looked_at) {
    whole_.low.setConstant(std::numeric_limits<double>::infinity());
    whole_.high = -whole_.low;
    double size = 0;
    int count = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_looked_at[i]) continue;
      whole_.low = whole_.low.min(boxes[i].low);
      whole_.high = whole_.high.max(boxes[i].high);
      size += (boxes[i].high - boxes[i].low).maxCoeff();
      ++count;
    }
    if (count == 0) return;
    const Array3d extent = whole_.high - whole_.low;
    const double most = kMostCells * count;
    cell_ = std::max({size / count, extent.maxCoeff() / most, std::numeric_limits<double>::min()});
    const auto divide = [&] {
      while (((extent / cell_).floor() + 1).prod() > most) cell_ *= 1.5;  // ends at one cell at the latest
      counts_ = (extent / cell_).floor().cast<int>() + 1;
    };
    for (divide(); has_more_entries(boxes, is_looked_at, kMostEntries * count); divide()) cell_ *= 1.5;
    starts_.assign(static_cast<std::size_t>(counts_.prod()) + 1, 0);
    // Twice over all boxes: first to count, then to fill.
    const auto for_all = [&](const auto& visit) {
      for (std::size_t i = 0; i < boxes.size(); ++i)
        if (is_looked_at[i]) for_cells(boxes[i], [&](int cell) { visit(static_cast<int>(i), cell); });
    };
    for_all([&](int, int cell) { ++starts_[cell + 1]; });
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    entries_.resize(static_cast<std::size_t>(starts_.back()));
    std::vector<int> filled(starts_.begin(), starts_.end() - 1);
    for_all([&](int triangle, int cell) { entries_[filled[cell]++] = {boxes[triangle], triangle}; });
  }

  // Every triangle in the grid with a number above `after` whose box meets this one, once.
  template <typename Visit>
  void for_meeting(const Box& box, int after, const Visit& visit) const {
    if (entries_.empty() || !whole_.meets(box)) return;
    for_cells(box, [&](int cell) {
      for (int at = starts_[cell]; at < starts_[cell + 1]; ++at) {
        const Entry& other = entries_[at];
        // Of the cells that both touch it is the one where their common part begins.
        if (other.triangle > after && box.meets(other.box) &&
            cell == number(at_cell(box.low.max(other.box.low))))
          visit(other.triangle);
      }
    });
  }

 private:
  struct Entry {
    Box box;
    int triangle;
  };

  Array3i at_cell(const Array3d& point) const {
    return ((point - whole_.low) / cell_).floor().max(0.0).min((counts_ - 1).cast<double>()).cast<int>();
  }
  int number(const Array3i& at) const { return (at[2] * counts_[1] + at[1]) * counts_[0] + at[0]; }

  bool has_more_entries(const std::vector<Box>& boxes, const std::vector<char>& is_looked_at,
                        double most) const {
    double entries = 0;
    for (std::size_t i = 0; i < boxes.size() && entries <= most; ++i)
      if (is_looked_at[i])
        entries += (at_cell(boxes[i].high) - at_cell(boxes[i].low) + 1).cast<double>().prod();
    return entries > most;
  }

  template <typename Visit>
  void for_cells(const Box& box, const Visit& visit) const {
    const Array3i first = at_cell(box.low), last = at_cell(box.high);
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) visit(number({x, y, z}));
  }

  Box whole_;
  double cell_ = 1;
  Array3i counts_ = Array3i::Zero();
  std::vector<int> starts_;  // of cell i: entries_[starts_[i]] to entries_[starts_[i + 1]]
  std::vector<Entry> entries_;
};

bool share_a_corner(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  for (int i = 0; i < 3; ++i)
    if (a[i] == b[0] || a[i] == b[1] || a[i] == b[2]) return true;
  return false;
}

}  // namespace

std::vector<Vector3d> passages(const Corners& one, const Corners& other) {
  const Array3d side_of_one = sides(one, other);
  if (lies_beside(side_of_one)) return {};
  const Array3d side_of_other = sides(other, one);
  if (lies_beside(side_of_other)) return {};
  std::vector<Vector3d> points;
  add_passages(one, side_of_one, other, points);
  add_passages(other, side_of_other, one, points);
  return points;
}

double crossing_depth(const Corners& one, const Corners& other) {
  const auto behind = [](const Corners& t, const Corners& plane) {
    const Vector3d normal = area_vector(plane[0], plane[1], plane[2]).normalized();
    double most = 0;
    for (const Vector3d& corner : t) most = std::max(most, normal.dot(plane[0] - corner));
    return most;
  };
  return std::min(behind(one, other), behind(other, one));
}

std::vector<std::pair<int, int>> crossing_pairs(const std::vector<Vector3d>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles,
                                                const std::vector<char>& looked_at) {
  const auto corners = [&](int i) {
    const Eigen::Vector3i& t = triangles[i];
    return Corners{vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  };
  std::vector<char> is_looked_at(triangles.size());
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3i& t = triangles[i];
    is_looked_at[i] = looked_at[t[0]] || looked_at[t[1]] || looked_at[t[2]];
    const Array3d a = vertices[t[0]].array(), b = vertices[t[1]].array(), c = vertices[t[2]].array();
    boxes[i] = {a.min(b).min(c), a.max(b).max(c)};
  }
  const Grid grid(boxes, is_looked_at);
  std::array<std::vector<std::pair<int, int>>, 2> halves;
  parallel_for(triangles.size(), [&](std::size_t begin, std::size_t end, int half) {
    for (std::size_t at = begin; at < end; ++at) {
      const int i = static_cast<int>(at);
      grid.for_meeting(boxes[at], is_looked_at[at] ? i : -1, [&](int j) {
        if (share_a_corner(triangles[i], triangles[j])) return;
        if (!passages(corners(i), corners(j)).empty())
          halves[half].emplace_back(std::min(i, j), std::max(i, j));
      });
    }
  });
  std::vector<std::pair<int, int>> pairs = std::move(halves[0]);
  pairs.insert(pairs.end(), halves[1].begin(), halves[1].end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace tensegric_fit::geometry
