#include "body_model/recognition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "body_model/matching.hpp"
#include "geometry/oriented_tree.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

// Limits between women and things, by tests/body_model/recognise.py: training women's surfaces and scans,
// women of another make; 31 things.
constexpr double kMisfit =
    0.006;                      // m; women 0.004 at most, things that are refused by it alone 0.007 at least
constexpr double kShape = 3.3;  // women 2.9 at most, a pole that misfits by 0.004 m 3.6
constexpr double kUnexplained = 0.25;  // of the surface; women 0.02 at most, things that are refused by it
                                       // alone 0.33 at least, two persons 0.5
constexpr double kShortest = 1.2, kTallest = 2.2;  // m, of grown-up people
constexpr double kUnusual = 1.6;                   // women of the model's own kind 1.25 at most

constexpr double kOff = 0.035;  // m from the skin: more than the model misses women by
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
constexpr int kJudgedSamples = 6000;                   // that are asked: 17 mm apart on a woman
constexpr double kTogether = 0.06;                     // m; nearer ones are one thing
constexpr double kLeastThing = 0.004;  // of the surface, 70 cm^2: more than fingers that are bent otherwise
constexpr double kArmsLength = 0.3;    // m: so far a limb may have turned away from where the model has it
constexpr double kTurned = 0.5;        // cosine between two normals of one skin

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

std::size_t asked(const Samples& samples) {
  return std::min<std::size_t>(kJudgedSamples, samples.points.size());
}

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
      if (off.norm() > kOneSkin || normals[v].dot(normals[other]) < kTurned) continue;
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

/// Of each sample that is asked: m from her skin, and the vertex of the skin there.
struct Off {
  std::vector<double> distances;
  std::vector<int> nearest;
};

Off off_skin(const RegisteredBody& body, const Samples& samples) {
  const geometry::PointTree tree(body.skin);
  Off off{std::vector<double>(asked(samples)), std::vector<int>(asked(samples))};
  geometry::parallel_for(off.nearest.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t s = begin; s < end; ++s) {
      off.nearest[s] = tree.nearest(samples.points[s]);
      off.distances[s] = (body.skin[off.nearest[s]] - samples.points[s]).norm();
    }
  });
  return off;
}

double share_off(const Off& off) {
  const auto far =
      std::count_if(off.distances.begin(), off.distances.end(), [](double d) { return d > kOff; });
  return static_cast<double>(far) / static_cast<double>(off.distances.size());
}

/// m, of the samples that are hers from the posed skin, along its normal.
double misfit_of(const RegisteredBody& body, const Samples& samples, const Off& off) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.posed, body.model->triangles);
  const geometry::OrientedTree tree(body.posed, normals);
  std::vector<double> distances(off.distances.size(), -1);
  geometry::parallel_for(distances.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t s = begin; s < end; ++s) {
      if (off.distances[s] > kOff) continue;
      const int v = tree.nearest(samples.points[s], samples.normals[s]);
      const bool matched = normals[v].dot(samples.normals[s]) > kTurned;
      distances[s] =
          matched ? std::min(std::abs((samples.points[s] - body.posed[v]).dot(normals[v])), kOff) : kOff;
    }
  });
  double sum = 0;
  int count = 0;
  for (const double d : distances) {
    if (d < 0) continue;
    sum += d;
    ++count;
  }
  return count > 0 ? sum / count : kOff;
}

/// \throw Refusal not_a_body
void check(const Evidence& e, double stature) {
  std::string why;
  if (e.unexplained > kUnexplained) {
    why = fmt::format("{:.0f} % of the surface is not hers: a thing, or more than one person",
                      100 * e.unexplained);
  } else if (!(stature > kShortest && stature < kTallest)) {
    why = "nobody has that size";
  } else if (e.misfit > kMisfit) {
    why = "no person's shape comes near";
  } else if (e.shape > kShape) {
    why = "no person has that shape";
  } else {
    return;
  }
  throw geometry::Refusal(geometry::refusal::kNotABody,
                          fmt::format("{} (the most similar woman is {:.2f} m tall ({} to {}), {:.1f} mm off "
                                      "({:.0f} at most), {:.1f} deviations from the mean ({} at most); "
                                      "{:.0f} % of the surface is not hers ({:.0f} at most))",
                                      why, stature, kShortest, kTallest, 1e3 * e.misfit, 1e3 * kMisfit,
                                      e.shape, kShape, 100 * e.unexplained, 100 * kUnexplained));
}

/// Groups of samples off the skin, each as indices, in order of their first.
std::vector<std::vector<int>> things_off(const Samples& samples, const Off& off) {
  std::vector<int> left;
  for (std::size_t s = 0; s < off.distances.size(); ++s)
    if (off.distances[s] > kOff) left.push_back(static_cast<int>(s));
  std::vector<std::vector<int>> things;
  while (!left.empty()) {
    std::vector<int> thing{left.front()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < thing.size(); ++i) {
      const Vector3d at = samples.points[thing[i]];
      const auto near = std::stable_partition(
          left.begin(), left.end(), [&](int s) { return (samples.points[s] - at).norm() > kTogether; });
      thing.insert(thing.end(), near, left.end());
      left.erase(near, left.end());
    }
    things.push_back(std::move(thing));
  }
  return things;
}

std::string guess(const std::string& part, double farthest) {
  if (part == "head" || part == "neck") return "hair or something worn";
  if (farthest > 0.3)
    return "a thing or another person";  // m: beyond arm's breadth of a limb that is posed wrongly
  if (part == "trunk" || part == "breast_L" || part == "breast_R")
    return "hair, something worn or held, or an arm";
  return "something worn or held, or a limb that is bent otherwise";
}

Unexplained described(const std::vector<int>& thing, const RegisteredBody& body, const Samples& samples,
                      const Off& off) {
  Unexplained result{
      Vector3d::Zero(), 0, static_cast<double>(thing.size()) / static_cast<double>(off.distances.size()), {}};
  double farthest = 0;
  std::vector<int> of_part(body.model->parts.size(), 0);
  for (const int s : thing) {
    result.centre += samples.points[s] / static_cast<double>(thing.size());
    farthest = std::max(farthest, off.distances[s]);
    ++of_part[body.model->part[off.nearest[s]]];
  }
  for (const int a : thing)
    for (const int b : thing)
      result.extent = std::max(result.extent, (samples.points[a] - samples.points[b]).norm());
  const std::string& part =
      body.model->parts[std::max_element(of_part.begin(), of_part.end()) - of_part.begin()];
  result.reason = fmt::format(
      "{:.1f} % of the surface, {:.0f} mm across, up to {:.0f} mm off her skin, nearest to {}: {}",
      100 * result.share, 1e3 * result.extent, 1e3 * farthest, part, guess(part, farthest));
  return result;
}

}  // namespace

std::vector<char> recognise(RegisteredBody& body, const Samples& samples) {
  const Off off = off_skin(body, samples);
  const Eigen::VectorXd& shape = body.parameters.shape;
  body.evidence = {misfit_of(body, samples, off), share_off(off),
                   std::sqrt(shape.squaredNorm() / static_cast<double>(shape.size()))};
  check(body.evidence, body.stature());
  body.unexplained.clear();
  std::vector<char> is_of_thing(off.distances.size(), 0);
  for (const std::vector<int>& thing : things_off(samples, off)) {
    if (static_cast<double>(thing.size()) < kLeastThing * static_cast<double>(off.distances.size())) continue;
    body.unexplained.push_back(described(thing, body, samples, off));
    for (const int s : thing) is_of_thing[s] = 1;
  }
  std::stable_sort(body.unexplained.begin(), body.unexplained.end(),
                   [](const Unexplained& a, const Unexplained& b) { return a.share > b.share; });
  body.note.clear();
  if (body.evidence.shape > kUnusual)
    body.note = fmt::format(
        "an unusual shape: {:.1f} deviations from the model's mean woman, of the women it was made from none "
        "is beyond {}; a man, padding, clothes?",
        body.evidence.shape, kUnusual);
  return is_of_thing;
}

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
