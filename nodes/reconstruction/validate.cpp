#include "reconstruction/validate.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "body_model/registration.hpp"
#include "geometry/percentile.hpp"
#include "geometry/scan_extent.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::reconstruction {
namespace {

namespace refusal = geometry::refusal;
using geometry::Refusal;

constexpr double kBoothReach = 4.0;     // m from the middle: farther points are stray
constexpr double kTypicalExtent = 1.7;  // m, of a body

/// Low, middle and high coordinates without the stray points, as rows.
std::array<Eigen::Vector3d, 3> spread(const std::vector<Eigen::Vector3d>& points) {
  std::array<Eigen::Vector3d, 3> result;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(), [axis](const auto& p) { return p[axis]; });
    result[0][axis] = geometry::percentile(values, 0.01);
    result[1][axis] = geometry::percentile(values, 0.5);
    result[2][axis] = geometry::percentile(values, 0.99);
  }
  return result;
}

void check_unit(double extent) {
  if (extent < geometry::kScanExtent.low)
    throw Refusal(refusal::kWrongUnit, fmt::format("the scan is {:.4g} across; points must be in metres, a "
                                                   "body is larger",
                                                   extent));
  if (extent <= geometry::kScanExtent.high) return;
  struct Unit {
    const char* name;
    double per_metre;
  };
  constexpr Unit kUnits[] = {{"centimetres", 100}, {"inches", 39.37}, {"millimetres", 1000}};
  const Unit* likely = nullptr;
  for (const Unit& unit : kUnits) {
    const auto distance = [&](const Unit& u) {
      return std::abs(std::log(extent / (u.per_metre * kTypicalExtent)));
    };
    if (likely == nullptr || distance(unit) < distance(*likely)) likely = &unit;
  }
  throw Refusal(refusal::kWrongUnit,
                fmt::format("the scan is {:.4g} across; points must be in metres, these look like {}", extent,
                            likely->name));
}

}  // namespace

void check_options(const Options& options) {
  geometry::check_option("body_triangles", options.body_triangles, kBodyTriangles);
  geometry::check_option("poisson_depth", options.poisson_depth, kPoissonDepth);
  geometry::check_option("min_points", options.min_points, kMinPoints);
  geometry::check_option("max_points", options.max_points, kMaxPoints);
  geometry::check_option("support_distance", options.support_distance, kSupportDistance);
  if (options.min_points > options.max_points)
    throw Refusal(refusal::kBadOption, "min_points is greater than max_points");
}

geometry::PointCloud usable_points(const geometry::PointCloud& scan, const Options& options) {
  const std::size_t count = scan.points.size();
  if (count == 0) throw Refusal(refusal::kEmptyCloud, "the scan has no points");
  if (!scan.normals.empty() && scan.normals.size() != count)
    throw Refusal(refusal::kWrongFields,
                  fmt::format("the scan has {} points and {} normals", count, scan.normals.size()));
  if (!scan.sensor.empty() && scan.sensor.size() != count)
    throw Refusal(refusal::kWrongFields,
                  fmt::format("the scan has {} points and sensors of {}", count, scan.sensor.size()));
  if (count > static_cast<std::size_t>(options.max_points))
    throw Refusal(refusal::kTooManyPoints,
                  fmt::format("the scan has {} points, more than {}", count, options.max_points));

  std::vector<Eigen::Vector3d> finite;
  std::copy_if(scan.points.begin(), scan.points.end(), std::back_inserter(finite),
               [](const Eigen::Vector3d& p) { return p.allFinite(); });
  if (finite.empty()) throw Refusal(refusal::kNonFinite, fmt::format("none of {} points is finite", count));
  if (finite.size() < static_cast<std::size_t>(options.min_points))
    throw Refusal(refusal::kTooFewPoints, fmt::format("the scan has {} finite points, {} are needed",
                                                      finite.size(), options.min_points));
  const auto [low, middle, high] = spread(finite);
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0)) throw Refusal(refusal::kNotABody, "all points of the scan lie in one place");
  check_unit(extent);

  geometry::PointCloud usable;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& p = scan.points[i];
    if (!p.allFinite() || (p - middle).lpNorm<Eigen::Infinity>() > kBoothReach) continue;
    usable.points.push_back(p);
    if (!scan.sensor.empty()) usable.sensor.push_back(scan.sensor[i]);
    if (scan.normals.empty()) continue;
    const Eigen::Vector3d& n = scan.normals[i];
    const bool is_unit = n.allFinite() && std::abs(n.squaredNorm() - 1) < 0.1;
    usable.normals.push_back(is_unit ? n : Eigen::Vector3d::Zero());
  }
  if (usable.points.size() < static_cast<std::size_t>(options.min_points))
    throw Refusal(refusal::kTooFewPoints,
                  fmt::format("the scan has {} points within {:g} m of its middle, {} are needed",
                              usable.points.size(), kBoothReach, options.min_points));
  return usable;
}

std::optional<Refusal> fault_of_shape(const std::vector<Eigen::Vector3d>& body, const Options& options) {
  if (body.size() < static_cast<std::size_t>(options.min_points) / 10)
    return Refusal(refusal::kNotABody, "nothing stands out of the floor and the stray points of the scan");
  if (body.size() < static_cast<std::size_t>(options.min_points))
    return Refusal(refusal::kTooFewPoints,
                   fmt::format("the largest thing in the scan has {} points, {} are needed", body.size(),
                               options.min_points));
  const auto [low, middle, high] = spread(body);
  const double height = high.z() - low.z();
  if (height < body_model::kLowestPerson || height > body_model::kHighestPerson)
    return Refusal(refusal::kNotABody,
                   fmt::format("what was scanned is {:.2f} m high; a body is {} to {} m", height,
                               body_model::kLowestPerson, body_model::kHighestPerson));

  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& p : body) {
    const Eigen::Vector2d d = (p - middle).head<2>();
    covariance += d * d.transpose() / static_cast<double>(body.size());
  }
  const Eigen::Vector2d deviation =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues().cwiseMax(0).cwiseSqrt();
  if (deviation[0] < 0.02)
    return Refusal(refusal::kNotABody,
                   fmt::format("what was scanned is flat: {:.0f} mm deep", 4e3 * deviation[0]));
  if (deviation[0] > 0.2 * height || deviation[1] > 0.45 * height)
    return Refusal(refusal::kNotABody, "what was scanned is too wide for its height to be an upright body");
  return std::nullopt;
}

}  // namespace tensegric_fit::reconstruction
