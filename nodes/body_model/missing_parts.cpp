#include "body_model/missing_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "body_model/matching.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

constexpr double kThere =
    0.030;  // m of RegisteredBody::support and off: samples all round that face the same way
constexpr double kInside = 0.005,
                 kStraightIn = 0.7;  // m under other skin; cosine with its normal: beside it is not under it
constexpr double kOneSkin = 0.015;  // m between the skins of two legs that lie on one: at half bodies 70 % of
                                    // a leg is nearer, on 149 training scans nothing is nearer than 30 mm
// m apart at rest: tolerance, a hand's breadth. No arm's skin at the armpit or the shoulder is; two women
// without an arm are named rightly, arms that touch the flank were not measured.
constexpr double kOtherSkin = 0.1;
constexpr double kClearly =
    0.2;  // between the shares of the trunk's halves that were seen: tolerance between
          // 0.04, the most on training scans, and 0.3, the least on half bodies
constexpr double kLeastOfPart = 0.55;  // of a part's skin: scans of women have 0.79 at least, an arm that has
                                       // slid into the trunk 0.47 at most
constexpr double kCrown = 0.03, kLeastOfCrown = 0.25;  // statures below the top; of its skin: no sensor looks
                                                       // down, scans have 0.54 at least
constexpr double kArmsLength = 0.3;  // m: so far a limb may have turned away from where the model has it

/// Head and limbs from the trunk outwards, each with the part that it hangs on and the arm or leg that it is
/// of.
struct Limb {
  std::string part, on, of;
};
const Limb kLimbs[] = {{"trunk", "", ""},
                       {"head", "", ""},
                       {"upper_arm_L", "", "arm_L"},
                       {"forearm_L", "upper_arm_L", "arm_L"},
                       {"hand_L", "forearm_L", "arm_L"},
                       {"upper_arm_R", "", "arm_R"},
                       {"forearm_R", "upper_arm_R", "arm_R"},
                       {"hand_R", "forearm_R", "arm_R"},
                       {"thigh_L", "", "leg_L"},
                       {"shank_L", "thigh_L", "leg_L"},
                       {"foot_L", "shank_L", "leg_L"},
                       {"thigh_R", "", "leg_R"},
                       {"shank_R", "thigh_R", "leg_R"},
                       {"foot_R", "shank_R", "leg_R"}};

/// Arm or leg that each part belongs to, "" for the others.
std::vector<std::string> limbs_of(const Model& model) {
  std::vector<std::string> limbs(model.parts.size());
  for (const Limb& limb : kLimbs) limbs[model.part_named(limb.part)] = limb.of;
  return limbs;
}

bool is_hand(const Model& model, int v) {
  return model.parts[model.part[v]].rfind("hand", 0) == 0;
}

/// Of each two parts, whether they are one or one hangs on the other; trunk, head and what else is of no arm
/// or leg are one.
std::vector<std::vector<char>> joined_parts(const Model& model) {
  const std::vector<std::string> limbs = limbs_of(model);
  const int count = static_cast<int>(model.parts.size());
  std::vector<std::vector<char>> joined(count, std::vector<char>(count, 0));
  const auto hangs_on = [&](const Limb& limb, int other) {
    return limb.on.empty() ? limbs[other].empty() : model.parts[other] == limb.on;
  };
  for (int one = 0; one < count; ++one)
    for (int other = 0; other < count; ++other)
      joined[one][other] = static_cast<char>(one == other || (limbs[one].empty() && limbs[other].empty()));
  for (const Limb& limb : kLimbs) {
    if (limb.of.empty()) continue;
    const int part = model.part_named(limb.part);
    for (int other = 0; other < count; ++other)
      if (hangs_on(limb, other)) joined[part][other] = joined[other][part] = 1;
  }
  return joined;
}

/// How much more of her left half of the trunk has samples than of the right, -1 to 1.
double more_on_left(const RegisteredBody& body) {
  double there[2] = {0, 0}, whole[2] = {0, 0};  // of the trunk's left and right half
  const int trunk = body.model->part_named("trunk");
  for (std::size_t v = 0; v < body.skin.size(); ++v) {
    if (body.model->part[v] != trunk) continue;
    const int half = body.model->mean[v].x() > 0 ? 0 : 1;
    ++whole[half];
    there[half] += body.support[v] < kThere;
  }
  return there[0] / whole[0] - there[1] / whole[1];
}

/// Of each vertex that is asked for: whether it lies inside another limb or the trunk, or on the other leg,
/// or the arm on the trunk, as a limb does for which there are no samples of its own. The others: 0.
template <typename IsAsked>
std::vector<char> run_into_others(const RegisteredBody& body, const IsAsked& is_asked) {
  const Model& model = *body.model;
  const std::vector<std::string> limb_of_part = limbs_of(model);
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.skin, model.triangles);
  std::vector<char> inside(body.skin.size(), 0);
  // Where both legs lie on one, it is that of the half that was scanned, or else the one on whose side it is.
  const double left_half = more_on_left(body);
  const Vector3d between_hips = (body.joint("upperleg01.L") + body.joint("upperleg01.R")) / 2;
  const auto is_left_leg = [&](const Vector3d& place) {
    return std::abs(left_half) > kClearly ? left_half > 0 : body.left().dot(place - between_hips) > 0;
  };
  for (const std::string limb : {"arm_L", "arm_R", "leg_L", "leg_R"}) {
    const bool is_leg = limb.rfind("leg", 0) == 0;
    std::vector<Vector3d> others;
    std::vector<int> vertex, own;
    for (std::size_t v = 0; v < body.skin.size(); ++v) {
      if (limb_of_part[model.part[v]] == limb) {
        if (is_asked(static_cast<int>(v))) own.push_back(static_cast<int>(v));
        continue;
      }
      others.push_back(body.skin[v]);
      vertex.push_back(static_cast<int>(v));
    }
    if (own.empty()) continue;
    const geometry::PointTree tree(others);
    for (const int v : own) {
      const int other = vertex[tree.nearest(body.skin[v])];
      const Vector3d off = body.skin[v] - body.skin[other];
      const double depth = -off.dot(normals[other]);
      inside[v] = static_cast<char>(depth > kInside && depth > kStraightIn * off.norm());
      if (off.norm() > kOneSkin || normals[v].dot(normals[other]) < Matching::kSameSide) continue;
      const std::string& on = limb_of_part[model.part[other]];
      if (is_leg && on.rfind("leg", 0) == 0 && is_left_leg(body.skin[v]) != (limb == "leg_L")) inside[v] = 1;
      if (!is_leg && on.empty() && !is_hand(model, v) &&
          (model.mean[v] - model.mean[other]).norm() > kOtherSkin)
        inside[v] = 1;
    }
  }
  return inside;
}

std::vector<double> known_shares(const RegisteredBody& body) {
  return body.there.empty() ? body_model::shares_there(body) : body.there;
}

double share_of_crown(const RegisteredBody& body) {
  const Model& model = *body.model;
  double top = model.mean.front().z();
  for (const Vector3d& p : model.mean) top = std::max(top, p.z());
  int there = 0, whole = 0;
  for (std::size_t v = 0; v < model.mean.size(); ++v) {
    if (model.mean[v].z() < top - kCrown * model.stature) continue;
    ++whole;
    there += static_cast<int>(body.support[v] < kThere);
  }
  return static_cast<double>(there) / whole;
}

Vector3d middle_of(const RegisteredBody& body, int part) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (std::size_t v = 0; v < body.skin.size(); ++v) {
    if (body.model->part[v] != part) continue;
    sum += body.skin[v];
    ++count;
  }
  return sum / std::max(count, 1);
}

}  // namespace

std::vector<double> shares_there(const RegisteredBody& body) {
  const Model& model = *body.model;
  std::vector<double> weights(body.skin.size(), 0);  // of the skin that stands for its part
  for (std::size_t i = 0; i < model.fit_points.size(); ++i)
    weights[model.fit_points[i]] += model.fit_weights[i];
  for (int v = 0; v < static_cast<int>(body.skin.size()); ++v)
    if (is_hand(model, v)) weights[v] = 1;  // a hand has few fit points, and none on its fingers
  const auto has_samples = [&](int v) {
    const bool beside =
        body.off[v] > kThere && model.parts[model.part[v]].rfind("foot", 0) != 0;  // nobody sees soles
    return body.support[v] < kThere && !beside;
  };
  const std::vector<char> inside =
      run_into_others(body, [&](int v) { return weights[v] > 0 && has_samples(v); });
  std::vector<double> there(model.parts.size(), 0), whole(model.parts.size(), 0);
  for (int v = 0; v < static_cast<int>(body.skin.size()); ++v) {
    whole[model.part[v]] += weights[v];
    if (has_samples(v) && !inside[v]) there[model.part[v]] += weights[v];
  }
  for (std::size_t p = 0; p < there.size(); ++p) there[p] = whole[p] > 0 ? there[p] / whole[p] : 1;
  return there;
}

void mark_skin_without_surface(RegisteredBody& body, const geometry::TriangleMesh& mesh) {
  const Model& model = *body.model;
  const std::vector<std::vector<char>> joined = joined_parts(model);
  const geometry::PointTree skin(body.skin), vertices(mesh.vertices);
  // A hand that hangs beside the thigh is near the thigh's surface, which does not make it there.
  const auto is_of = [&](int part, const Vector3d& place) {
    return joined[part][model.part[skin.nearest(place)]] != 0;
  };
  std::vector<char> far(body.skin.size(), 0);
  geometry::parallel_for(far.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t v = begin; v < end; ++v)
      far[v] = static_cast<char>(body.support[v] < kThere &&
                                 !vertices.any_within(body.skin[v], kThere, [&](int near) {
                                   return is_of(model.part[v], mesh.vertices[near]);
                                 }));
  });
  if (std::find(far.begin(), far.end(), 1) == far.end()) return;
  // Large triangles are nearer than their vertices. There are few such places, so that this may take its
  // time.
  for (int part = 0; part < static_cast<int>(model.parts.size()); ++part) {
    std::vector<int> asked;
    for (int v = 0; v < static_cast<int>(far.size()); ++v)
      if (far[v] && model.part[v] == part) asked.push_back(v);
    if (asked.empty()) continue;
    std::vector<char> own(mesh.triangles.size());
    for (std::size_t t = 0; t < own.size(); ++t) {
      const Eigen::Vector3i& corners = mesh.triangles[t];
      const Vector3d sum = mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]];
      own[t] = static_cast<char>(is_of(part, sum / 3));
    }
    const geometry::TriangleMesh surface = geometry::submesh(mesh, own);
    std::optional<geometry::SurfaceTree> tree;
    if (!surface.triangles.empty()) tree.emplace(surface);
    for (const int v : asked) {
      const double distance =
          tree ? (tree->nearest(body.skin[v]).position - body.skin[v]).norm() : Matching::kUnmatched;
      body.support[v] = std::max(body.support[v], std::min(distance, Matching::kUnmatched));
    }
  }
  body.there = shares_there(body);
}

std::vector<geometry::Missing> missing_parts(const RegisteredBody& body) {
  const std::vector<double> there = known_shares(body);
  const auto share = [&](const std::string& part) { return there[body.model->part_named(part)]; };
  const auto gone = [&](const std::string& part) { return !part.empty() && share(part) < kLeastOfPart; };
  const char* where = body.scanned ? "scanned surface" : "mesh";
  const auto only = [&](double of_it) {
    return of_it < 0.01 ? fmt::format("none of it is in the {}", where)
                        : fmt::format("only {:.0f} % of it is in the {}", 100 * of_it, where);
  };
  std::vector<geometry::Missing> missing;
  for (const Limb& limb : kLimbs) {
    if (!gone(limb.part)) continue;
    if (gone(limb.on)) {
      missing.back().reason += fmt::format(", nor is {}", limb.part);
      continue;
    }
    missing.push_back({limb.part, only(share(limb.part))});
  }
  if (!gone("head") && share_of_crown(body) < kLeastOfCrown)
    missing.push_back(
        {"crown", only(share_of_crown(body)) + ": heights of the whole body are the model's guess"});
  for (geometry::Missing& part : missing)
    for (const Unexplained& thing : body.unexplained)
      if (const int index = body.model->part_named(part.name);
          index >= 0 && (thing.centre - middle_of(body, index)).norm() < kArmsLength)
        part.reason += fmt::format("; what is unexplained {:.0f} mm from there may be it",
                                   1e3 * (thing.centre - middle_of(body, index)).norm());
  return missing;
}

std::vector<char> parts_there(const RegisteredBody& body) {
  std::vector<char> there;
  for (const double share : known_shares(body)) there.push_back(static_cast<char>(share >= kLeastOfPart));
  return there;
}

std::vector<char> lost_skin(const RegisteredBody& body) {
  const std::vector<char> part_is_there = parts_there(body);
  return run_into_others(body, [&](int v) { return !part_is_there[body.model->part[v]]; });
}

std::array<bool, 2> sides_there(const RegisteredBody& body, const std::string& part) {
  const std::vector<char> there = parts_there(body);
  const auto is_there = [&](const char* side) { return there[body.model->part_named(part + side)] != 0; };
  return {is_there("_L"), is_there("_R")};
}

bool lacks_feet(const RegisteredBody& body) {
  const auto [left, right] = sides_there(body, "foot");
  return !left && !right;
}

}  // namespace tensegric_fit::body_model
