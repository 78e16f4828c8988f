#include "tffd/lay_line.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/even_steps.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/section.hpp"
#include "geometry/status.hpp"
#include "tffd/skin_near.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::CarriedPoint;
using geometry::Refusal;
using geometry::SurfacePoint;
namespace refusal = geometry::refusal;

constexpr double kTurn = 0.020;        // m: the way across the band is averaged over so much of it
constexpr int kFibres = 7;             // of a band; of a thread one
constexpr double kPointsPerReach = 2;  // of averaged fibres: closer ones add nothing
// m: what a point may lie inside the tape and touch it, far above rounding. With 0.5 mm taut bands would be
// asked to shorten by 4 % more than the finite elements' (tests/calibration/README.md).
constexpr double kOffTheTape = 1e-5;

// Unit vectors over the skin, square to the band, smooth along it.
std::vector<Vector3d> across(const std::vector<SurfacePoint>& middle, const SkinNear& skin) {
  const int count = static_cast<int>(middle.size());
  std::vector<Vector3d> raw;
  for (int i = 0; i < count; ++i) {
    const Vector3d along = middle[std::min(i + 1, count - 1)].position - middle[std::max(i - 1, 0)].position;
    raw.push_back(skin.normal(middle[i]).cross(along));
  }
  const int reach = static_cast<int>(kTurn / kLineSpacing);
  std::vector<Vector3d> smooth;
  for (int i = 0; i < count; ++i) {
    Vector3d sum = Vector3d::Zero();
    for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) sum += raw[j];
    smooth.push_back(sum.normalized());
  }
  return smooth;
}

// How the fibres of a cup spread: the row on which they end, from right to left, and the ways to its nodes.
struct Fan {
  std::vector<Vector3d> row;
  std::vector<std::vector<Vector3d>> ways;

  Vector3d along() const { return (row.back() - row.front()).normalized(); }
};

// `left`: beside the point from which they spread.
Fan fan_of(const LineOnBody& line, const Vector3d& left) {
  Fan fan{{}, line.fan};
  for (const std::vector<Vector3d>& way : fan.ways) fan.row.push_back(way.back());
  if (left.dot(fan.along()) < 0) {
    std::reverse(fan.row.begin(), fan.row.end());
    std::reverse(fan.ways.begin(), fan.ways.end());
  }
  return fan;
}

// Takes a fibre on to its end: fibre `f` of `count`.
void spread(std::vector<SurfacePoint>& fibre, const Fan& fan, int f, int count, const SkinNear& skin) {
  const auto [segment, share] = geometry::even_places(fan.row, count)[f];
  std::vector<Vector3d> way = fan.ways[share < 0.5 ? segment : segment + 1];
  way.front() = fibre.back().position;
  way.back() = skin.below(fan.row[segment] + share * (fan.row[segment + 1] - fan.row[segment])).position;
  const std::vector<SurfacePoint> shortest = skin.shortest(way);
  fibre.insert(fibre.end(), shortest.begin() + 1, shortest.end());
}

// Mean of the points up to `reach` metres to either side along the fibre, which count the less the farther
// they are; nearer ones only near its ends, which stay.
std::vector<CarriedPoint> averaged(const std::vector<CarriedPoint>& points, double reach) {
  std::vector<double> at{0};
  for (std::size_t i = 1; i < points.size(); ++i)
    at.push_back(at.back() + (points[i].rest - points[i - 1].rest).norm());
  // The weight of a point falls evenly to nothing at `half`: its integral from the middle.
  const auto weight_to = [](double way, double half) { return way - way * std::abs(way) / (2 * half); };
  // Point j stands for the way from ends[j] to ends[j + 1], from half way before it to half way after it.
  std::vector<double> ends{0};
  for (std::size_t i = 1; i < points.size(); ++i) ends.push_back((at[i - 1] + at[i]) / 2);
  ends.push_back(at.back());
  std::vector<CarriedPoint> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double half = std::min({reach, at[i], at.back() - at[i]});
    std::map<int, double> weights;
    Vector3d rest = Vector3d::Zero();
    double sum = 0;
    const auto first = std::upper_bound(ends.begin() + 1, ends.end(), at[i] - half) - ends.begin() - 1;
    for (std::size_t j = std::min(static_cast<std::size_t>(first), i);
         j < points.size() && (j <= i || ends[j] < at[i] + half); ++j) {
      const double begin = std::max(ends[j], at[i] - half), end = std::min(ends[j + 1], at[i] + half);
      if (!(end > begin) && j != i) continue;
      const double weight = half > 0 && end > begin
                                ? weight_to(end - at[i], half) - weight_to(begin - at[i], half)
                                : (j == i ? 1 : 0);
      sum += weight;
      rest += weight * points[j].rest;
      for (const auto& [node, part] : points[j].weights) weights[node] += weight * part;
    }
    CarriedPoint mean{rest / sum, {}};
    for (const auto& [node, weight] : weights)
      if (weight != 0) mean.weights.emplace_back(node, weight / sum);
    result.push_back(mean);
  }
  return result;
}

// The points that a tape pulled round the fibre from outside touches at rest, and the ends. `normals`: of the
// skin at each point. The tape is closed: its way back may touch the bottom of a hollow from inside.
std::vector<CarriedPoint> on_the_tape(const std::vector<CarriedPoint>& points,
                                      const std::vector<Vector3d>& normals) {
  Vector3d mean = Vector3d::Zero();
  for (const CarriedPoint& point : points) mean += point.rest / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const CarriedPoint& point : points) spread += (point.rest - mean) * (point.rest - mean).transpose();
  const Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  std::vector<Vector3d> rest;
  for (const CarriedPoint& point : points) rest.push_back(point.rest);
  const std::vector<Vector3d> tape = geometry::tape(rest, normal);
  Vector3d inside = Vector3d::Zero();
  for (const Vector3d& corner : tape) inside += corner / static_cast<double>(tape.size());
  std::vector<CarriedPoint> touched{points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    double off = kFarFromSkin;
    for (std::size_t s = 0; s < tape.size(); ++s) {
      const Vector3d &a = tape[s], &b = tape[(s + 1) % tape.size()];
      Vector3d from = points[i].rest - a, along = b - a;
      from -= normal.dot(from) * normal;
      along -= normal.dot(along) * normal;
      const Vector3d square = normal.cross(along);
      const Vector3d outward = square.dot(a - inside) > 0 ? square : Vector3d(-square);
      if (!(outward.dot(normals[i]) > 0)) continue;
      const double t = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
      off = std::min(off, (from - t * along).norm());
    }
    if (off <= kOffTheTape) touched.push_back(points[i]);
  }
  touched.push_back(points.back());
  return touched;
}

// A tape's own points between those that it touches: each is carried by both ends of its span.
std::vector<CarriedPoint> spanned(const std::vector<CarriedPoint>& touched) {
  std::vector<CarriedPoint> points;
  for (std::size_t i = 0; i + 1 < touched.size(); ++i) {
    const CarriedPoint &a = touched[i], &b = touched[i + 1];
    const int steps = std::max(1, static_cast<int>(std::lround((b.rest - a.rest).norm() / kLineSpacing)));
    for (int k = 0; k < steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      std::map<int, double> weights;
      for (const auto& [node, weight] : a.weights) weights[node] += (1 - share) * weight;
      if (share > 0)  // what a point with no part in it moves says nothing of this one
        for (const auto& [node, weight] : b.weights) weights[node] += share * weight;
      points.push_back({(1 - share) * a.rest + share * b.rest, {weights.begin(), weights.end()}});
    }
  }
  points.push_back(touched.back());
  return points;
}

// As few points as describe the course of a fibre that was averaged over `reach`: as evenly as whole points
// allow, the same from either end. A short last step would bend sharply, and a band over her middle would not
// be symmetric.
std::vector<CarriedPoint> thinned(const std::vector<CarriedPoint>& points, double reach) {
  const auto step =
      std::max<std::size_t>(1, static_cast<std::size_t>(reach / kPointsPerReach / kLineSpacing));
  const std::size_t last = points.size() - 1;
  std::size_t parts = std::max<std::size_t>(1, (last + step / 2) / step);
  if (last % 2 == 1 && parts % 2 == 0) ++parts;  // no point is the middle one
  std::vector<CarriedPoint> kept;
  for (std::size_t k = 0; k <= parts; ++k) {
    const std::size_t from_end = (std::min(k, parts - k) * last + parts / 2) / parts;
    kept.push_back(points[2 * k <= parts ? from_end : last - from_end]);
  }
  return kept;
}

}  // namespace

std::vector<geometry::Fibre> lay_line(const LineOnBody& line, const geometry::TriangleMesh& body,
                                      const Binding& binding) {
  if (binding.weights().nodes.cols() == 0)
    throw Refusal(refusal::kBadOption,
                  "t-FFD: the paper's setting has no constant weights to carry a line by");
  const bool is_cup = !line.fan.empty();
  const std::vector<Vector3d> course = is_cup && line.points.size() == 1 ? line.points : evenly(line.points);
  std::vector<Vector3d> everywhere = course;
  for (const std::vector<Vector3d>& way : line.fan)
    everywhere.insert(everywhere.end(), way.begin(), way.end());
  const SkinNear skin(body, everywhere);
  std::vector<SurfacePoint> middle;
  for (const Vector3d& point : course) middle.push_back(skin.below(point));
  std::vector<Vector3d> sideways = across(middle, skin);
  Fan fan;
  if (is_cup && course.size() > 1) {
    fan = fan_of(line, sideways.back());
  } else if (is_cup) {
    const Vector3d down = line.fan[line.fan.size() / 2].back() - course.front();
    fan = fan_of(line, skin.normal(middle.front()).cross(down));
    sideways.front() = fan.along();
  }

  const int count = line.width > 0 ? kFibres : 1;
  std::vector<geometry::Fibre> fibres(count);
  const auto lay = [&](int f) {
    const double place = count > 1 ? 2.0 * f / (count - 1) - 1 : 0;  // -1 to 1 across the band
    const double share = std::abs(place) == 1 ? 0.5 : 1;  // the trapezoid rule: even over the width
    std::vector<SurfacePoint> way;
    for (std::size_t i = 0; i < middle.size(); ++i)
      way.push_back(skin.march(middle[i], sideways[i], place * line.width / 2));
    if (is_cup) spread(way, fan, f, count, skin);
    std::vector<CarriedPoint> points;
    std::vector<Vector3d> normals;
    for (const SurfacePoint& at : way) {
      points.push_back(binding.carried(at, skin.corners(at)));
      normals.push_back(skin.normal(at));
    }
    if (line.held[0]) points.front().weights.clear();
    if (line.held[1]) points.back().weights.clear();
    if (line.taut) points = spanned(on_the_tape(points, normals));
    if (line.smooth > 0) points = averaged(points, line.smooth);
    fibres[f] = {share, thinned(points, line.smooth)};
  };
  geometry::parallel_for(fibres.size(), [&lay](std::size_t begin, std::size_t end, int) {
    for (std::size_t f = begin; f < end; ++f) lay(static_cast<int>(f));
  });
  double shares = 0;
  for (const geometry::Fibre& fibre : fibres) shares += fibre.share;
  for (geometry::Fibre& fibre : fibres) fibre.share /= shares;
  return fibres;
}

}  // namespace tensegric_fit::tffd
