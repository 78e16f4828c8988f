#include "virtual_body/model_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "body_model/registered_body.hpp"
#include "geometry/points.hpp"
#include "geometry/status.hpp"
#include "virtual_body/model_body.hpp"
#include "virtual_body/skin_measures.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using body_model::Model;
using Eigen::Vector3d;
using geometry::SectionLoop;

constexpr double kSeat = 0.020, kBelowNavel = 0.040;  // m: buttocks from below the crotch to below the navel
constexpr double kBelowFold = 0.020,
                 kAboveBone = 0.050;   // m: axillae from below the fold to above the acromion
constexpr double kBeside = 0.080;      // m from the middle of the trunk's loop to an arm's
constexpr int kHalvings = 12;          // of the search for the highest plane: some 0.1 mm
constexpr double kFromMiddle = 0.050;  // m: the trunk's loop comes so near to the body's middle

[[noreturn]] void refuse(const std::string& what) {
  throw geometry::Refusal(geometry::refusal::kBadOption, "with these body parameters " + what);
}

/// The middle of the gap between arm and trunk at a level; nothing where they are one.
std::optional<Vector3d> gap(const Skin& skin, Side side, double height) {
  std::vector<SectionLoop> loops = skin.cut({0, 0, height}, Vector3d::UnitZ(), Part::whole);
  const SectionLoop *trunk = nullptr, *arm = nullptr;
  double widest = 0;
  for (const SectionLoop& loop : loops) {
    const auto box = geometry::bounding_box(loop.points);
    if (box[0].y() > kFromMiddle || box[1].y() < -kFromMiddle || box[1].y() - box[0].y() <= widest) continue;
    widest = box[1].y() - box[0].y();
    trunk = &loop;
  }
  if (trunk == nullptr) return std::nullopt;
  const double middle = geometry::mean_of(trunk->points).y();
  for (const SectionLoop& loop : loops)
    if (&loop != trunk && kSign[side] * (geometry::mean_of(loop.points).y() - middle) > kBeside &&
        (arm == nullptr || loop.points.size() > arm->points.size()))
      arm = &loop;
  if (arm == nullptr) return std::nullopt;
  Vector3d between = Vector3d::Zero();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& a : arm->points)
    for (const Vector3d& b : trunk->points) {
      if ((a - b).squaredNorm() >= nearest) continue;
      nearest = (a - b).squaredNorm();
      between = (a + b) / 2;
    }
  return between;
}

std::optional<Vector3d> axilla(const Skin& skin, Side side, double low, double high) {
  std::optional<Vector3d> found = gap(skin, side, low);
  if (!found) return found;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    const auto here = gap(skin, side, middle);
    (here ? low : high) = middle;
    if (here) found = here;
  }
  return found;
}

class ModelTruth {
 public:
  ModelTruth(const Model& model, const body_model::Parameters& parameters, const Skin& skin,
             VirtualBody& body)
      : model_(model), posed_(model, parameters), skin_(skin), body_(body) {}

  void find_landmarks() {
    for (const char* name :
         {"bust_point_L", "bust_point_R", "neck_side_L", "neck_side_R", "neck_front", "neck_back", "navel"})
      add(name, skin_point(name));
    for (const Side side : kSides) {
      const auto fold = find_fold(skin_, skin_point(std::string("bust_point") + kSuffix[side]), side);
      if (!fold) refuse("there is no fold under a breast");
      add(std::string("underbust") + kSuffix[side], fold->place);
      add(std::string("fold_lowest") + kSuffix[side], fold->lowest);
      const Vector3d acromion = bone_point(std::string("acromion") + kSuffix[side]);
      add(std::string("shoulder") + kSuffix[side], skin_.above(acromion).value_or(acromion));
      const auto armpit = axilla(skin_, side, fold->lowest.z() - kBelowFold, acromion.z() + kAboveBone);
      if (!armpit) refuse("an arm lies on the trunk; raise 'arm_angle'");
      add(std::string("axilla") + kSuffix[side], *armpit);
    }
    const Vector3d crotch = find_crotch(skin_, skin_point("crotch")).lowest;
    add("crotch", crotch);
    for (const Side side : kSides) {
      const auto seat =
          rearmost_vertex(skin_, side, crotch.y(), crotch.z() - kSeat, skin_point("navel").z() - kBelowNavel);
      if (!seat) refuse("there is no buttock");
      add(std::string("buttock") + kSuffix[side], *seat);
    }
  }

  BodyAxes axes() const {
    const Vector3d front = skin_point("neck_ring_front"), back = skin_point("neck_ring_back"),
                   left = skin_point("neck_ring_L"), right = skin_point("neck_ring_R");
    BodyAxes axes;
    axes.neck = {(front + back + left + right) / 4, (front - back).cross(left - right).normalized()};
    for (const Side side : kSides) {
      const std::string suffix = std::string(".") + (side == kLeft ? "L" : "R");
      const Vector3d shoulder = joint("upperarm01" + suffix), hip = joint("upperleg01" + suffix);
      axes.upper_arms[side] = {shoulder, (joint("lowerarm01" + suffix) - shoulder).normalized()};
      axes.thighs[side] = {hip, (hip - joint("lowerleg01" + suffix)).normalized()};
    }
    axes.scale = posed_.bone(0).linear().col(0).norm() * model_.stature / 1.70;
    return axes;
  }

 private:
  void add(const std::string& name, const Vector3d& p) {
    body_.truth.landmarks.push_back({name, p, 1.0, ""});
  }

  Vector3d skin_point(const std::string& name) const {
    return body_model::skin_point(model_, skin_.mesh().vertices, name);
  }
  Vector3d bone_point(const std::string& name) const {
    for (std::size_t i = 0; i < model_.bone_points.size(); ++i)
      if (model_.bone_points[i].name == name) return posed_.bone_point(static_cast<int>(i));
    throw std::out_of_range("the body model has no bone point " + name);
  }
  Vector3d joint(const std::string& name) const { return posed_.joint(bone_named(model_, name)); }

  const Model& model_;
  body_model::PosedModel posed_;
  const Skin& skin_;
  VirtualBody& body_;
};

}  // namespace

void measure_model_body(const Model& model, const body_model::Parameters& parameters, const Skin& skin,
                        VirtualBody& body) {
  ModelTruth truth(model, parameters, skin, body);
  truth.find_landmarks();
  measure_skin(skin, truth.axes(), body);
  body.doubts.vague.push_back("point neck_back");  // the model's lies on skin without a mark
}

}  // namespace tensegric_fit::virtual_body
