#include "reconstruction/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "geometry/point_tree.hpp"
#include "geometry/triangle_mesh.hpp"
#include "reconstruction/body_points.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kBare = 0.03;  // m of RegisteredBody::support: no points round that skin
constexpr double kLimb = 0.04;  // m from the model's skin: half a forearm's breadth
constexpr int kCompany = 5;  // points, of which one lies within kLimb / 2 of the next: single ones are stray
constexpr double kFarFromBody = 0.3;  // m; farther things are the booth's
constexpr double kSmall = 0.005,
                 kLarge = 0.25;     // of the body's points: less is stray; more is named wherever it is
constexpr double kTall = 0.5;       // of her stature: as large as a person, if it is kLarge, too
constexpr std::size_t kNamed = 10;  // things that are named at most

/// m from p to the box, a lower bound of how far it is from what the box holds.
double off_box(const std::array<Vector3d, 2>& box, const Vector3d& p) {
  return (p - p.cwiseMax(box[0]).cwiseMin(box[1])).norm();
}

}  // namespace

std::vector<int> points_of_limbs(const Points& left_out, const body_model::RegisteredBody& body) {
  if (left_out.empty()) return {};
  const geometry::PointTree skin(body.skin);
  const auto box = geometry::bounding_box(body.skin);
  std::optional<geometry::PointTree> others;
  std::vector<int> near, result;
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (off_box(box, left_out[i]) > kLimb) continue;  // the booth's, most of them
    const int v = skin.nearest(left_out[i]);
    if (body.support[v] < kBare || (body.skin[v] - left_out[i]).norm() > kLimb) continue;
    if (!others) others.emplace(left_out);
    others->nearest(left_out[i], kCompany, near);
    if (near.size() == kCompany && (left_out[near.back()] - left_out[i]).norm() < kLimb / 2)
      result.push_back(static_cast<int>(i));
  }
  return result;
}

std::vector<body_model::Unexplained> things_beside(const Points& left_out,
                                                   const body_model::RegisteredBody& body,
                                                   std::size_t body_points) {
  std::vector<body_model::Unexplained> things;
  if (left_out.empty()) return things;
  const geometry::PointTree skin(body.skin);
  const auto her_box = geometry::bounding_box(body.skin);
  for (const std::vector<int>& thing : things_in(left_out)) {
    const double share = static_cast<double>(thing.size()) / static_cast<double>(body_points);
    if (share < kSmall || things.size() == kNamed) break;
    Points points;
    for (const int i : thing) points.push_back(left_out[i]);
    Vector3d centre = Vector3d::Zero();
    double nearest = 1e9;
    const char* part = "";
    for (const Vector3d& p : points) {
      centre += p / static_cast<double>(points.size());
      if (off_box(her_box, p) >= nearest) continue;
      const int v = skin.nearest(p);
      if ((body.skin[v] - p).norm() >= nearest) continue;
      nearest = (body.skin[v] - p).norm();
      part = body.model->parts[body.model->part[v]].c_str();
    }
    if (nearest > kFarFromBody && share < kLarge) continue;
    const auto box = geometry::bounding_box(points);
    const double extent = (box[1] - box[0]).norm();
    const bool person = share >= kLarge && extent > kTall * body.stature();
    things.push_back(
        {centre, extent, share,
         fmt::format("left out: {} points as {}, {:.0f} mm across, {:.0f} mm from {}", points.size(),
                     person ? "somebody else" : "a thing of its own", 1e3 * extent, 1e3 * nearest, part),
         person});
  }
  return things;
}

}  // namespace tensegric_fit::reconstruction
