#include "mesh_files/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/scan_extent.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace refusal = geometry::refusal;
using Eigen::Vector3d;
using geometry::Refusal;
using Points = std::vector<Vector3d>;

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit kUnits[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}};
constexpr const char* kAxes[] = {"x", "y", "z", "-x", "-y", "-z"};

constexpr double kShortest = 1.2, kTallest = 2.2;  // m, statures
constexpr double kSmallest = 0.4, kLargest = 4.0;  // m, parts of a person; a booth with its floor
// Share of points at either end; where the size in a given unit is checked twice that, as when
// reconstructing.
constexpr double kStray = 0.005;
constexpr double kDeepest = 0.36;  // share of a stature: a whole person is less deep, a trunk deeper
constexpr double kUpright = 0.5, kAsLong = 0.8;  // shares of the longest extent
constexpr double kClearly = 1.25;                // how much faster the head's end widens
// Share of the height: edge of a cell. Parts up to 2.8 edges, 0.042, apart may be joined; the calves of 24
// training surfaces are 0.044 of it and more apart.
constexpr double kBeside = 0.015;
constexpr double kAside = 2;  // of the height: what lies farther aside is stray; arms reach half of it
constexpr std::size_t kOutline = 10;  // points: fewer say nothing about a width (tolerance)

int axis_of(const std::string& up) {
  return static_cast<int>(up.back() - 'x');
}

Vector3d direction(const std::string& up) {
  return (up.front() == '-' ? -1.0 : 1.0) * Vector3d::Unit(axis_of(up));
}

/// The axes' extents without a share of stray points at either end, and the lowest.
struct Spread {
  Vector3d low, extent;
};

Spread spread_of(const Points& points, double share) {
  Spread spread;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Vector3d& p : points)
      if (p.allFinite()) values.push_back(p[axis]);
    if (values.empty()) throw Refusal(refusal::kNonFinite, "the scan has no finite point");
    std::sort(values.begin(), values.end());
    const auto stray = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    spread.low[axis] = values[stray];
    spread.extent[axis] = values[values.size() - 1 - stray] - values[stray];
  }
  return spread;
}

std::string unit_of(const Spread& spread) {
  Vector3d extent = spread.extent;
  std::sort(extent.begin(), extent.end());
  const double longest = extent[2];
  std::vector<const Unit*> fit;
  const Unit* stature = nullptr;
  for (const Unit& unit : kUnits) {
    const double metres = longest * unit.metres;
    if (metres >= kShortest && metres <= kTallest) stature = &unit;
    if (metres >= kSmallest && metres <= kLargest) fit.push_back(&unit);
  }
  if (stature != nullptr && (fit.size() == 1 || extent[0] <= kDeepest * longest)) return stature->name;
  if (longest < geometry::kScanExtent.high && fit.size() <= 1)
    return "m";  // the reconstruction says what is wrong with it
  if (fit.size() == 1) return fit.front()->name;
  if (fit.empty())
    throw Refusal(refusal::kWrongUnit,
                  fmt::format("the scan is {:.4g} across: a body in none of m, cm, mm, inch", longest));
  throw Refusal(
      refusal::kWrongUnit,
      fmt::format("the scan is {:.4g} across: {:.2f} m if it is in {}, {:.2f} m if in {}; nothing says which",
                  longest, longest * fit[0]->metres, fit[0]->name, longest * fit[1]->metres, fit[1]->name));
}

/// Else the reconstruction would say what it lacks: points, or another unit than the one that was given.
void check_given(const std::string& unit, double metres) {
  if (metres == 0 || geometry::kScanExtent.holds(metres)) return;
  throw Refusal(refusal::kWrongUnit,
                fmt::format("in the unit that is given, {}, the scan is {:.4g} m across", unit, metres));
}

/// Seen along `axis`, those of `points` that hang together with `end`: not a second leg beside the end of the
/// other one. All of them where hardly any do.
Points together_with(const Points& end, const Points& points, const Spread& spread, int axis) {
  const double cell = kBeside * spread.extent[axis];
  const auto cell_of = [&](const Vector3d& p) {
    const Vector3d from_low = (p - spread.low) / cell;
    return std::pair(static_cast<int>(std::floor(from_low[(axis + 1) % 3])),
                     static_cast<int>(std::floor(from_low[(axis + 2) % 3])));
  };
  std::map<std::pair<int, int>, Points> open;
  for (const Vector3d& p : points) open[cell_of(p)].push_back(p);
  Points found;
  std::vector<std::pair<int, int>> reached;
  for (const Vector3d& p : end) reached.push_back(cell_of(p));
  while (!reached.empty()) {
    const auto [i, j] = reached.back();
    reached.pop_back();
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        const auto at = open.find({i + di, j + dj});
        if (at == open.end()) continue;
        found.insert(found.end(), at->second.begin(), at->second.end());
        open.erase(at);
        reached.emplace_back(i + di, j + dj);
      }
  }
  return found.size() < kOutline ? points : found;
}

double width_of(const Points& points, int axis) {
  if (points.size() < kOutline) return 0;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  double sum = 0;
  for (Vector3d p : points) {
    p -= mean;
    p[axis] = 0;
    sum += p.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// How much wider she is a fifth of the height below this end than near it: from face to shoulders about
/// double.
double widening(const Points& points, const Spread& spread, int axis, bool from_top) {
  const auto slab = [&](double near, double far) {
    Points between;
    for (const Vector3d& p : points) {
      const Vector3d shares = (p - spread.low) / spread.extent[axis];
      const double depth = from_top ? 1 - shares[axis] : shares[axis];
      if (depth >= near && depth <= far && shares.cwiseAbs().maxCoeff() <= kAside) between.push_back(p);
    }
    return between;
  };
  const Points end = slab(0.04, 0.10);
  const double width = width_of(end, axis);
  return width == 0 ? 0 : width_of(together_with(end, slab(0.17, 0.23), spread, axis), axis) / width;
}

Refusal two_axes(const std::string& a, const std::string& b) {
  return {refusal::kWrongAxes,
          fmt::format("the body could stand with {} or with {} up, and its shape does not say which", a, b)};
}

std::string up_of(const Points& points, const Spread& spread, const Kind& kind, double metres) {
  const double longest = spread.extent.maxCoeff();
  const bool whole = longest * metres >= kShortest && longest * metres <= kTallest;
  if (!whole) return kind.usual_up.empty() ? "z" : kind.usual_up;
  if (!kind.surface && spread.extent.z() >= kUpright * longest) return "z";
  std::vector<std::pair<double, std::string>> ends;
  for (const char* up : kAxes) {
    const int axis = axis_of(up);
    if (spread.extent[axis] >= kAsLong * longest)
      ends.emplace_back(widening(points, spread, axis, up[0] != '-'), up);
  }
  std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (ends[0].first > 0 && ends[0].first >= kClearly * ends[1].first) return ends[0].second;
  for (const auto& end : ends)
    if (end.second == kind.usual_up) return kind.usual_up;
  throw two_axes(ends[0].second, ends[1].second);
}

}  // namespace

double Reading::metres() const {
  for (const Unit& known : kUnits)
    if (unit == known.name) return known.metres;
  return 1;
}

Eigen::Matrix3d Reading::turn() const {
  // Quarter turns only, so that coordinates stay what they are.
  const Vector3d z = direction(up);
  const Vector3d x = axis_of(up) == 0 ? Vector3d::UnitY() : Vector3d::UnitX();
  Eigen::Matrix3d rows;
  rows << x.transpose(), z.cross(x).transpose(), z.transpose();
  return rows;
}

Vector3d Reading::operator()(const Vector3d& p) const {
  return (metres() * (turn() * p)).cast<float>().cast<double>();
}

void check_asked(const Asked& asked) {
  const auto is_known = [&](const Unit& unit) { return asked.unit == unit.name; };
  if (!asked.unit.empty() && std::none_of(std::begin(kUnits), std::end(kUnits), is_known))
    throw Refusal(refusal::kBadOption, "'" + asked.unit + "' is no unit: m, cm, mm, inch");
  if (!asked.up.empty() && std::find(std::begin(kAxes), std::end(kAxes), asked.up) == std::end(kAxes))
    throw Refusal(refusal::kBadOption, "'" + asked.up + "' is no axis: x, y, z, -x, -y, -z");
}

Reading infer_reading(const Points& points, const Kind& kind, const Asked& asked) {
  check_asked(asked);
  Reading reading;
  const Spread spread = spread_of(points, kStray);
  reading.unit = asked.unit.empty() ? unit_of(spread) : asked.unit;
  if (!asked.unit.empty() && !kind.any_size)
    check_given(asked.unit, spread_of(points, 2 * kStray).extent.maxCoeff() * reading.metres());
  reading.up = asked.up.empty() ? up_of(points, spread, kind, reading.metres()) : asked.up;
  return reading;
}

}  // namespace tensegric_fit::mesh_files
