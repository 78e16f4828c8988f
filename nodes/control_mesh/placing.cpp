#include "control_mesh/placing.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "control_mesh/grid.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kTrunkReach = 0.4;  // m from the axis; no trunk is wider
/// Times the landmark's distance from the axis: beyond that the ray has run on into an arm that touches the
/// trunk.
constexpr double kBeyondLandmark = 1.35;

Vector3d in_body(const geometry::BodyMeasures& measures, const std::string& landmark) {
  const Vector3d p = measures.body_from_scan * measures.landmark(landmark);
  if (!p.allFinite())
    throw geometry::Refusal(geometry::refusal::kNonFinite, "the landmark " + landmark + " is not finite");
  return p;
}

class Placer {
 public:
  Placer(const Template& pattern, const geometry::BodyMeasures& measures, const Skin& skin)
      : pattern_(pattern), measures_(measures), skin_(skin), axis_(trunk_axis(pattern, measures)) {
    positions_.resize(static_cast<std::size_t>(pattern.rows) * pattern.columns, Vector3d::Zero());
    known_.resize(positions_.size(), 0);
  }

  std::vector<Vector3d> place() {
    for (const Side side : {Side::left, Side::right})
      for (const TemplateNode& node : pattern_.nodes)
        if (node.placing != TemplateNode::Placing::between_others)
          set(node.row, node.column, side, position(node, side));
    // Both sides' rows before any column: the columns fill the middle one, which belongs to both.
    for (const Side side : {Side::left, Side::right})
      for (int row = 0; row < pattern_.rows; ++row)
        if (known(row, 0, side) && known(row, pattern_.middle(), side)) fill_row(row, side);
    for (const Side side : {Side::left, Side::right})
      for (int column = 0; column <= pattern_.middle(); ++column) fill_column(column, side);
    return positions_;
  }

 private:
  /// On the middle column both sides' landmarks count alike.
  Vector3d position(const TemplateNode& node, Side side) const {
    const bool on_middle = node.column == pattern_.middle();
    const Side first = on_middle ? Side::left : side, second = on_middle ? Side::right : side;
    if (node.placing == TemplateNode::Placing::at_landmark)
      return skin_.nearest(0.5 * (in_body(measures_, name_on(node.landmark, first)) +
                                  in_body(measures_, name_on(node.landmark, second))));
    const double height = 0.5 * (level(node.level, first) + level(node.level, second));
    const Vector3d direction = (heading(node.angle, first) + heading(node.angle, second)).normalized();
    const Vector3d centre(axis_.x(), axis_.y(), height);
    const auto exit = skin_.first_exit(centre, direction, kTrunkReach);
    if (!exit)
      throw geometry::Refusal(geometry::refusal::kNotABody,
                              "there is no skin round the trunk where row " + std::to_string(node.row) +
                                  ", column " + std::to_string(node.column) + " of the template " +
                                  pattern_.name + " should lie");
    const double reach = 0.5 * (distance(node.angle, first) + distance(node.angle, second));
    if ((*exit - centre).norm() <= kBeyondLandmark * reach) return *exit;
    return skin_.nearest(centre + reach * direction);
  }

  double level(const Reference& reference, Side side) const {
    double z = in_body(measures_, name_on(reference.landmark, side)).z();
    if (!reference.towards.empty())
      z += reference.at * (in_body(measures_, name_on(reference.towards, side)).z() - z);
    return z + reference.offset;
  }

  double angle_to(const std::string& landmark) const {
    const Vector3d p = in_body(measures_, landmark) - axis_;
    return std::atan2(p.y(), p.x());
  }

  Vector3d heading(const Reference& reference, Side side) const {
    double angle = angle_to(name_on(reference.landmark, side));
    if (!reference.towards.empty()) {
      const double turn = angle_to(name_on(reference.towards, side)) - angle;
      angle += reference.at * std::remainder(turn, 360 * kDegree);  // the shorter way round
    }
    angle += (side == Side::left ? 1 : -1) * reference.offset * kDegree;
    return {std::cos(angle), std::sin(angle), 0};
  }

  /// Of the farther landmark of the two from the axis.
  double distance(const Reference& reference, Side side) const {
    const auto radius = [&](const std::string& landmark) {
      return (in_body(measures_, name_on(landmark, side)) - axis_).head<2>().norm();
    };
    return std::max(radius(reference.landmark),
                    radius(reference.towards.empty() ? reference.landmark : reference.towards));
  }

  bool known(int row, int column, Side side) const {
    return known_[node_at(pattern_, row, column, side)] != 0;
  }
  const Vector3d& at(int row, int column, Side side) const {
    return positions_[node_at(pattern_, row, column, side)];
  }
  void set(int row, int column, Side side, const Vector3d& p) {
    positions_[node_at(pattern_, row, column, side)] = p;
    known_[node_at(pattern_, row, column, side)] = 1;
  }

  std::vector<Vector3d> between(const Vector3d& a, const Vector3d& b, int count) const {
    Vector3d outward = 0.5 * (a + b) - axis_;
    outward.z() = 0;
    return skin_.between(a, b, count, outward.normalized());
  }

  void fill_row(int row, Side side) {
    for (int from = 0, to = 1; to <= pattern_.middle(); ++to) {
      if (!known(row, to, side)) continue;
      const auto points = between(at(row, from, side), at(row, to, side), to - from - 1);
      for (int i = 1; i < to - from; ++i) set(row, from + i, side, points[i - 1]);
      from = to;
    }
  }

  void fill_column(int column, Side side) {
    for (int from = 0, to = 1; to < pattern_.rows; ++to) {
      if (!known(to, column, side)) continue;
      const auto points = between(at(from, column, side), at(to, column, side), to - from - 1);
      for (int i = 1; i < to - from; ++i) set(from + i, column, side, points[i - 1]);
      from = to;
    }
  }

  const Template& pattern_;
  const geometry::BodyMeasures& measures_;
  const Skin& skin_;
  Vector3d axis_;
  std::vector<Vector3d> positions_;
  std::vector<char> known_;
};

}  // namespace

Vector3d trunk_axis(const Template& pattern, const geometry::BodyMeasures& measures) {
  Vector3d mean = Vector3d::Zero();
  for (const std::string& landmark : pattern.axis) mean += in_body(measures, landmark);
  mean /= static_cast<double>(pattern.axis.size());
  return {mean.x(), mean.y(), 0};
}

std::vector<Vector3d> place_nodes(const Template& pattern, const geometry::BodyMeasures& measures,
                                  const Skin& skin) {
  return Placer(pattern, measures, skin).place();
}

}  // namespace tensegric_fit::control_mesh
