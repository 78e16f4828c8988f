#include "virtual_body/skin.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "geometry/points.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;
using geometry::SectionLoop;

constexpr std::size_t kFewest = 8;              // points of a loop that is no sliver
constexpr double kBelow = 0.04, kAbove = 0.11;  // m, of a point under the skin: the flesh over a bone

}  // namespace

Skin::Skin(geometry::TriangleMesh mesh, const std::vector<double>& arm) : whole_(std::move(mesh)) {
  std::vector<char> is_arm, is_trunk;
  for (const Eigen::Vector3i& t : whole_.triangles) {
    is_arm.push_back(arm[t[0]] + arm[t[1]] + arm[t[2]] > 3 * 0.5);
    is_trunk.push_back(!is_arm.back());
  }
  trunk_ = geometry::submesh(whole_, is_trunk);
  arms_ = geometry::submesh(whole_, is_arm);
}

const geometry::TriangleMesh& Skin::mesh(Part part) const {
  return part == Part::whole ? whole_ : part == Part::trunk ? trunk_ : arms_;
}

std::vector<SectionLoop> Skin::cut(const Vector3d& origin, const Vector3d& normal, Part part) const {
  std::vector<SectionLoop> loops;
  for (SectionLoop& loop : geometry::plane_section(mesh(part), origin, normal))
    if (loop.points.size() > kFewest) loops.push_back(std::move(loop));
  return loops;
}

Tape Skin::round_trunk(double height) const {
  Tape points;
  for (const SectionLoop& loop : cut({0, 0, height}, Vector3d::UnitZ(), Part::trunk))
    points.insert(points.end(), loop.points.begin(), loop.points.end());
  return geometry::tape(points, Vector3d::UnitZ());
}

Tape Skin::round_torso(double height) const {
  Tape torso;
  double widest = 0;
  for (const SectionLoop& loop : cut({0, 0, height}, Vector3d::UnitZ(), Part::trunk)) {
    const auto box = geometry::bounding_box(loop.points);
    const double width = (box[1] - box[0]).sum();
    if (width <= widest) continue;
    widest = width;
    torso = loop.points;
  }
  return geometry::tape(torso, Vector3d::UnitZ());
}

Tape Skin::round_nearest(const Vector3d& origin, const Vector3d& normal, Part part) const {
  Tape best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const SectionLoop& loop : cut(origin, normal, part)) {
    const double far = (geometry::mean_of(loop.points) - origin).norm();
    if (far >= nearest) continue;
    nearest = far;
    best = loop.points;
  }
  return geometry::tape(best, normal);
}

SectionLoop Skin::sagittal(const Vector3d& near, Part part) const {
  SectionLoop best{{}, {}, false};
  double nearest = std::numeric_limits<double>::infinity();
  for (SectionLoop& loop : cut(near, Vector3d::UnitY(), part)) {
    double far = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : loop.points) far = std::min(far, (p - near).norm());
    if (far >= nearest) continue;
    nearest = far;
    best = std::move(loop);
  }
  return best;
}

std::optional<Vector3d> Skin::above(const Vector3d& point) const {
  return geometry::highest_near(whole_, point, kBelow, kAbove);
}

double girth(const Tape& tape) {
  return geometry::length_of(tape, true);
}

}  // namespace tensegric_fit::virtual_body
