#include "landmarks/find_landmarks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "geometry/status.hpp"
#include "landmarks/body_frame.hpp"
#include "landmarks/bust.hpp"
#include "landmarks/girth_levels.hpp"
#include "landmarks/girth_spread.hpp"
#include "landmarks/hanging_breast.hpp"
#include "landmarks/limb_girths.hpp"
#include "landmarks/lower_trunk.hpp"
#include "landmarks/neck.hpp"
#include "landmarks/shoulders.hpp"
#include "landmarks/stoop.hpp"
#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;
using geometry::BodyMeasures;
using geometry::TriangleMesh;

constexpr double kUnderbustBelowFold = 0.003;  // the tape lies just under the fold
constexpr double kHiddenFold = 0.003;          // more than that above the fold found is uncertain
constexpr double kPocketDepth = 0.010;         // a fold in a pocket is as uncertain as that
constexpr double kWaistAboveHip = 0.10, kWaistBelowUnderbust = 0.015;

TriangleMesh in_frame(const TriangleMesh& mesh, const Eigen::Isometry3d& frame) {
  TriangleMesh result = mesh;
  for (Vector3d& v : result.vertices) v = frame * v;
  return result;
}

// Collects results in the body's frame and gives them out in the scan's.
class Record {
 public:
  Record(const BodyShape& body, const std::vector<char>& filled, const BodyFrame& frame)
      : body_(body), filled_(filled), frame_(frame), scan_from_body_(frame.body_from_scan.inverse()) {
    measures_.body_from_scan = frame.body_from_scan;
  }

  void landmark(const std::string& name, const Vector3d& point, double confidence = 0.9,
                std::string reason = "") {
    if (frame_.confidence <
        std::min(confidence, 0.5)) {  // front and back may be swapped, and so left and right
      confidence = frame_.confidence;
      reason = frame_.reason;
    }
    if (unseen(point) && confidence > 0.45) {
      confidence = 0.45;
      reason = "the scan did not see the skin there";
    }
    measures_.landmarks.push_back({name, scan_from_body_ * point, confidence, std::move(reason)});
  }

  void height(const std::string& name, double metres, double confidence = 0.9, std::string reason = "") {
    measures_.heights.push_back({name, metres, confidence, std::move(reason)});
  }

  /// `tape_at` gives the tape at an offset from its level; `doubt`, in metres, is what adds to its spread.
  void girth(const std::string& name, const std::function<Tape(double)>& tape_at, double confidence = 0.9,
             std::string reason = "", double doubt = 0) {
    const Tape tape = tape_at(0);
    if (tape.size() < 3) return;
    measures_.girths.push_back({name, geometry::length_of(tape, true), confidence, std::move(reason),
                                std::hypot(half_width_of(body_, tape_at), doubt)});
    geometry::GirthLoop loop{name, {}};
    for (const Vector3d& p : tape) loop.points.push_back(scan_from_body_ * p);
    measures_.loops.push_back(std::move(loop));
  }

  /// Of the neck or a limb.
  void girth(const std::string& name, const Tape& tape, double confidence, std::string reason) {
    if (tape.size() < 3) return;
    girth(
        name, [&](double offset) { return offset == 0 ? tape : parallel_tape(body_, tape, offset); },
        confidence, std::move(reason));
  }

  void missing(const std::string& name, const std::string& reason) {
    measures_.missing.push_back({name, reason});
  }

  BodyMeasures take() { return std::move(measures_); }

 private:
  // The nearest vertex is one of a filled hole.
  bool unseen(const Vector3d& point) const {
    if (filled_.empty()) return false;
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < filled_.size(); ++v)
      if ((body_.mesh.vertices[v] - point).squaredNorm() <
          (body_.mesh.vertices[nearest] - point).squaredNorm())
        nearest = v;
    return filled_[nearest] != 0;
  }

  const BodyShape& body_;
  const std::vector<char>& filled_;
  const BodyFrame& frame_;
  Eigen::Isometry3d scan_from_body_;
  BodyMeasures measures_;
};

void sides(const Trunk& trunk, const std::string& name, double level, double confidence, Record& record) {
  const std::vector<Outline> outline = trunk.outline_at(level);
  if (outline.empty()) return;
  for (Side side : {kLeft, kRight})
    record.landmark(name + kSuffix[side], side_of(outline.front(), side), confidence,
                    confidence < 0.5 ? "its level is by proportion" : "");
}

void limb(const std::string& name, const LimbGirth& girth, Record& record) {
  if (girth.tape.empty()) {
    record.missing(name, girth.reason);
  } else {
    record.girth(name, girth.tape, girth.confidence, girth.reason);
  }
}

double lower_trunk(const BodyShape& body, const Trunk& trunk, Record& record) {
  const double crotch = body.crotch.height;
  // Thighs that touch, or a gap that the scan did not see: 0.006 statures are 10 mm.
  const bool hidden = crotch - body.levels.legs_part > 0.006 * body.stature;
  const double certainty = hidden ? 0.45 : 0.9;
  const std::string hiding = hidden ? "hidden between the thighs" : "";
  record.landmark("crotch", find_crotch(body), certainty, hiding);
  record.height("crotch", crotch, certainty, hiding);

  double sum = 0;
  int found = 0;
  for (Side side : {kLeft, kRight}) {
    Vector3d point;
    if (!find_buttock(body, side, point)) {
      for (const char* name : {"buttock", "gluteal_fold"})
        record.missing(std::string(name) + kSuffix[side], "no buttock stands out");
      continue;
    }
    record.landmark(std::string("buttock") + kSuffix[side], point);
    const GlutealFold fold = find_gluteal_fold(body, point);
    record.landmark(std::string("gluteal_fold") + kSuffix[side], fold.point, fold.confidence, fold.reason);
    sum += point.z();
    ++found;
  }
  for (Side side : {kLeft, kRight})
    limb(std::string("thigh") + kSuffix[side], find_thigh_girth(body, side), record);
  const double hip = found > 0 ? sum / found : crotch + 0.05 * body.stature;
  record.height("hip", hip, found > 0 ? 0.9 : 0.3,
                found > 0 ? "" : "no buttock stands out; a level by proportion");
  record.girth("hip", [&](double offset) { return tape_loop(trunk.outline_at(hip + offset)); });
  sides(trunk, "hip_side", hip, found > 0 ? 0.9 : 0.3, record);
  return hip;
}

double underbust(const BodyShape& body, const Trunk& trunk, const std::array<Vector3d, 2>& tips,
                 Record& record) {
  double height = 1e9, seen = 1e9, confidence = 1;
  bool in_pocket = false, inferred = false;
  std::string reason;
  for (Side side : {kLeft, kRight}) {
    Fold fold = find_fold(body, tips[side], side);
    const double above_web = fold_above_web(body, trunk, fold.lowest, tips[side], side);
    if (above_web > kHiddenFold && !fold.in_pocket) {
      fold.confidence = std::min(fold.confidence, 0.45);
      fold.reason = "the breast hangs over its fold; where it is one with the chest";
    }
    record.landmark(std::string("underbust") + kSuffix[side], fold.below_bust_point, fold.confidence,
                    fold.reason);
    seen = std::min(seen, fold.lowest);
    const double told = above_web > 0 ? std::max(fold.by_walls, fold.lowest + above_web) : fold.by_walls;
    if (told < height) {
      height = told;
      inferred = above_web == 0;
    }
    in_pocket = in_pocket || fold.in_pocket;
    if (fold.confidence < confidence) {
      confidence = fold.confidence;
      reason = fold.reason;
    }
  }
  record.height("underbust", height, confidence, reason);
  seen -= kUnderbustBelowFold;
  const double level = height - kUnderbustBelowFold;
  const auto trunk_at = [&](double at) {
    std::vector<Outline> outline = trunk.outline_at(at);
    for (Outline& section : outline) section = without_hanging_breasts(section, tips, body.stature);
    return outline;
  };
  const auto tape_at = [&](double offset) {
    if (inferred && level > seen) return tape_carried_up(trunk_at, seen, level + offset);
    return tape_loop(trunk_at(level + offset));
  };
  const double doubt =
      in_pocket ? std::abs(tape_length(trunk_at(seen)) - tape_length(trunk_at(seen - kPocketDepth))) : 0;
  record.girth("underbust", tape_at, confidence, reason, doubt);
  return height;
}

double bust(const BodyShape& body, const Trunk& trunk, Record& record) {
  double height = 0, confidence = 1;
  std::string reason;
  std::array<Vector3d, 2> tips;
  for (Side side : {kLeft, kRight}) {
    const BustPoint tip = find_bust_point(body, trunk, side);
    record.landmark(std::string("bust_point") + kSuffix[side], tip.point, tip.confidence, tip.reason);
    height += tip.point.z() / 2;
    if (tip.confidence < confidence) {
      confidence = tip.confidence;
      reason = tip.reason;
    }
    tips[side] = tip.point;
  }
  record.height("bust", height, confidence, reason);
  record.girth(
      "bust", [&](double offset) { return tape_loop(trunk.outlines_with_breasts_at(height + offset)); },
      confidence, reason);
  return underbust(body, trunk, tips, record);
}

void waist(const BodyShape& body, const Trunk& trunk, double hip, double underbust, Record& record) {
  const WaistLevel level = find_waist(body, trunk, hip + kWaistAboveHip, underbust - kWaistBelowUnderbust);
  record.height("waist", level.height, level.confidence, level.reason);
  record.girth(
      "waist", [&](double offset) { return tape_loop(trunk.outline_at(level.height + offset)); },
      level.confidence, level.reason);
  sides(trunk, "waist_side", level.height, level.confidence, record);

  const double navel = navel_height(body);
  const std::vector<Outline> outline = trunk.outline_at(navel);
  if (outline.empty()) return;
  Vector3d front = outline.front().points.front();
  for (const Vector3d& p : outline.front().points) {
    const bool nearer =
        std::abs(p.y() - outline.front().centroid.y()) < std::abs(front.y() - outline.front().centroid.y());
    if (p.x() > outline.front().centroid.x() && (nearer || front.x() < outline.front().centroid.x()))
      front = p;
  }
  record.landmark("navel", front, 0.4, "its level is by proportion");
}

void neck(const BodyShape& body, const Neck& found, Record& record) {
  if (!found.found) {
    for (const char* name : {"neck_front", "neck_back", "neck_side_L", "neck_side_R", "neck"})
      record.missing(name, found.missing);
    return;
  }
  record.landmark("neck_front", found.front, found.confidence, found.reason);
  record.landmark("neck_back", find_neck_back(body, found), found.confidence, found.reason);
  for (Side side : {kLeft, kRight})
    record.landmark(std::string("neck_side") + kSuffix[side], find_neck_side(body, found, side),
                    found.confidence, found.reason);
  record.height("neck", found.origin.z(), found.confidence, found.reason);
  record.girth("neck", found.tape, found.confidence, found.reason);
}

void arms(const BodyShape& body, const Trunk& trunk, const Neck& found_neck, Record& record) {
  ShoulderHints hints;
  if (found_neck.found) hints.stoop = stoop_of(body, found_neck);
  for (Side side : {kLeft, kRight}) {
    const Axilla& axilla = trunk.axilla(side);
    const std::string suffix = kSuffix[side];
    if (!axilla.found) {
      for (const char* name : {"axilla", "upper_arm"})
        record.missing(name + suffix, "no arm parts from the trunk");
      continue;
    }
    record.landmark("axilla" + suffix, axilla.point, axilla.filled ? 0.45 : 0.9,
                    axilla.filled ? "the armpit is filled with skin that the scan did not see" : "");
    const LimbGirth girth = find_upper_arm_girth(body, axilla, side);
    limb("upper_arm" + suffix, girth, record);
    if (!girth.tape.empty()) hints.arm_girths[side] = geometry::length_of(girth.tape, true);
  }
  for (Side side : {kLeft, kRight}) {
    const std::string name = std::string("shoulder") + kSuffix[side];
    const Shoulder shoulder = find_shoulder(body, trunk, found_neck, hints, side);
    if (shoulder.found) {
      record.landmark(name, shoulder.point, shoulder.confidence, shoulder.reason);
    } else {
      record.missing(name, shoulder.reason);
    }
  }
}

void upper_trunk(const BodyShape& body, const Trunk& trunk, Record& record) {
  const Neck found_neck = find_neck(body, trunk);
  neck(body, found_neck, record);
  arms(body, trunk, found_neck, record);
  if (body.levels.has_head) {
    record.height("stature", body.stature);
  } else {
    record.height("stature", body.stature, 0.3, "no head; estimated from the length of the legs");
  }
}

}  // namespace

BodyMeasures find_landmarks(const TriangleMesh& mesh, const std::vector<char>& filled, const Options&) {
  geometry::check_mesh(mesh);
  if (mesh.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kNotABody, "not a standing body: the mesh has no triangles");
  if (!filled.empty() && filled.size() != mesh.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "one flag a vertex is needed to tell filled holes");

  const BodyFrame frame = find_body_frame(mesh);
  const BodyShape body(in_frame(mesh, frame.body_from_scan), filled);
  const Trunk trunk(body);
  Record record(body, filled, frame);
  const double hip = lower_trunk(body, trunk, record);
  const double underbust = bust(body, trunk, record);
  waist(body, trunk, hip, underbust, record);
  upper_trunk(body, trunk, record);
  return record.take();
}

}  // namespace tensegric_fit::landmarks
