#include "control_mesh/placing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
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
constexpr double kHole = 0.06;        // m; half the thickness of an arm
constexpr double kLevelStep = 0.002;  // m
constexpr double kOverhang = 0.01;    // m in a step: no underside that shows from the front slopes so
constexpr double kHangSearch = 0.15;  // m; no breast hangs lower under a level that its fold has
constexpr double kModelReach = 0.02;  // m; the model's skin lies nearer to the surface where there is one
constexpr double kFoldSearch = 0.03;  // m; a fold rises or falls no more from its landmark to a node

Vector3d in_body(const geometry::BodyMeasures& measures, const std::string& landmark) {
  const Vector3d p = measures.body_from_scan * measures.landmark(landmark);
  if (!p.allFinite())
    throw geometry::Refusal(geometry::refusal::kNonFinite, "the landmark " + landmark + " is not finite");
  return p;
}

Vector3d vertical_through(const geometry::BodyMeasures& measures, const std::vector<std::string>& landmarks,
                          Side side) {
  Vector3d mean = Vector3d::Zero();
  for (const std::string& landmark : landmarks) mean += in_body(measures, name_on(landmark, side));
  mean /= static_cast<double>(landmarks.size());
  return {mean.x(), mean.y(), 0};
}

/// The trunk's axis at any height: under the template's axis landmarks, over its foot where that is known.
class LeaningAxis {
 public:
  LeaningAxis(const Template& pattern, const geometry::BodyMeasures& measures)
      : top_(trunk_axis(pattern, measures)) {
    for (const std::string& landmark : pattern.axis)
      top_.z() += in_body(measures, landmark).z() / static_cast<double>(pattern.axis.size());
    if (pattern.axis_foot.empty() || !measures.find_landmark(pattern.axis_foot)) return;
    const Vector3d up = top_ - in_body(measures, pattern.axis_foot);
    constexpr double kLeast = 0.1;  // m; a foot that is hardly lower shows no lean
    if (up.z() > kLeast) lean_ = {up.x() / up.z(), up.y() / up.z(), 1};
  }

  Vector3d at(double height) const { return top_ + (height - top_.z()) * lean_; }

 private:
  Vector3d top_, lean_ = Vector3d::UnitZ();
};

class Placer {
 public:
  Placer(const Template& pattern, const geometry::BodyMeasures& measures, const Skin& skin, Layout layout,
         const ModelSurface* model)
      : pattern_(pattern),
        measures_(measures),
        skin_(skin),
        model_(model),
        layout_(layout),
        axis_(pattern, measures) {
    positions_.resize(grid_of(pattern).outer.size(), Vector3d::Zero());
    known_.resize(positions_.size(), 0);
  }

  std::vector<Vector3d> place() {
    for (const Side side : {Side::left, Side::right})
      for (const TemplateNode& node : pattern_.nodes)
        if (node.placing != TemplateNode::Placing::between_others || lies_elsewhere(node))
          set(node_at(pattern_, node.row, node.column, side), position(node, side));
    // Both sides' rows before any column: the columns fill the middle one, which belongs to both.
    for (const Side side : {Side::left, Side::right})
      for (int row = 0; row < pattern_.rows; ++row) fill_row(row, side);
    for (const Side side : {Side::left, Side::right})
      for (int column = 0; column <= pattern_.middle(); ++column) fill_column(column, side);
    return positions_;
  }

 private:
  bool lies_elsewhere(const TemplateNode& node) const {
    if (layout_ != Layout::on_model || node.or_on_model.empty()) return false;
    return node.placing != TemplateNode::Placing::at_landmark || !measures_.find_landmark(node.landmark) ||
           !measures_.find_landmark(name_on(node.landmark, Side::right));
  }

  /// On the middle column both sides' landmarks count alike.
  Vector3d position(const TemplateNode& node, Side side) const {
    const bool on_middle = node.column == pattern_.middle();
    const Side first = on_middle ? Side::left : side, second = on_middle ? Side::right : side;
    if (lies_elsewhere(node)) return on_model(node, node.or_on_model, first, second);
    if (node.placing == TemplateNode::Placing::at_landmark)
      return skin_.nearest(0.5 * (in_body(measures_, name_on(node.landmark, first)) +
                                  in_body(measures_, name_on(node.landmark, second))));
    if (node.placing == TemplateNode::Placing::on_model) return on_model(node, node.on_model, first, second);
    const auto axis = [&](double z) -> Vector3d {
      return node.axis.empty() ? axis_.at(z) : vertical_through(measures_, node.axis, side);
    };
    const Vector3d direction =
        (heading(node.angle, axis, first) + heading(node.angle, axis, second)).normalized();
    double height = 0.5 * (level(node.level, first) + level(node.level, second));
    if (layout_ == Layout::over_folds && model_ && !node.level.below.empty())
      height -= hang(axis, height - node.level.offset, direction);
    const Vector3d centre(axis(height).x(), axis(height).y(), height);
    const auto exit = on_its_side_of_fold(node.level, axis, height, direction);
    const double reach = 0.5 * (distance(node.angle, axis, first) + distance(node.angle, axis, second));
    const Vector3d beside = skin_.nearest(centre + reach * direction);
    // Where an arm was the skin has a hole.
    if (!exit && (beside - centre - reach * direction).norm() > kHole)
      throw geometry::Refusal(geometry::refusal::kNotABody,
                              "there is no skin round the trunk where row " + std::to_string(node.row) +
                                  ", column " + std::to_string(node.column) + " of the template " +
                                  pattern_.name + " should lie");
    return exit && (*exit - centre).norm() <= kBeyondLandmark * reach ? *exit : beside;
  }

  /// On the skin over or under the model's: along the model's normal, so that a fold's other side stays out.
  Vector3d on_model(const TemplateNode& node, const std::vector<ModelPoint>& points, Side first,
                    Side second) const {
    const std::string where = where_of(pattern_, node);
    const ModelSurface::Place a = model_->place(points, first, where),
                              b = model_->place(points, second, where);
    const Vector3d middle = 0.5 * (a.point + b.point);
    const auto along = skin_.nearest_along(middle, (a.normal + b.normal).normalized(), kModelReach);
    return along ? *along : skin_.nearest(middle);
  }

  /// Where the ray at `height` leaves the body. A level below a landmark means the chest under what hangs
  /// there, a landmark's own level the skin that it lies on; rays that a fold which is not level leaves on
  /// its other side step over it.
  template <typename Axis>
  std::optional<Vector3d> on_its_side_of_fold(const Reference& level, const Axis& axis, double height,
                                              const Vector3d& direction) const {
    const auto exit_at = [&](double z) {
      return skin_.first_exit({axis(z).x(), axis(z).y(), z}, direction, kTrunkReach);
    };
    const auto exit = exit_at(height);
    const bool landmarks_own = level.towards.empty() && level.offset == 0;
    const double up = !level.below.empty() ? -1 : layout_ == Layout::over_folds && landmarks_own ? 1 : 0;
    auto before = exit;
    for (double step = kLevelStep; up != 0 && before && step <= kFoldSearch; step += kLevelStep) {
      const auto after = exit_at(height + up * step);
      if (after && up * (*after - *before).dot(direction) > kOverhang) return after;
      before = after;
    }
    return exit;
  }

  /// How far below that height the breasts end that hang there.
  template <typename Axis>
  double hang(const Axis& axis, double height, const Vector3d& direction) const {
    for (double down = 0; down <= kHangSearch; down += kLevelStep) {
      const double z = height - down;
      const auto exit = skin_.first_exit({axis(z).x(), axis(z).y(), z}, direction, kTrunkReach);
      if (!exit || !model_->on_breast(*exit, skin_.normal_near(*exit))) return down;
    }
    return 0;
  }

  double level(const Reference& reference, Side side) const {
    double z = in_body(measures_, name_on(reference.landmark, side)).z();
    if (!reference.towards.empty())
      z += reference.at * (in_body(measures_, name_on(reference.towards, side)).z() - z);
    if (!reference.below.empty())
      z = std::min(z, in_body(measures_, name_on(reference.below, side)).z() - reference.by);
    return z + reference.offset;
  }

  /// `axis` gives its own place at any height: a landmark is seen from its own height.
  template <typename Axis>
  Vector3d heading(const Reference& reference, const Axis& axis, Side side) const {
    const auto angle_to = [&](const std::string& landmark) {
      const Vector3d p = in_body(measures_, name_on(landmark, side)), from = p - axis(p.z());
      return std::atan2(from.y(), from.x());
    };
    double angle = angle_to(reference.landmark);
    if (!reference.towards.empty()) {
      const double turn = angle_to(reference.towards) - angle;
      angle += reference.at * std::remainder(turn, 360 * kDegree);  // the shorter way round
    }
    angle += (side == Side::left ? 1 : -1) * reference.offset * kDegree;
    return {std::cos(angle), std::sin(angle), 0};
  }

  /// Of the farther landmark of the two from the axis.
  template <typename Axis>
  double distance(const Reference& reference, const Axis& axis, Side side) const {
    const auto radius = [&](const std::string& landmark) {
      const Vector3d p = in_body(measures_, name_on(landmark, side));
      return (p - axis(p.z())).template head<2>().norm();
    };
    return std::max(radius(reference.landmark),
                    radius(reference.towards.empty() ? reference.landmark : reference.towards));
  }

  void set(int node, const Vector3d& p) {
    positions_[node] = p;
    known_[node] = 1;
  }

  void fill_row(int row, Side side) {
    std::vector<int> nodes;
    for (int column = 0; column <= pattern_.middle(); ++column)
      if (const int node = node_at(pattern_, row, column, side); node >= 0) nodes.push_back(node);
    if (known_[nodes.front()] && known_[nodes.back()])
      fill(nodes, [](const Vector3d&) -> Vector3d { return Vector3d::UnitZ(); });
  }

  void fill_column(int column, Side side) {
    std::vector<int> nodes;
    for (int row = 0; row < pattern_.rows; ++row)
      if (const int node = node_at(pattern_, row, column, side); node >= 0) nodes.push_back(node);
    // Round the trunk, so that columns run down in upright planes
    fill(nodes, [this](const Vector3d& p) -> Vector3d {
      const Vector3d outward = p - axis_.at(p.z());
      return {-outward.y(), outward.x(), 0};
    });
  }

  /// Lays what is not known evenly between the known, square to `across`. \pre the first and the last one are
  /// known
  template <typename Direction>
  void fill(const std::vector<int>& nodes, const Direction& across) {
    for (std::size_t from = 0, to = 1; to < nodes.size(); ++to) {
      if (!known_[nodes[to]]) continue;
      const Vector3d &a = positions_[nodes[from]], &b = positions_[nodes[to]];
      const auto points = skin_.between(a, b, static_cast<int>(to - from) - 1, across(0.5 * (a + b)));
      for (std::size_t i = 1; i < to - from; ++i) set(nodes[from + i], points[i - 1]);
      from = to;
    }
  }

  const Template& pattern_;
  const geometry::BodyMeasures& measures_;
  const Skin& skin_;
  const ModelSurface* model_;
  const Layout layout_;
  LeaningAxis axis_;
  std::vector<Vector3d> positions_;
  std::vector<char> known_;
};

}  // namespace

Vector3d trunk_axis(const Template& pattern, const geometry::BodyMeasures& measures) {
  return vertical_through(measures, pattern.axis, Side::left);
}

std::vector<Vector3d> place_nodes(const Template& pattern, const geometry::BodyMeasures& measures,
                                  const Skin& skin, Layout layout, const ModelSurface* model) {
  return Placer(pattern, measures, skin, layout, model).place();
}

}  // namespace tensegric_fit::control_mesh
