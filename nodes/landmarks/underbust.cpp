#include <algorithm>
#include <cmath>

#include "landmarks/bust.hpp"
#include "landmarks/fold_arc.hpp"
#include "landmarks/fold_walls.hpp"
#include "landmarks/profile.hpp"
#include "landmarks/surface_point.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kMedialReach = 0.055;  // metres, from the definition of the underbust level
constexpr double kApart = 0.005;        // between two profiles
constexpr int kUnseenAbove = 25,
              kUnseenBelow = 10;        // millimetres from the fold, where sight tells how sure it is
constexpr double kUnseenReach = 0.004;  // metres from a vertex that was not seen
constexpr double kMostlyUnseen = 0.3;   // share of that skin from where walls tell all; with none, nothing
constexpr double kBeside = 0.01;        // metres of skin to both sides of all profiles
constexpr int kMedial = 11;             // profiles from the bust point's to the reach's end
constexpr int kWallFrom = 3, kWallTo = 18;  // millimetres from the fold along the walls of a pocket
constexpr int kReach = 8;                   // millimetres each way over which a profile's hollowness is taken
constexpr double kRim = 0.012;              // metres along the skin; the nipple's own rim is hollow too
constexpr double kSteepest = 2;             // of a fold seen from the front
// Statures under the bust point: folds are 0.01 to 0.05 below, a big belly's own fold over the groin 0.08 or
// more.
constexpr double kBelow = 0.08;
constexpr double kAbove = 0.02;
constexpr double kHollow = 15;  // 1/m: a radius of 70 mm is a rib cage's roundness, not a fold

constexpr double kSharpest =
    120;  // 1/m: a fold is no sharper on a mesh; more is noise, or a cut along a flank

// A place on one of the profiles side by side, and the best way of a fold to it.
struct Place {
  Vector3d point;
  double medial;  // metres inwards of the bust point
  double hollowness;
  double opening;
  double raised;  // metres, what breast and chest further off tell the fold to be higher
  double unseen;  // share of the skin next to it
  double sum;     // of hollowness along the way
  int before;     // on the profile before, -1 on the first
};

using Places = std::vector<Place>;

// Skin round one breast's fold.
struct Skin {
  const BodyShape& body;
  Vector3d bust_point;
  double inwards;  // sign of y
  std::vector<int> triangles;
  std::vector<Vector3d> unseen;  // vertices
};

Skin skin_of(const BodyShape& body, const Vector3d& bust_point, Side side) {
  const double s = body.stature, inwards = -kSign[side];
  const double medial = bust_point.y() + inwards * (kMedial * kApart + kBeside),
               lateral = bust_point.y() - inwards * kBeside;
  const Vector3d low(bust_point.x() - 0.12 * s, std::min(medial, lateral), bust_point.z() - kBelow * s),
      high(bust_point.x() + 0.03 * s, std::max(medial, lateral), bust_point.z() + kAbove * s);
  Skin skin{body, bust_point, inwards, triangles_in_box(body, low, high), {}};
  for (int v : vertices_in_box(body, low, high))
    if (!body.filled.empty() && body.filled[v]) skin.unseen.push_back(body.mesh.vertices[v]);
  return skin;
}

// How many of a profile's points before each one, and before its end, lie on skin that was not seen.
std::vector<int> unseen_before(const Skin& skin, const Profile& profile) {
  std::vector<int> before{0};
  for (const Vector3d& p : profile.points) {
    const bool unseen = std::any_of(skin.unseen.begin(), skin.unseen.end(), [&](const Vector3d& v) {
      return (v - p).squaredNorm() < kUnseenReach * kUnseenReach;
    });
    before.push_back(before.back() + (unseen ? 1 : 0));
  }
  return before;
}

// Places below the bust point on the profile so far inwards of it, from top to bottom.
Places places_below(const Skin& skin, double medial) {
  const Vector3d& bust_point = skin.bust_point;
  const Profile profile = cut_profile(
      skin.body, skin.triangles, bust_point + skin.inwards * medial * Vector3d::UnitY(), Vector3d::UnitX());
  Places places;
  const int count = static_cast<int>(profile.points.size());
  // No skin of the breast in this plane.
  if (count == 0 || profile.points.front().z() < bust_point.z()) return places;
  const std::vector<int> unseen = unseen_before(skin, profile);
  int level = 0;  // of the bust point; the fold of a breast that hangs can be as high
  while (level < count && profile.points[level].z() > bust_point.z()) ++level;
  for (int i = level + static_cast<int>(kRim / profile.step); i < count; ++i) {
    const double hollowness = std::clamp(profile.hollowness(i, kReach), 0.0, kSharpest);
    const int from = std::max(i - kUnseenAbove, 0), to = std::min(i + kUnseenBelow, count);
    places.push_back({profile.points[i], medial, hollowness, profile.opening(i, kWallFrom, kWallTo),
                      fold_above_place(profile, i), double(unseen[to] - unseen[from]) / (to - from),
                      hollowness, -1});
  }
  return places;
}

// Carries the ways on from profile to profile. False where there is nowhere to go.
bool carry_on(const Places& from, Places& to) {
  bool any = false;
  for (Place& next : to) {
    double best = -1;
    for (int i = 0; i < static_cast<int>(from.size()); ++i) {
      if (from[i].sum <= best || std::abs(from[i].point.z() - next.point.z()) > kSteepest * kApart) continue;
      best = from[i].sum;
      next.before = i;
    }
    next.sum = next.before < 0 ? -1 : best + next.hollowness;
    any = any || next.before >= 0;
  }
  return any;
}

// The fold runs on smoothly from profile to profile: of all such ways the one that is most hollow in sum,
// from the bust point inwards.
Places most_hollow_way(const Skin& skin) {
  std::vector<Places> profiles;
  for (int k = 0; k <= kMedial; ++k) {
    Places places = places_below(skin, k * kApart);
    if (profiles.empty()) {
      if (!places.empty()) profiles.push_back(std::move(places));
      continue;
    }
    if (!carry_on(profiles.back(), places)) break;
    profiles.push_back(std::move(places));
  }
  Places way;
  if (profiles.empty()) return way;
  const auto less = [](const Place& a, const Place& b) { return a.sum < b.sum; };
  way.push_back(*std::max_element(profiles.back().begin(), profiles.back().end(), less));
  for (std::size_t k = profiles.size() - 1; k-- > 0;) way.push_back(profiles[k][way.back().before]);
  std::reverse(way.begin(), way.end());
  return way;
}

// Share of the skin along the way that the scan did not see.
double unseen_along(const Places& way) {
  double sum = 0;
  for (const Place& place : way) sum += place.unseen;
  return sum / static_cast<double>(way.size());
}

// The way as a fold, each place as much higher as the walls tell, times `walls`.
std::vector<FoldPlace> as_fold(const Places& way, double walls) {
  std::vector<FoldPlace> fold;
  for (const Place& place : way)
    fold.push_back({place.medial, place.point.z() + walls * place.raised, place.opening});
  return fold;
}

// On the outside the breast can run out into the flank, at the sternum into the other one: the fold is where
// the way is hollow without a break, and most in sum, as a cut that grazes the flank is hollow too.
Places hollow_stretch(const Places& way) {
  const auto is_hollow = [](const Place& place) { return place.hollowness >= kHollow; };
  Places most;
  double largest = 0;
  for (auto first = way.begin(); first != way.end();) {
    first = std::find_if(first, way.end(), is_hollow);
    const auto last = std::find_if_not(first, way.end(), is_hollow);
    double sum = 0;
    for (auto place = first; place != last; ++place) sum += place->hollowness;
    if (sum > largest) {
      largest = sum;
      most = Places(first, last);
    }
    first = last;
  }
  return most;
}

}  // namespace

Fold find_fold(const BodyShape& body, const Vector3d& bust_point, Side side) {
  const Places way = most_hollow_way(skin_of(body, bust_point, side));
  const Places hollow = hollow_stretch(way);
  if (hollow.empty()) {
    const Vector3d guess = bust_point - 0.035 * body.stature * Vector3d::UnitZ();
    return {guess, guess.z(), guess.z(), 0.2, "no fold under the breast"};
  }
  Fold fold;
  fold.below_bust_point = hollow.front().point;
  fold.lowest = fold.by_walls = lowest_of_arc(as_fold(hollow, 0), kMedialReach);
  fold.confidence = 0.9;

  // On a mesh without any skin that was not seen, what looks like a fold is one.
  if (std::none_of(body.filled.begin(), body.filled.end(), [](char unseen) { return unseen != 0; }))
    return fold;
  fold.by_walls =
      lowest_of_arc(as_fold(hollow, std::min(unseen_along(way) / kMostlyUnseen, 1.0)), kMedialReach);
  fold.in_pocket = lies_in_pocket(as_fold(way, 0), kMedialReach);
  if (fold.in_pocket) {
    fold.confidence = 0.45;
    fold.reason = "the fold lies up a narrow pocket, to whose end the scan may not have seen";
  }
  return fold;
}

}  // namespace tensegric_fit::landmarks
