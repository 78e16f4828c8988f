#include "landmarks/find_landmarks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "body_model/missing_parts.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "landmarks/body_surface.hpp"
#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

using body_model::RegisteredBody;
using Eigen::Vector3d;
using Tape = std::vector<Vector3d>;

constexpr double kUnderbustBelowFold = 0.003;  // m: the tape lies just under the fold (definition)
constexpr double kWaistAboveHip = 0.10, kWaistBelowUnderbust = 0.005;  // m: the least girth is in between
constexpr double kBreast = 0.045;  // m round the bust point: skin that says where the breast points
// In spreads of the model. Nipples are looked for within 2.5 deviations of so many: all of 298 training
// nipples are there. Folds within so many, or kFoldOfMesh: 96 % of 298 training folds are there.
constexpr double kNippleSpreads = 2, kFoldSpreads = 4;
constexpr double kFoldOfModel = 0.040,
                 kFoldOfMesh = 0.025;  // m from where folds usually are on the model, and from where hers is
constexpr double kSeat = 0.02, kBelowWaist = 0.04;  // m: buttocks from below the crotch to below the navel
constexpr double kAboveShoulder = 0.05, kBelowFold = 0.02;  // m: the axilla is in between (definition)
constexpr double kArmBelowAxilla = 0.051, kThighBelowCrotch = 0.039;  // statures along the limb (definition)
constexpr double kArmReach = 0.055,
                 kThighReach = 0.12;  // statures: half of the thickest limb's breadth, and room
constexpr double kGuessedArm =
    0.05;  // statures, a third of a girth: what an arm may be off by that is not there (definition)
constexpr double kUnderButtock = 0.13,
                 kFoldUnderButtock =
                     0.065;      // statures (definition): back of the thigh, and a fold that does not show
constexpr double kSeen = 0.015;  // m round a place: skin that was seen there, or not
constexpr double kPerineum = 0.015;      // m round the crotch
constexpr double kFoldDepth = 0.003;     // m under the straight edge; less is noise
constexpr double kBentThigh = M_PI / 4;  // rad from the vertical; who stands has none such (definition)
constexpr double kThigh = 0.25;          // statures, a thigh's length: so much lower is who sits (definition)
constexpr double kLevelArm =
    M_PI / 3;  // rad; an arm held out more has its axilla on a plane that rises with it (definition)

std::string sided(const std::string& name, Side side) {
  return name + kSuffix[side];
}

template <typename T>
std::optional<Vector3d> as_figure(const std::optional<T>& value) {
  if (!value) return std::nullopt;
  return Vector3d(*value, 0, 0);
}

/// Whether an edge of the vertex has a single triangle.
bool is_on_rim(const geometry::TriangleMesh& mesh, int vertex) {
  std::map<int, int> triangles_at;  // by neighbour
  for (const Eigen::Vector3i& t : mesh.triangles)
    if ((t.array() == vertex).any())
      for (int k = 0; k < 3; ++k)
        if (t[k] != vertex) ++triangles_at[t[k]];
  return std::any_of(triangles_at.begin(), triangles_at.end(),
                     [](const auto& neighbour) { return neighbour.second == 1; });
}

class Reader {
 public:
  Reader(const geometry::TriangleMesh& mesh, const std::vector<char>& filled, const RegisteredBody& model,
         const Precision& precision)
      : body_(model),
        precision_(precision),
        frame_(body_frame(model)),
        mesh_(labelled(mesh, filled, model, frame_)),
        skin_(skin_of(model, model.skin, frame_)),
        shape_(skin_of(model, model.posed, frame_)),
        normals_(geometry::vertex_normals(skin_.surface().mesh.vertices, skin_.surface().mesh.triangles)),
        tree_(skin_.surface().mesh.vertices) {}

  Reading read() {
    for (const Side side : kSides) bust_point(side);
    for (const Side side : kSides) fold(side);
    level("bust", {"bust_point_L", "bust_point_R"});
    level_of_folds();
    crotch();
    for (const Side side : kSides) buttock(side);
    level("hip", {"buttock_L", "buttock_R"});
    waist();
    girth("bust", [&](const Trunk& t) { return t.tape(height("bust")); });
    girth_under_breasts();
    girth("waist", [&](const Trunk& t) { return t.tape_of_torso(height("waist")); });
    girth("hip", [&](const Trunk& t) { return t.tape(height("hip")); });
    for (const Side side : kSides) {
      shoulder(side);
      axilla(side);
      upper_arm(side);
      thigh(side);
      gluteal_fold(side);
      farthest("hip", side);
      farthest("waist", side);
    }
    neck();
    stature();
    if (!stands()) doubt_standing();
    return {frame_, std::move(figures_), std::move(missing_)};
  }

 private:
  Vector3d expected(const std::string& name) const { return frame_ * body_.skin_point(name); }

  Vector3d shaped(const std::string& name) const { return frame_ * body_.posed_point(name); }

  /// RegisteredBody::support round a point.
  double support_at(const Vector3d& point) const {
    return std::min(body_.support[tree_.nearest(point)], kWorst);
  }
  double support_along(const Tape& tape) const {
    double sum = 0;
    for (const Vector3d& p : tape) sum += support_at(p);
    return tape.empty() ? kWorst : sum / static_cast<double>(tape.size());
  }

  /// `what`: what the figure is of, in words, where neither surface may have it.
  void add(Kind kind, const std::string& name, std::optional<Vector3d> on_mesh,
           std::optional<Vector3d> on_model, double support, bool seen, double shift = 0,
           const std::string& what = "place of it") {
    if (!on_mesh && !on_model) return lacks(name, "no " + what + " was found");
    figures_.push_back({kind, name, std::move(on_mesh), std::move(on_model), support, body_.residual, Tape(),
                        seen, kind == Kind::height ? body_.ground_deviation : 0, shift});
  }
  void add_point(const std::string& name, const std::optional<Vector3d>& on_mesh,
                 const std::optional<Vector3d>& on_model, double support,
                 const std::string& what = "place of it") {
    add(Kind::point, name, on_mesh, on_model, support, is_seen(on_mesh), 0, what);
  }
  /// A deviation that both readings have in common; the largest counts.
  static void doubt(Figure& figure, double deviation, const std::string& reason) {
    if (deviation <= figure.shared) return;
    figure.shared = deviation;
    figure.shared_reason = reason;
  }
  void doubt(Kind kind, const std::string& name, double deviation, const std::string& reason) {
    for (Figure& figure : figures_)
      if (figure.kind == kind && figure.name == name) doubt(figure, deviation, reason);
  }
  void lacks(const std::string& name, const std::string& reason) { missing_.push_back({name, reason}); }
  bool is_seen(const std::optional<Vector3d>& on_mesh) const {
    return on_mesh && unseen_share(mesh_.surface(), *on_mesh, kSeen) < 0.5;
  }
  const Figure* find(Kind kind, const std::string& name) const {
    const auto found = std::find_if(figures_.begin(), figures_.end(),
                                    [&](const Figure& f) { return f.kind == kind && f.name == name; });
    return found == figures_.end() ? nullptr : &*found;
  }
  /// The figure that `name` is measured from. Null: there is none, and so `name` is missing, too.
  const Figure* base_of(const std::string& name, Kind kind, const std::string& base,
                        const std::string& what = "it") {
    const Figure* figure = find(kind, base);
    if (figure == nullptr) lacks(name, what + " is measured from " + base + ", which was not found");
    return figure;
  }
  Vector3d point(const std::string& name) const {
    return settle(*find(Kind::point, name), precision_, body_.scanned).value;
  }
  double height(const std::string& name) const {
    return settle(*find(Kind::height, name), precision_, body_.scanned).value.x();
  }

  double spread_of_model(const std::string& point, double support) const {
    return landmarks::spread_of_model({Kind::point, point, {}, {}, support, body_.residual, {}, false},
                                      precision_, body_.scanned);
  }

  void bust_point(Side side) {
    const std::string name = sided("bust_point", side);
    const Vector3d there = expected(name);
    Vector3d outward = Vector3d::Zero();
    for (std::size_t v = 0; v < normals_.size(); ++v)
      if ((skin_.surface().mesh.vertices[v] - there).norm() < kBreast && skin_.surface().arm[v] < 0.5)
        outward += normals_[v];
    const double deviation = kNippleSpreads * spread_of_model(name, support_at(there));
    const auto nipple = find_nipple(mesh_.surface(), there, deviation, outward.normalized());
    const auto on_mesh = nipple ? std::optional<Vector3d>(nipple->place) : std::nullopt;
    add(Kind::point, name, on_mesh, there, support_at(there), is_seen(on_mesh), nipple ? nipple->shift : 0);
  }

  void fold(Side side) {
    const std::string name = sided("underbust", side);
    const Vector3d tip = point(sided("bust_point", side));
    Fold on_model = find_fold(shape_, tip, side, {shaped(name)}, kFoldOfModel);
    has_fold_[side] = !on_model.places.empty();
    if (!has_fold_[side]) on_model = {{shaped(name)}, shaped(name)};  // where the model's is, and as unsure
    const double reach = std::max(kFoldOfMesh, kFoldSpreads * spread_of_model(name, 0));
    const Fold on_mesh = find_fold(mesh_, tip, side, on_model.places, reach);
    lowest_[0][side] = on_mesh.places.empty() ? std::nullopt : std::optional<Vector3d>(on_mesh.lowest);
    lowest_[1][side] = on_model.lowest;
    const Vector3d first = on_model.places.front();
    add_point(name, on_mesh.places.empty() ? std::nullopt : std::optional<Vector3d>(on_mesh.places.front()),
              first, has_fold_[side] ? support_at(first) : kWorst);
  }

  /// The mean height of points.
  void level(const std::string& name, const std::vector<std::string>& points) {
    std::optional<double> on_mesh = 0.0, on_model = 0.0;
    double support = 0, shift = 0;
    bool seen = true;
    for (const std::string& p : points) {
      const Figure* figure = base_of(name, Kind::point, p);
      if (figure == nullptr) return;
      const auto take = [&](std::optional<double>& sum, const std::optional<Vector3d>& value) {
        if (sum && value)
          *sum += value->z() / static_cast<double>(points.size());
        else
          sum.reset();
      };
      take(on_mesh, figure->on_mesh);
      take(on_model, figure->on_model);
      support = std::max(support, figure->support);
      shift += figure->shift / static_cast<double>(points.size());
      seen = seen && figure->seen;
    }
    add(Kind::height, name, as_figure(on_mesh), as_figure(on_model), support, seen, shift,
        "surface that has both sides of it");
  }

  void level_of_folds() {
    std::optional<double> lowest[2];
    double support = 0;
    for (int s = 0; s < 2; ++s)
      if (lowest_[s][0] && lowest_[s][1]) lowest[s] = std::min(lowest_[s][0]->z(), lowest_[s][1]->z());
    for (const Side side : kSides) {
      support = std::max(support, has_fold_[side] ? support_at(*lowest_[1][side]) : kWorst);
    }
    add(Kind::height, "underbust", as_figure(lowest[0]), as_figure(lowest[1]), support,
        is_seen(lowest_[0][kLeft]) && is_seen(lowest_[0][kRight]));
  }

  void crotch() {
    const Vector3d there = shaped("crotch");
    auto on_mesh = find_crotch(mesh_.surface(), there);
    if (on_mesh && unseen_share(mesh_.surface(), *on_mesh, kPerineum) > 0.5)
      on_mesh.reset();  // a filled gap has its own lowest place
    add_point("crotch", on_mesh, there, support_at(there));
    level("crotch", {"crotch"});
  }

  void buttock(Side side) {
    const std::string name = sided("buttock", side);
    const Vector3d crotch = expected("crotch");
    const double lowest = crotch.z() - kSeat, highest = expected("navel").z() - kBelowWaist;
    const Vector3d* rearmost = nullptr;
    for (std::size_t v = 0; v < normals_.size(); ++v) {
      const Vector3d& p = skin_.surface().mesh.vertices[v];
      if (skin_.surface().arm[v] > 0.5 || kSign[side] * (p.y() - crotch.y()) < kSeat || p.z() < lowest ||
          p.z() > highest)
        continue;
      if (rearmost == nullptr || p.x() < rearmost->x()) rearmost = &p;
    }
    if (rearmost == nullptr) return lacks(name, "no skin between crotch and navel was found");
    add_point(name, find_buttock(mesh_, *rearmost), find_buttock(skin_, *rearmost), support_at(*rearmost),
              "apex of the buttock");
  }

  void waist() {
    if (base_of("waist", Kind::height, "hip") == nullptr) return;
    const double low = height("hip") + kWaistAboveHip, high = height("underbust") - kWaistBelowUnderbust;
    const auto on_mesh = find_waist(mesh_, low, high), on_model = find_waist(skin_, low, high);
    if (on_mesh && on_model) {
      add(Kind::height, "waist", as_figure(on_mesh), as_figure(on_model),
          support_along(skin_.tape_of_torso(*on_model)), false);
    } else {
      add(Kind::height, "waist", std::nullopt, Vector3d(expected("navel").z(), 0, 0), kWorst, false);
    }
  }

  /// Under each surface's own fold, where that is lower: a breast that joins the trunk below the level is
  /// none of the tape.
  void girth_under_breasts() {
    Tape tapes[2];
    for (int s = 0; s < 2; ++s) {
      double level = height("underbust");
      for (const Side side : kSides)
        if (lowest_[s][side]) level = std::min(level, lowest_[s][side]->z());
      tapes[s] = (s == 0 ? mesh_ : shape_).tape_of_torso(level - kUnderbustBelowFold);
    }
    girth_of("underbust", tapes[0], tapes[1]);
    if (!has_fold_[kLeft] || !has_fold_[kRight])
      doubt(Kind::girth, "underbust", kWorst, "no fold under the breast was found");
  }

  template <typename TapeOf>
  void girth(const std::string& name, const TapeOf& tape_of) {
    if (find(Kind::height, name) == nullptr) return;  // missing by that name
    girth_of(name, tape_of(mesh_), tape_of(skin_));
    doubt(Kind::girth, name, doubt_of_level(name), "the level that it is measured on is uncertain");
  }
  /// What is read on a level that nobody knows is as unsure as that, however well both surfaces show it.
  double doubt_of_level(const std::string& name) const {
    return find(Kind::height, name)->support < kWorst ? 0 : kWorst;
  }
  /// Never taken for seen: what is taken for arms may be missing from a tape.
  void girth_of(const std::string& name, const Tape& on_mesh, const Tape& on_model) {
    if (on_mesh.size() < 3 && on_model.size() < 3)
      return lacks(name, "no skin to lay the tape of its girth round was found");
    const auto value = [](const Tape& t) {
      return t.size() < 3 ? std::nullopt : std::optional<double>(geometry::length_of(t, true));
    };
    add(Kind::girth, name, as_figure(value(on_mesh)), as_figure(value(on_model)),
        support_along(on_model.size() < 3 ? on_mesh : on_model), false);
    figures_.back().loop = on_mesh;
    figures_.back().loop_on_model = on_model;
  }

  void shoulder(Side side) {
    const Vector3d bone = frame_ * body_.bone_point(sided("acromion", side));
    add_point(sided("shoulder", side), skin_above(mesh_.surface(), bone), skin_above(skin_.surface(), bone),
              support_at(bone), "skin above the acromion");
  }

  void axilla(Side side) {
    const std::string arm = kSuffix[side] + 1;
    const Vector3d way =
        frame_.linear() * (body_.joint("lowerarm01." + arm) - body_.joint("upperarm01." + arm));
    const double raised = std::atan2(kSign[side] * way.y(), -way.z()),
                 rise = raised >= kLevelArm ? raised / 2 : 0;
    const Vector3d bone = frame_ * body_.bone_point(sided("acromion", side));
    const auto lowest = lowest_[1][side] ? lowest_[1][side]->z() : expected(sided("bust_point", side)).z();
    const auto on_mesh =
        find_axilla(mesh_.surface(), side, lowest - kBelowFold, bone.z() + kAboveShoulder, rise);
    const auto on_model =
        find_axilla(skin_.surface(), side, lowest - kBelowFold, bone.z() + kAboveShoulder, rise);
    add_point(sided("axilla", side), on_mesh, on_model, support_at(on_model ? *on_model : bone),
              "gap between arm and trunk");
  }

  void upper_arm(Side side) {
    const std::string arm = kSuffix[side] + 1, from = sided("axilla", side);
    if (base_of(sided("upper_arm", side), Kind::point, from, "its girth") == nullptr) return;
    const Vector3d shoulder = frame_ * body_.joint("upperarm01." + arm);
    const Vector3d along = (frame_ * body_.joint("lowerarm01." + arm) - shoulder).normalized();
    const double down = along.dot(point(from) - shoulder) + kArmBelowAxilla * body_.stature();
    limb("upper_arm", side, shoulder + down * along, along, kArmReach,
         [](const Surface& s, const Eigen::Vector3i& t) { return s.is_arm(t); });
    if (!arms_there_[side])
      doubt(Kind::girth, sided("upper_arm", side), kGuessedArm * body_.stature(), "that arm is not there");
  }

  /// Of thighs that touch, what lies on this side of the plane between the hip joints.
  void thigh(Side side) {
    const std::string leg = kSuffix[side] + 1;
    const Vector3d hip = frame_ * body_.joint("upperleg01." + leg),
                   knee = frame_ * body_.joint("lowerleg01." + leg);
    const Vector3d along = (knee - hip).normalized(),
                   outwards = (hip - frame_ * body_.joint(side == kLeft ? "upperleg01.R" : "upperleg01.L"))
                                  .normalized();
    const double level = height("crotch") - kThighBelowCrotch * body_.stature(),
                 between = outwards.dot(point("crotch"));
    limb("thigh", side, hip + (level - hip.z()) / along.z() * along, along, kThighReach,
         [&](const Surface& s, const Eigen::Vector3i& t) {
           const Vector3d middle =
               (s.mesh.vertices[t[0]] + s.mesh.vertices[t[1]] + s.mesh.vertices[t[2]]) / 3;
           return outwards.dot(middle) > between && !s.is_arm(t);
         });
  }

  template <typename Belongs>
  void limb(const std::string& name, Side side, const Vector3d& place, const Vector3d& along, double reach,
            const Belongs& belongs) {
    const auto round = [&](const Surface& s) {
      return round_limb(s, place, along, reach * body_.stature(),
                        [&](const Eigen::Vector3i& t) { return belongs(s, t); });
    };
    girth_of(sided(name, side), round(mesh_.surface()), round(skin_.surface()));
  }

  void gluteal_fold(Side side) {
    const std::string name = sided("gluteal_fold", side), buttock = sided("buttock", side);
    if (base_of(name, Kind::point, buttock) == nullptr) return;
    const Vector3d seat = point(buttock);
    const double far = kUnderButtock * body_.stature();
    std::optional<Vector3d> on_model = find_gluteal_fold(skin_, seat, far, 0);
    if (!on_model) on_model = skin_under(skin_, seat, kFoldUnderButtock * body_.stature());
    if (!on_model) return lacks(name, "no skin of the thigh under the buttock was found");
    add_point(name, find_gluteal_fold(mesh_, seat, far, kFoldDepth), on_model, support_at(*on_model));
  }

  void farthest(const std::string& level, Side side) {
    const std::string name = sided(level + "_side", side);
    if (base_of(name, Kind::height, level) == nullptr) return;
    const auto on_model = find_side(skin_, side, height(level));
    if (!on_model) return lacks(name, "no skin on its level was found");
    add_point(name, find_side(mesh_, side, height(level)), on_model, support_at(*on_model));
    doubt(Kind::point, name, doubt_of_level(level), "the level that it lies on is uncertain");
  }

  void neck() {
    const Vector3d front = expected("neck_ring_front"), back = expected("neck_ring_back"),
                   left = expected("neck_ring_L"), right = expected("neck_ring_R");
    const Vector3d base = (front + back + left + right) / 4,
                   along = (front - back).cross(left - right).normalized();
    girth_of("neck", find_neck(mesh_.surface(), base, along), find_neck(shape_.surface(), base, along));
    add(Kind::height, "neck", std::nullopt, Vector3d(base.z(), 0, 0), support_at(front), false);
    for (const char* name : {"neck_front", "neck_back", "neck_side_L", "neck_side_R", "navel"})
      add_point(name, std::nullopt, expected(name), support_at(expected(name)));
  }

  void stature() {
    const std::optional<Vector3d> on_mesh = crown(mesh_.surface()), on_model = crown(skin_.surface());
    if (!on_model) return lacks("stature", "no skin but of arms was found");
    const auto height = [](const Vector3d& p) { return Vector3d(p.z(), 0, 0); };
    add(Kind::height, "stature", on_mesh ? std::optional<Vector3d>(height(*on_mesh)) : std::nullopt,
        height(*on_model), support_at(*on_model), false);
  }

  /// Whether no thigh that is there is bent, as of somebody who sits.
  bool stands() const {
    for (const Side side : kSides) {
      const std::string leg = kSuffix[side] + 1;
      const Vector3d thigh = body_.joint("lowerleg01." + leg) - body_.joint("upperleg01." + leg);
      if (thighs_there_[side] && -body_.vertical.dot(thigh.normalized()) < std::cos(kBentThigh)) return false;
    }
    return true;
  }
  /// Heights and what lies at the hip are of a body that stands.
  void doubt_standing() {
    for (Figure& figure : figures_)
      if (figure.kind == Kind::height || figure.name == "hip" || figure.name.rfind("hip_side", 0) == 0)
        doubt(figure, kThigh * body_.stature(), "she does not stand: a thigh is bent by 45 degrees or more");
  }

  /// The highest skin but of arms, which may be raised; nothing where that is the rim of a hole.
  static std::optional<Vector3d> crown(const Surface& surface) {
    const std::vector<Vector3d>& vertices = surface.mesh.vertices;
    int highest = -1;
    for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
      if (surface.arm[v] < 0.5 && (highest < 0 || vertices[v].z() > vertices[highest].z())) highest = v;
    if (highest < 0 || is_on_rim(surface.mesh, highest)) return std::nullopt;
    return vertices[highest];
  }

  static constexpr double kWorst = 0.1;  // m; support is no worse than that

  const RegisteredBody& body_;
  const Precision& precision_;
  Eigen::Isometry3d frame_;
  Trunk mesh_, skin_;
  Trunk shape_;  ///< for folds and the neck: what is displaced follows skin across a fold, and hair
  std::vector<Vector3d> normals_;
  geometry::PointTree tree_;
  const std::array<bool, 2> arms_there_ = body_model::sides_there(body_, "upper_arm"),
                            thighs_there_ = body_model::sides_there(body_, "thigh");
  std::vector<Figure> figures_;
  std::vector<geometry::Missing> missing_;
  std::array<std::array<std::optional<Vector3d>, 2>, 2>
      lowest_;                                ///< of the folds: on mesh and model, left and right
  std::array<bool, 2> has_fold_{true, true};  ///< on the model, left and right
};

}  // namespace

Reading read_figures(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                     const RegisteredBody& model, const Precision& precision) {
  geometry::check_mesh(mesh);
  if (mesh.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the mesh has no triangles");
  if (!filled.empty() && filled.size() != mesh.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh,
                            "one flag per vertex is needed to know filled holes");
  return Reader(mesh, filled, model, precision).read();
}

geometry::BodyMeasures find_landmarks(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                                      const RegisteredBody& model, const Precision& precision) {
  const Reading reading = read_figures(mesh, filled, model, precision);
  geometry::BodyMeasures measures;
  measures.body_from_scan = reading.body_from_scan;
  measures.missing = reading.missing;
  const Eigen::Isometry3d scan_from_body = reading.body_from_scan.inverse();
  for (const Figure& figure : reading.figures) {
    const Settled settled = settle(figure, precision, model.scanned);
    const double confidence = confidence_of(figure, settled);
    const std::string reason = confidence < 0.5 ? reason_of(figure, settled) : "";
    switch (figure.kind) {
      case Kind::point:
        measures.landmarks.push_back(
            {figure.name, scan_from_body * settled.value, confidence, reason, settled.half_width});
        break;
      case Kind::height:
        measures.heights.push_back({figure.name, settled.value.x(), confidence, reason, settled.half_width});
        break;
      case Kind::girth: {
        measures.girths.push_back({figure.name, settled.value.x(), confidence, reason, settled.half_width});
        geometry::GirthLoop loop{figure.name, {}};
        for (const Vector3d& p : tape_of(figure, settled)) loop.points.push_back(scan_from_body * p);
        measures.loops.push_back(std::move(loop));
        break;
      }
    }
  }
  return measures;
}

}  // namespace tensegric_fit::landmarks
